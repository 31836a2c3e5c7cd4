#include "model/meshes/mesh_builder.h"

#include <algorithm>
#include <sstream>

#include "gpu_planning_scene/error.h"
#include "model/coordinate_hash.h"
#include "model/meshes/triangulate_polygon.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::uint32_t kEmpty = 0xffffffffU;
constexpr std::size_t kMostTriangles = 0x7fffffff;  // their corners then have indices of 32 bits
}  // namespace

MeshBuilder::MeshBuilder(const std::string& name, const Eigen::Vector3d& scale)
  : mesh_(std::make_shared<Mesh>()), scale_(scale)
{
  mesh_->name = name;
  setPose(Eigen::Affine3d::Identity());
}

void MeshBuilder::setPose(const Eigen::Affine3d& pose)
{
  pose_ = Eigen::Scaling(scale_) * pose;
  mirrors_ = pose_.linear().determinant() < 0.0;
}

void MeshBuilder::addPolygon(const std::vector<Eigen::Vector3d>& corners, const std::vector<std::uint32_t>& hole_starts)
{
  placed_.clear();
  for (const Eigen::Vector3d& corner : corners)
    placed_.push_back(place(corner));
  if (corners.size() == 3)
    return add({placed_[0], placed_[1], placed_[2]});
  for (const auto& [a, b, c] : triangulatePolygon(corners, hole_starts))
    add({placed_[a], placed_[b], placed_[c]});
}

std::shared_ptr<const Mesh> MeshBuilder::finish()
{
  if (mesh_->triangles.empty())
    throw Error("it has no triangles");
  return std::move(mesh_);
}

void MeshBuilder::add(std::array<std::uint32_t, 3> triangle)
{
  if (mesh_->triangles.size() >= kMostTriangles)
    throw Error("it has more than " + std::to_string(kMostTriangles) + " triangles");
  if (mirrors_)
    std::swap(triangle[1], triangle[2]);
  mesh_->triangles.push_back(triangle);
}

std::uint32_t MeshBuilder::place(const Eigen::Vector3d& corner)
{
  const Eigen::Vector3d placed = pose_ * corner;
  if (!(placed.array().abs() <= kLargestLength).all())  // in this form, NaN fails too
  {
    std::ostringstream text;
    text << "a vertex of triangle " << mesh_->triangles.size();
    if (placed.allFinite())
      text << " is farther than 1000 km away: (" << placed.x() << ", " << placed.y() << ", " << placed.z() << ")";
    else
      text << " is not finite";
    throw Error(text.str());
  }
  return weld(placed.array() + 0.0);  // -0 becomes +0
}

std::uint32_t MeshBuilder::weld(const Eigen::Vector3d& vertex)
{
  if (2 * mesh_->vertices.size() >= slots_.size())
    growSlots();
  std::uint32_t& slot = slots_[slotOf(vertex)];
  if (slot == kEmpty)
  {
    slot = static_cast<std::uint32_t>(mesh_->vertices.size());
    mesh_->vertices.push_back(vertex);
  }
  return slot;
}

/// Finds the slot of the vertex, or the empty slot for it.
std::size_t MeshBuilder::slotOf(const Eigen::Vector3d& vertex) const
{
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hashOf(vertex) & mask;
  while (slots_[slot] != kEmpty && mesh_->vertices[slots_[slot]] != vertex)
    slot = (slot + 1) & mask;
  return slot;
}

void MeshBuilder::growSlots()
{
  slots_.assign(std::max<std::size_t>(1024, 4 * slots_.size()), kEmpty);
  for (std::size_t i = 0; i < mesh_->vertices.size(); ++i)
    slots_[slotOf(mesh_->vertices[i])] = static_cast<std::uint32_t>(i);
}
}  // namespace gpu_planning_scene::core
