#include "collision/exact/pair_clearance.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "collision/geometry/cpu_box_pair.h"
#include "collision/geometry/primitive_solid.h"

// Branch and bound over the trees (Larsen, Gottschalk, Lin and Manocha, "Fast Distance Queries with Rectangular Swept
// Sphere Volumes", 2000): the nearer nodes come first. A pair of nodes is skipped if it cannot be nearer than the best
// pair of leaves so far. The leaves are decided by the exact tests of the collision query, so the distance is as exact
// as its verdicts.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

// Distance bounds are widened by this margin, which exceeds their rounding error and kSlack.
constexpr double kMargin = 1e-9;  // metres

/// The clearance found so far. within(v) of update() tells whether two leaves are within the distance v.
class Best
{
 public:
  Best(double required, double most) : required_(required), clearance_(most) {}

  double clearance() const { return clearance_; }
  /// Nodes that are farther from each other than this cannot improve the clearance.
  double reach() const { return required_ + clearance_ + kMargin; }

  template <class Within>
  void update(const Within& within)
  {
    const auto meets = [&](double x) { return within(required_ + x); };
    if (meets(clearance_))
      clearance_ = bisectLeast(0.0, clearance_, meets);
  }

 private:
  double required_;
  double clearance_;
};

/// Lower bound of the distance of the contents of two boxes.
double leastDistance(const OrientedBox& a, const OrientedBox& b)
{
  return (a.center - b.center).norm() - a.half.norm() - b.half.norm();
}

/// Both poses in the frame of the first mesh.
void surfacesApart(const CpuTree& a, const CpuTree& b, const Isometry3d& b_in_a, Best& best,
                   CpuShapePair::Scratch& scratch)
{
  const Isometry3d a_in_b = b_in_a.inverse();
  scratch.node_pairs.assign(1, {0, 0});
  while (!scratch.node_pairs.empty())
  {
    const auto [index_a, index_b] = scratch.node_pairs.back();
    scratch.node_pairs.pop_back();
    const CpuNode& node_a = a.nodes[index_a];
    const CpuNode& node_b = b.nodes[index_b];
    ++scratch.steps;
    if (!overlap(node_a.box, placed(node_b.box, b_in_a), best.reach()))
      continue;
    if (node_a.isLeaf() && node_b.isLeaf())
    {
      for (std::uint32_t j = node_b.first; j < node_b.first + node_b.count; ++j)
      {
        const Triangle& t = b.triangles[j];
        const Triangle triangle_b = {b_in_a * t[0], b_in_a * t[1], b_in_a * t[2]};
        for (std::uint32_t i = node_a.first; i < node_a.first + node_a.count; ++i)
          best.update([&](double distance) { return trianglesWithin(a.triangles[i], triangle_b, distance); });
      }
      continue;
    }
    const bool open_a = opensFirst(node_a, node_b);
    const OrientedBox other = open_a ? placed(node_b.box, b_in_a) : placed(node_a.box, a_in_b);
    const CpuTree& opened = open_a ? a : b;
    std::uint32_t near = open_a ? node_a.first : node_b.first;
    std::uint32_t far = near + 1;
    double near_distance = leastDistance(opened.nodes[near].box, other);
    double far_distance = leastDistance(opened.nodes[far].box, other);
    if (far_distance < near_distance)
    {
      std::swap(near, far);
      std::swap(near_distance, far_distance);
    }
    for (const auto& [child, distance] : {std::pair(far, far_distance), std::pair(near, near_distance)})
      if (distance <= best.reach())
        scratch.node_pairs.push_back({open_a ? child : index_a, open_a ? index_b : child});
  }
}

void surfaceApartFromSolid(const CpuTree& mesh, const Shape& solid, const Isometry3d& mesh_in_solid, Best& best,
                           CpuShapePair::Scratch& scratch)
{
  const auto least = [&](std::uint32_t node)
  {
    const OrientedBox& box = mesh.nodes[node].box;
    return distanceToSolid(solid, mesh_in_solid * box.center) - box.half.norm();
  };
  scratch.nodes.assign(1, 0);
  while (!scratch.nodes.empty())
  {
    const std::uint32_t index = scratch.nodes.back();
    const CpuNode& node = mesh.nodes[index];
    scratch.nodes.pop_back();
    ++scratch.steps;
    if (least(index) > best.reach())
      continue;
    if (node.isLeaf())
    {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      {
        const Triangle& t = mesh.triangles[i];
        const Triangle triangle = {mesh_in_solid * t[0], mesh_in_solid * t[1], mesh_in_solid * t[2]};
        best.update([&](double distance) { return triangleWithinSolid(triangle, solid, distance); });
      }
      continue;
    }
    const bool first_is_nearer = least(node.first) <= least(node.first + 1);
    scratch.nodes.push_back(first_is_nearer ? node.first + 1 : node.first);
    scratch.nodes.push_back(first_is_nearer ? node.first : node.first + 1);
  }
}
}  // namespace

double pairClearance(const CpuTree& a, const Isometry3d& pose_a, const CpuTree& b, const Isometry3d& pose_b,
                     double required, double most, CpuShapePair::Scratch& scratch)
{
  Best best(required, most);
  const Isometry3d b_in_a = relativePose(pose_a, pose_b);
  if (a.mesh && b.mesh)
    surfacesApart(a, b, b_in_a, best, scratch);
  else if (a.mesh)
    surfaceApartFromSolid(a, b.shape, b_in_a.inverse(), best, scratch);
  else if (b.mesh)
    surfaceApartFromSolid(b, a.shape, b_in_a, best, scratch);
  else
    best.update([&](double distance) { return solidsWithin(a.shape, b.shape, b_in_a, distance); });
  return best.clearance();
}
}  // namespace gpu_planning_scene::core
