#include "literature/pair_truth.h"

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "literature/descent.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
constexpr double kRounding = 1e-20;  // metres: of quadruple precision, for shapes of up to 1000 km

double withoutRounding(double distance)
{
  return distance <= kRounding ? 0.0 : distance;
}
/// The mesh without its solid: FCL and the methods of the literature know only triangles.
oracle::PreparedMesh surfaceOf(const Mesh& mesh)
{
  const auto surface = std::make_shared<Mesh>(mesh);
  surface->solid = SolidRule::Surface;
  return oracle::PreparedMesh(*solidMeshOf(surface));
}
}  // namespace

PairTruth::PairTruth(const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b)
  : solid_a_(a), solid_b_(b), surface_a_(surfaceOf(*a)), surface_b_(surfaceOf(*b))
{
}

double PairTruth::surfaces(const Eigen::Isometry3d& b_in_a, double limit) const
{
  const oracle::Motion motion(b_in_a);
  const Eigen::Isometry3d rounded = motion.toDouble();
  oracle::Quad best = limit;
  std::vector<std::array<std::uint32_t, 2>> open = {{0, 0}};
  while (!open.empty() && best > kRounding)
  {
    const auto [a, b] = open.back();
    open.pop_back();
    const oracle::PreparedMesh::Node& node_a = surface_a_.nodes()[a];
    const oracle::PreparedMesh::Node& node_b = surface_b_.nodes()[b];
    if (leastDistance(node_a.box, node_b.box, rounded) > best)
      continue;
    if (node_a.child == 0 && node_b.child == 0)
    {
      const auto& corners = surface_b_.triangles()[node_b.triangle].corners;
      const oracle::Triangle moved({motion * corners[0], motion * corners[1], motion * corners[2]});
      best = std::min(best, oracle::distance(surface_a_.triangles()[node_a.triangle], moved, best));
    }
    else if (opensFirst(node_a.child == 0, node_b.child == 0, node_a.box.half.squaredNorm(),
                        node_b.box.half.squaredNorm()))
    {
      open.push_back({node_a.child, b});
      open.push_back({node_a.child + 1, b});
    }
    else
    {
      open.push_back({a, node_b.child});
      open.push_back({a, node_b.child + 1});
    }
  }
  return withoutRounding(static_cast<double>(best));
}

double PairTruth::solids(const Eigen::Isometry3d& b_in_a, double limit) const
{
  return withoutRounding(oracle::distance(solid_a_, {}, solid_b_, oracle::Motion(b_in_a), limit));
}
}  // namespace gpu_planning_scene::core::literature
