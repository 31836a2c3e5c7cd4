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

/// At most `most` balls that together contain all of `balls`.
std::vector<Ball> clustered(std::vector<Ball> balls, std::size_t most);

/// Balls that together contain a body for all positions of the joints, and one ball that contains them all.
struct Region
{
  std::vector<Ball> balls;
  Ball enclosing;
};

/// The regions of a body in the frame of its link, of the parent link, and so on up to the planning frame. The list
/// ends early if a region is not bounded.
struct SweptBody
{
  int link;
  std::vector<Region> region_by_level;  ///< index i: the frame i links above `link`
};

/// The limits of the robot's revolute and prismatic joints, slightly enlarged. The reach bounds hold for states within
/// these ranges.
std::vector<VariableRange> limitRanges(const RobotModel& robot);

/// The ranges of variables within which motions are proven free: limitRanges, the limits of planar and floating joints
/// (slightly enlarged too), and for each variable that turns joints the values at which none of them is beyond
/// kLargestProvenAngle.
std::vector<VariableRange> provenRanges(const RobotModel& robot);

/// Upper bounds of the regions that a robot's bodies can reach while the joints stay within their limits. Nothing is
/// sampled. A region is a set of balls, because a rotated ball is still a ball. A joint sweeps each ball along an arc
/// or a segment; the swept volume is cut into parts, and each part is covered with a ball again.
class Reach
{
 public:
  explicit Reach(const RobotModel& robot);

  /// Sweeps the shapes of a body that moves with `link`. `pose` is the pose of the shapes' frame in the frame of the
  /// link. The regions contain the inside of meshes too.
  SweptBody sweep(const std::vector<PlacedShape>& shapes, const Eigen::Isometry3d& pose, int link) const;

  /// Whether two bodies of the robot may come within `distance` of each other. False is proven; true means only that
  /// the bounds do not exclude it.
  bool mayMeet(const SweptBody& a, const SweptBody& b, double distance) const;

  /// The region of a body in the planning frame; null: not bounded.
  const Region* inPlanningFrame(const SweptBody& body) const;

  /// See limitRanges.
  const std::vector<VariableRange>& ranges() const { return ranges_; }

 private:
  /// Range of a joint's position, in radians or metres.
  struct Interval
  {
    double lower;
    double upper;
  };

  int depth(int link) const { return link < 0 ? -1 : depths_[static_cast<std::size_t>(link)]; }
  int parent(int link) const;
  std::optional<Interval> positions(const Joint& joint) const;
  std::optional<Region> swept(const Region& region, const Joint& joint) const;

  std::vector<Joint> parent_joints_;  // of each link; a root link has a fixed joint to the planning frame
  std::vector<int> depths_;
  std::vector<VariableRange> ranges_;
  std::vector<std::optional<Interval>> intervals_;  // of each variable: its limits, slightly enlarged; empty: unbounded
};

struct PlacedBox
{
  PlacedBox(const Eigen::Isometry3d& pose_of_center, const Eigen::Vector3d& half_lengths);

  Eigen::Isometry3d pose;  ///< pose of the box's centre
  Eigen::Vector3d half;    ///< half lengths of the edges
  double radius;
  double rounding;  ///< metres: rounding error of tests with this box
};
using Obstacle = std::variant<PlacedBox, HalfSpace>;

/// Whether a region may come within `distance` of an obstacle in the same frame.
bool mayMeet(const Region& region, const Obstacle& obstacle, double distance);
}  // namespace gpu_planning_scene::core
