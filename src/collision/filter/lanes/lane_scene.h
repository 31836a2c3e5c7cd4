#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/cpu_forest.h"
#include "collision/exact/cpu_traversal.h"
#include "collision/filter/lanes/lane_model.h"
#include "collision/filter/proofs/robot_proofs.h"
#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// A collision problem in the form of the lane kernel, with thresholds that include the kernel's rounding errors
/// (docs/error_bounds.md). Immutable.
class LaneScene
{
 public:
  LaneScene(std::shared_ptr<const RobotModel> robot, const CollisionProblem& problem, const CpuForest& forest,
            std::shared_ptr<const RobotProofs> proofs);

  const lanes::Model& model() const { return model_; }

  /// Whether the error bounds hold for a state: no value is too large for float arithmetic.
  bool isWithinBounds(const double* state) const;

  /// The instances of a pair of the kernel.
  const InstancePair& instancesOf(std::uint32_t pair) const { return pairs_[pair]; }
  std::size_t pairCount() const { return pairs_.size(); }

  /// The place of a kernel's self pair in CollisionProblem::self_pairs.
  std::size_t selfPairOf(std::uint32_t pair) const { return self_pair_of_[pair]; }

 private:
  /// The values of a variable for which the error bounds hold: those within `most` of `middle`.
  struct Limit
  {
    double middle = 0.0;
    double most = std::numeric_limits<double>::max();
  };

  /// A motion along an axis, by multiplier * variable + offset.
  struct Slide
  {
    Eigen::Vector3d axis;
    int variable;
    double middle;  // of the variable
    double most;    // metres: the largest distance of the variable from the middle
    double multiplier = 1.0;
    double offset = 0.0;
  };

  /// Error bounds of the kernel for a frame, in metres.
  struct FrameError
  {
    double step = 0.0;              // largest distance of the frame's origin from the origin of its parent
    double largest_distance = 0.0;  // largest distance of the frame's origin from the origin of coordinates
    double rotation = 0.0;          // of a rotated vector of length 1
    double position = 0.0;          // of the frame's origin
  };

  /// Error bounds for the centres of an instance's balls, in metres.
  struct InstanceError
  {
    double largest_distance = 0.0;  // largest distance of a centre from the origin of coordinates
    double position = 0.0;
  };
  /// Error bounds for the test of an instance's box.
  struct BoxError
  {
    double rotation = 0.0;  // of the box's axes
    double radius = 0.0;    // half the diagonal of the box, in metres
  };

  void addFrames();
  int addFramesOf(const Joint& joint, int parent, const Eigen::Isometry3d& origin);
  int addTurn(const Joint& joint, int variable, int parent, const Eigen::Isometry3d& origin);
  int addSlide(const Slide& slide, int parent, const Eigen::Isometry3d& origin);
  int addQuaternion(int variable, int parent);
  int addFrame(lanes::Frame frame, int parent, double step, double turn);
  void limit(int variable, const Limit& limit);
  void addInstance(const ShapeInstance& instance, const BallCover& cover, const OrientedBox& box);
  void addClusters();
  void addSelfPairs(const CollisionProblem& problem);
  void addSelfPair(std::size_t p, const CollisionProblem& problem);
  void addSelfGroups(std::uint32_t first);
  std::uint32_t centerOf(std::uint32_t instance) const;
  void addWorld(const CollisionProblem& problem, const CpuForest& forest);
  double selfError(std::uint32_t a, std::uint32_t b) const;
  lanes::BoxThresholds boxThresholds(std::uint32_t a, std::uint32_t b) const;

  std::shared_ptr<const RobotModel> robot_;
  std::shared_ptr<const RobotProofs> proofs_;
  Eigen::Vector3d origin_;  // of the kernel's coordinates, in the planning frame

  std::vector<int> frame_of_link_;
  std::vector<Eigen::Isometry3d> in_frame_;  // of each link: its pose in its frame
  std::vector<Limit> limits_;                // of each variable, see isWithinBounds
  std::vector<FrameError> frame_errors_;
  std::vector<InstanceError> instance_errors_;
  std::vector<BoxError> box_errors_;

  std::vector<lanes::Frame> frames_;
  std::vector<lanes::Instance> instances_;
  std::vector<lanes::Object> objects_;
  std::vector<lanes::Table> tables_;
  std::vector<lanes::Cluster> clusters_;
  std::vector<int> cluster_of_frame_;  // -1: none
  std::vector<lanes::SelfPair> self_pairs_;
  std::vector<lanes::SelfGroup> self_groups_;
  std::vector<lanes::WorldPair> world_pairs_;
  std::vector<lanes::WorldGroup> world_groups_;
  std::vector<InstancePair> pairs_;
  std::vector<std::size_t> self_pair_of_;
  lanes::Model model_ = {};
};
}  // namespace gpu_planning_scene::core
