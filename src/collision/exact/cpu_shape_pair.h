#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "collision/geometry/convex_pair.h"
#include "collision/trees/cpu_forest.h"
#include "collision/trees/wide_tests.h"

namespace gpu_planning_scene::core
{
/// All points x with normal . x <= offset.
struct PlacedHalfSpace
{
  Eigen::Vector3d normal;
  double offset;
};

/// Decides whether two placed shapes collide, by the rule of kSlack (triangle_pair.h): primitives by their exact
/// surfaces, meshes by their triangles and by the solids of their closed components. Distances are accurate to 1e-10 m
/// for coordinates within a kilometre. The verdict of a pair does not depend on the trees.
class CpuShapePair
{
 public:
  /// Boxes of wide trees and a lower bound of their distance, for searches for a clearance.
  struct NearBoxes
  {
    double least;
    BoxIndex a;
    BoxIndex b;
  };

  /// Work space of one thread.
  struct Scratch
  {
    std::vector<std::array<std::uint32_t, 2>> node_pairs;
    std::vector<NearBoxes> near_boxes;
    std::vector<std::uint32_t> nodes;
    std::uint64_t steps = 0;  // the cost of the pairs so far, in visits of nodes of a binary tree
    SeparatingAxis axis;      // of the last triangles and solid

    // Testing eight boxes costs about as much as visiting this many nodes of a binary tree.
    static constexpr std::uint64_t kStepsOfEightBoxes = 2;
  };

  explicit CpuShapePair(std::shared_ptr<const CpuForest> forest)
    : forest_(std::move(forest)), tests_(availableWideTests().front())
  {
  }

  /// Whether the shapes of trees `a` and `b` collide. `required` is the required distance of the pair.
  bool collide(std::uint32_t a, const Eigen::Isometry3d& pose_a, std::uint32_t b, const Eigen::Isometry3d& pose_b,
               double required, Scratch& scratch) const;

  bool collide(std::uint32_t tree, const Eigen::Isometry3d& pose, const PlacedHalfSpace& half_space, double required,
               Scratch& scratch) const;

  /// The same for trees that need not be in the forest.
  bool collide(const CpuTree& a, const Eigen::Isometry3d& pose_a, const CpuTree& b, const Eigen::Isometry3d& pose_b,
               double required, Scratch& scratch) const;
  bool collide(const CpuTree& tree, const Eigen::Isometry3d& pose, const PlacedHalfSpace& half_space, double required,
               Scratch& scratch) const;

 private:
  bool surfaceMeetsSolid(const CpuTree& mesh, const CpuTree& solid, const Eigen::Isometry3d& mesh_in_solid,
                         double required, Scratch& scratch) const;
  bool leavesMeet(const CpuTree& a, BoxIndex leaf_a, const CpuTree& b, BoxIndex leaf_b, const Eigen::Isometry3d& b_in_a,
                  const WidePlacement& in_a, double required) const;
  bool surfacesMeet(const CpuTree& a, const CpuTree& b, const Eigen::Isometry3d& b_in_a, double required,
                    Scratch& scratch) const;

  std::shared_ptr<const CpuForest> forest_;
  WideTests tests_;
};

/// An axis-aligned box in the frame of `pose` that contains the shape; it is enlarged by more than the rounding error.
Eigen::AlignedBox3d boundsOf(const CpuTree& tree, const Eigen::Isometry3d& pose);
}  // namespace gpu_planning_scene::core
