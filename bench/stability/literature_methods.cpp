#include "stability/literature_methods.h"

#include <algorithm>
#include <set>

#include "literature/image_space/render_device.h"
#include "literature/pair_truth.h"

namespace gpu_planning_scene::core::stability
{
namespace
{
using MeshPtr = std::shared_ptr<const Mesh>;

/// Null for a shape that is neither a mesh nor a box.
MeshPtr meshOf(const Shape& shape)
{
  if (const auto* mesh = std::get_if<MeshPtr>(&shape))
    return *mesh;
  return std::holds_alternative<Box>(shape) ? tessellate(shape).mesh : nullptr;
}

/// Whether each edge belongs to two triangles, in opposite directions.
bool isClosed(const Mesh& mesh)
{
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      if (!edges.insert({t[i], t[(i + 1) % 3]}).second)
        return false;
  return std::all_of(edges.begin(), edges.end(),
                     [&](const auto& edge) {
                       return edges.count({edge.second, edge.first}) != 0;
                     });
}

/// Whether a closed mesh is convex, up to rounding.
bool isConvex(const Mesh& mesh)
{
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    box.extend(vertex);
  const double tolerance = 1e-9 * box.diagonal().norm();
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(),
                     [&](const auto& t)
                     {
                       const Eigen::Vector3d& p = mesh.vertices[t[0]];
                       const Eigen::Vector3d normal =
                           (mesh.vertices[t[1]] - p).cross(mesh.vertices[t[2]] - p).normalized();
                       return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                                          [&](const Eigen::Vector3d& q) { return normal.dot(q - p) <= tolerance; });
                     });
}

Eigen::Isometry3d bInA(const Case& c)
{
  return (c.link_a * c.a_in_link).inverse() * c.pose_b;
}
}  // namespace

LiteratureMethods::LiteratureMethods() : device_(literature::RenderDevice::shared())
{
  const std::map<std::string, Method> columns = {{"rapid", Rapid},
                                                 {"dop18", Dop18},
                                                 {"dop24", Dop24},
                                                 {"box_tree", BoxTree},
                                                 {"convex_patches", ConvexPatches},
                                                 {"recode_256x1", Recode},
                                                 {"cinder_256x1", Cinder},
                                                 {"cullide_256x1", Cullide},
                                                 {"cullide_fattened_256x1", FattenedCullide}};
  for (const auto& all : {literature::treeMethods(), literature::convexMethods(), literature::imageSpaceMethods()})
    for (const literature::MethodInfo& info : all)
      if (const auto column = columns.find(info.name); column != columns.end())
        methods_.emplace(column->second, info);
}

LiteratureMethods::~LiteratureMethods() = default;

bool LiteratureMethods::renders(Method method) const
{
  return methods_.at(method).family == "image space";
}

std::optional<bool> LiteratureMethods::collides(Method method, const Case& c) const
{
  const MeshPtr a = meshOf(c.a);
  const MeshPtr b = meshOf(c.b);
  if (!a || !b || requiredDistance(c) > 0.0)
    return std::nullopt;
  return methods_.at(method).make(a, b)->collide({bInA(c)})[0] != 0;
}

bool LiteratureMethods::inDomain(Method method, const Case& c, oracle::Verdict truth) const
{
  const literature::Domain& domain = methods_.at(method).domain;
  const MeshPtr a = meshOf(c.a);
  const MeshPtr b = meshOf(c.b);
  if (!domain.open && (!isClosed(*a) || !isClosed(*b)))
    return false;
  if (!domain.concave && (!isConvex(*a) || !isConvex(*b)))
    return false;
  return domain.containment || truth != oracle::Verdict::Collides ||
         literature::PairTruth(a, b).surfaces(bInA(c), oracle::kTolerance) == 0.0;
}
}  // namespace gpu_planning_scene::core::stability
