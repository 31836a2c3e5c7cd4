#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "collision/cpu/lanes/lane_frames.h"
#include "collision/cpu/lanes/lane_model.h"
#include "collision/exact/exact_checker.h"
#include "collision/problem/collision_problem.h"
#include "collision/proofs/robot_proofs.h"
#include "collision/trees/cpu_forest.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// A collision problem in the form of the lane kernel, with thresholds that include the rounding errors of the code
/// that uses them (docs/error_bounds.md). Immutable.
class LaneScene
{
 public:
  LaneScene(const RobotModel& robot, const CollisionProblem& problem, const CpuForest& forest,
            std::shared_ptr<const RobotProofs> proofs, const lanes::Rounding& rounding = lanes::kKernelRounding);

  const lanes::Model& model() const { return model_; }

  /// Whether the error bounds hold for a state: no value is too large for float arithmetic.
  bool isWithinBounds(const double* state) const { return frames_.isWithinBounds(state); }
  const LaneFrames& frames() const { return frames_; }
  /// Of the kernel's coordinates, in the planning frame.
  const Eigen::Vector3d& origin() const { return origin_; }

  /// The centres (of instances and clusters, see lanes::SelfGroup) that attached objects have no part in.
  const std::vector<std::uint32_t>& linkCenters() const { return link_centers_; }
  /// Whether attached objects have no part in a group.
  bool isOfLinks(const lanes::SelfGroup& group) const;

  /// For each world pair of the kernel, a box in the kernel's coordinates. If the centre of the instance's enclosing
  /// ball is farther from it than the radius of the ball, the pair is apart.
  const std::vector<Eigen::AlignedBox3d>& worldBounds() const { return world_bounds_; }

  /// The instances of a pair of the kernel.
  const InstancePair& instancesOf(std::uint32_t pair) const { return pairs_[pair]; }
  std::size_t pairCount() const { return pairs_.size(); }

  /// The place of a kernel's self pair in CollisionProblem::self_pairs.
  std::size_t selfPairOf(std::uint32_t pair) const { return self_pair_of_[pair]; }

 private:
  /// Bounds for the centres of an instance's balls and box, or for that of a cluster, in metres.
  struct CenterError
  {
    int frame;
    double in_frame = 0.0;          // largest distance of a centre from the origin of its frame
    double largest_distance = 0.0;  // largest distance of a centre from the origin of coordinates
    double position = 0.0;
  };
  /// Error bounds for the test of an instance's box.
  struct BoxError
  {
    double rotation = 0.0;  // of the box's axes
    double radius = 0.0;    // half the diagonal of the box, in metres
  };

  void addInstance(const ShapeInstance& instance, const BallCover& cover, const OrientedBox& box);
  void addClusters();
  void findLinkCenters(const CollisionProblem& problem);
  void addSelfPairs(const CollisionProblem& problem);
  void addSelfPair(std::size_t p, const CollisionProblem& problem);
  void addSelfGroups(std::uint32_t first);
  std::uint32_t centerOf(std::uint32_t instance) const;
  lanes::FrameBox frameBox(const Eigen::AlignedBox3d& bounds) const;
  void addWorld(const CollisionProblem& problem, const CpuForest& forest);
  double distanceBetween(const CenterError& a, const CenterError& b) const;
  double selfError(std::uint32_t a, std::uint32_t b) const;
  lanes::BoxThresholds boxThresholds(std::uint32_t a, std::uint32_t b) const;

  lanes::Rounding rounding_;
  std::shared_ptr<const RobotProofs> proofs_;
  Eigen::Vector3d origin_;  // of the kernel's coordinates, in the planning frame
  LaneFrames frames_;

  std::vector<CenterError> instance_errors_;
  std::vector<BoxError> box_errors_;

  std::vector<lanes::Instance> instances_;
  std::vector<lanes::Object> objects_;
  std::vector<lanes::Table> tables_;
  std::vector<lanes::Cluster> clusters_;
  std::vector<int> cluster_of_frame_;  // -1: none
  std::vector<lanes::SelfPair> self_pairs_;
  std::vector<lanes::SelfGroup> self_groups_;
  std::vector<lanes::WorldPair> world_pairs_;
  std::vector<lanes::WorldGroup> world_groups_;
  std::vector<Eigen::AlignedBox3d> world_bounds_;
  std::vector<std::uint32_t> link_centers_;  // ascending
  std::vector<InstancePair> pairs_;
  std::vector<std::size_t> self_pair_of_;
  lanes::Model model_ = {};
};
}  // namespace gpu_planning_scene::core
