#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/cpu_forest.h"

namespace gpu_planning_scene::core
{
/// A plane, and all below it: points x with normal . x <= offset.
struct PlacedHalfSpace
{
  Eigen::Vector3d normal;
  double offset;
};

/// Decides pairs of placed shapes, as the contract says and kSlack explains: solids by their true surfaces, meshes by
/// their triangles and by what their closed components hold. Distances are right to 1e-10 m for coordinates within a
/// kilometre; a pair's answer does not depend on the trees.
/// With a tolerance above 0, pairs of which one is a mesh may be called colliding without a look at their triangles,
/// where nodes of the trees show that they are no further apart than the required distance and the tolerance. Then
/// answers within the tolerance do depend on the trees.
class CpuShapePair
{
 public:
  /// Work space of one thread.
  struct Scratch
  {
    std::vector<std::array<std::uint32_t, 2>> node_pairs;
    std::vector<std::uint32_t> nodes;
    std::uint64_t steps = 0;  // nodes looked at so far: what the pairs cost
  };

  /// `tolerance`: metres, at least 0.
  explicit CpuShapePair(std::shared_ptr<const CpuForest> forest, double tolerance = 0.0)
    : forest_(std::move(forest)), tolerance_(tolerance)
  {
  }

  /// Whether two shapes, by their trees, collide where `required` is the pair's required distance.
  bool collide(std::uint32_t a, const Eigen::Isometry3d& pose_a, std::uint32_t b, const Eigen::Isometry3d& pose_b,
               double required, Scratch& scratch) const;

  bool collide(std::uint32_t tree, const Eigen::Isometry3d& pose, const PlacedHalfSpace& half_space, double required,
               Scratch& scratch) const;

 private:
  bool surfaceMeetsSolid(const CpuTree& mesh, const CpuTree& solid, const Eigen::Isometry3d& mesh_in_solid,
                         double required, Scratch& scratch) const;
  bool surfacesMeet(const CpuTree& a, const CpuTree& b, const Eigen::Isometry3d& b_in_a, double required,
                    Scratch& scratch) const;

  std::shared_ptr<const CpuForest> forest_;
  double tolerance_;
};

/// The tree's root box, placed and made a little larger than rounding makes it smaller.
Eigen::AlignedBox3d boundsOf(const CpuTree& tree, const Eigen::Isometry3d& pose);
}  // namespace gpu_planning_scene::core
