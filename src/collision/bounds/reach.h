#pragma once

#include <optional>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
struct Ball
{
  Eigen::Vector3d center;
  double radius;  ///< metres
};

/// Balls that hold a body wherever the joints take it, and one that holds them all.
struct Region
{
  std::vector<Ball> balls;
  Ball all;
};

/// The regions of a body in the frames of its link, of its parent, and so on up to the planning frame, as far as there
/// are bounds.
struct SweptBody
{
  int link;
  std::vector<Region> above;  ///< by how many links the frame is above `link`
};

/// The limits of the robot's revolute and prismatic joints, and a little more: within them bounds on reach hold.
std::vector<VariableRange> limitRanges(const RobotModel& robot);

/// Where the joints of a robot, within their limits, can take what moves with its links. Bounds that hold: nothing is
/// sampled. Regions are sets of balls, since a ball that is turned is the same ball; each joint sweeps them along arcs
/// or segments, which are cut into parts and covered with balls again.
class Reach
{
 public:
  explicit Reach(const RobotModel& robot);

  /// Of the shapes of a body that moves with `link`, `pose` being that of their frame in the link's. The inside of
  /// meshes is held too.
  SweptBody sweep(const std::vector<PlacedShape>& shapes, const Eigen::Isometry3d& pose, int link) const;

  /// Whether two bodies of the robot may come within `distance` of each other, as far as the bounds tell.
  bool mayMeet(const SweptBody& a, const SweptBody& b, double distance) const;

  /// Where a body can be in the planning frame; null: anywhere.
  const Region* inPlanningFrame(const SweptBody& body) const;

  /// See limitRanges.
  const std::vector<VariableRange>& ranges() const { return ranges_; }

 private:
  /// The joint's position; no value: no bound.
  struct Interval
  {
    double lower;
    double upper;
  };

  int depth(int link) const { return link < 0 ? -1 : depths_[static_cast<std::size_t>(link)]; }
  int parent(int link) const;
  std::optional<Interval> positions(const Joint& joint) const;
  std::optional<Region> swept(const Region& region, const Joint& joint) const;

  std::vector<Joint> parent_joints_;  // of each link; a fixed one of the planning frame where there is none
  std::vector<int> depths_;
  std::vector<VariableRange> ranges_;
  std::vector<std::optional<Interval>> intervals_;  // of each variable, a little wider than its limits
};

struct PlacedBox
{
  PlacedBox(const Eigen::Isometry3d& pose_of_center, const Eigen::Vector3d& half_lengths);

  Eigen::Isometry3d pose;  ///< of its centre
  Eigen::Vector3d half;    ///< half lengths of its edges
  double radius;
  double rounding;  ///< metres: of what is computed with it
};
using Obstacle = std::variant<PlacedBox, HalfSpace>;

/// Whether something of a region may come within `distance` of an obstacle in the same frame.
bool mayMeet(const Region& region, const Obstacle& obstacle, double distance);
}  // namespace gpu_planning_scene::core
