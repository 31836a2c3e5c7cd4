#include "node/markers/goal_markers.h"

#include <algorithm>
#include <cstddef>
#include <variant>

#include "node/markers/shape_markers.h"
#include "node/messages/pose_messages.h"

namespace gpu_planning_scene::core
{
namespace
{
using visualization_msgs::Marker;

constexpr std::size_t kMaxGoals = 32;
constexpr double kAxisLength = 0.1;      // metres
constexpr double kAxisWidth = 0.006;     // metres
constexpr double kGoalDiameter = 0.03;   // metres
constexpr double kReasonHeight = 0.025;  // metres, of a capital letter
constexpr double kReached = 1e-6;        // metres and radians: the planner rounds its states
constexpr BodyColor kReachedGoal{0, 170, 60, 255};
constexpr BodyColor kOtherGoal{130, 130, 130, 255};
constexpr BodyColor kInvalidGoal{220, 30, 30, 255};
constexpr std::uint8_t kRegionOpacity = 70;

bool hasNoValidGoal(PlanningStatus status)
{
  return status == PlanningStatus::GoalUnreachable || status == PlanningStatus::GoalInCollision ||
         status == PlanningStatus::GoalViolatesConstraints;
}

/// The goals of a plan as markers.
class GoalMaker
{
 public:
  explicit GoalMaker(const ShownPlan& plan)
    : plan_(plan),
      end_(plan.waypoints.empty() ? plan.start : plan.waypoints.back()),
      poses_(plan.scene->robot->links().size()),
      markers_(headerOf(plan), {})
  {
    plan.scene->robot->linkPoses(end_.data(), poses_.data());
  }

  void add(const KinematicConstraints& goal)
  {
    const bool reached = isReached(goal);
    if (goal.positions.empty() && goal.orientations.empty())
      return;
    if (!reached && ++unreached_ > kMaxGoals)
      return;
    color_ = reached ? kReachedGoal : hasNoValidGoal(plan_.status) ? kInvalidGoal : kOtherGoal;
    for (const PositionConstraint& position : goal.positions)
      addPosition(position, goal.orientations);
    for (const OrientationConstraint& orientation : goal.orientations)
      if (positionOf(orientation.link, goal.positions) == goal.positions.end())
        addAxes(poses_[static_cast<std::size_t>(orientation.link)].translation(), orientation);
  }

  std::vector<Marker> take()
  {
    std::vector<Marker> markers = markers_.take().markers;
    markers.erase(markers.begin());  // deletes all markers
    return markers;
  }

 private:
  static std_msgs::Header headerOf(const ShownPlan& plan)
  {
    std_msgs::Header header;
    header.frame_id = plan.scene->robot->planningFrame();
    return header;
  }

  static std::vector<PositionConstraint>::const_iterator positionOf(int link,
                                                                    const std::vector<PositionConstraint>& positions)
  {
    return std::find_if(
        positions.begin(), positions.end(),
        [link](const PositionConstraint& position) { return position.link == link; });
  }

  bool isReached(const KinematicConstraints& goal) const
  {
    return plan_.status == PlanningStatus::Solved && violationOf(goal, poses_.data(), end_.data()).sum() < kReached;
  }

  void addPosition(const PositionConstraint& position, const std::vector<OrientationConstraint>& orientations)
  {
    bool has_axes = false;
    for (const OrientationConstraint& orientation : orientations)
      if (orientation.link == position.link)
      {
        addAxes(position.pose.translation(), orientation);
        has_axes = true;
      }
    if (has_axes)
      return;
    BodyColor color = color_;
    color[3] = kRegionOpacity;
    markers_.begin("goal_regions", color);
    if (const auto* box = std::get_if<Box>(&position.region))
      markers_.addShape(*box, position.pose);
    else
      markers_.addShape(std::get<Sphere>(position.region), position.pose);
    addSphere(position.pose.translation());
  }

  void addAxes(const Eigen::Vector3d& origin, const OrientationConstraint& orientation)
  {
    Eigen::Isometry3d pose(orientation.wanted);
    pose.translation() = origin;
    markers_.begin("goal_axes", kOtherGoal);
    Marker& marker = markers_.add(Marker::LINE_LIST, pose);
    marker.scale.x = kAxisWidth;
    for (int axis = 0; axis < 3; ++axis)
    {
      marker.points.push_back(pointOf(Eigen::Vector3d::Zero()));
      marker.points.push_back(pointOf(kAxisLength * Eigen::Vector3d::Unit(axis)));
      std_msgs::ColorRGBA color;
      (axis == 0 ? color.r : axis == 1 ? color.g : color.b) = 1.0F;
      color.a = 1.0F;
      marker.colors.insert(marker.colors.end(), 2, color);
    }
    addSphere(origin);
  }

  void addSphere(const Eigen::Vector3d& origin)
  {
    const Eigen::Isometry3d pose(Eigen::Translation3d{origin});
    markers_.begin("goals", color_);
    setScale(markers_.add(Marker::SPHERE, pose), Eigen::Vector3d::Constant(kGoalDiameter));
    if (color_ != kInvalidGoal || has_reason_)
      return;
    has_reason_ = true;
    markers_.begin("goal_reasons", color_);
    Marker& text = markers_.add(Marker::TEXT_VIEW_FACING, pose);
    text.pose.position.z += kAxisLength + kReasonHeight;
    text.scale.z = kReasonHeight;
    text.text = plan_.message;
  }

  const ShownPlan& plan_;
  const std::vector<double>& end_;
  std::vector<Eigen::Isometry3d> poses_;
  ShapeMarkers markers_;
  BodyColor color_{};
  std::size_t unreached_ = 0;
  bool has_reason_ = false;
};
}  // namespace

std::vector<Marker> goalMarkers(const ShownPlan& plan)
{
  GoalMaker maker(plan);
  for (const KinematicConstraints& goal : plan.goal_regions)
    maker.add(goal);
  return maker.take();
}
}  // namespace gpu_planning_scene::core
