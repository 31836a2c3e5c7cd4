// The markers of a plan's goals.

#include <gtest/gtest.h>

#include "node/markers/goal_markers.h"
#include "node/messages/object_from_message.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
using visualization_msgs::Marker;

constexpr double kAnyOrientation = 4.0;  // radians

/// A goal of the cart's centre.
KinematicConstraints cartGoal(const ShownPlan& plan, double x, double orientation_tolerance = 1e-3)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().x() = x;
  return KinematicConstraints::pose(plan.scene->robot->linkIndex("cart"), Eigen::Isometry3d::Identity(), pose, 0.05,
                                    orientation_tolerance);
}

/// The cart moves from x = -1 to 1 m.
ShownPlan driveOfCart()
{
  ShownPlan plan;
  plan.scene = std::make_shared<const PlanningScene>(sliderRobot());
  plan.group = plan.scene->robot->group("drive");
  plan.start = plan.scene->robot->defaultState();
  const auto slide = static_cast<std::size_t>(plan.scene->robot->variableIndex("slide"));
  plan.start[slide] = -1.0;
  plan.waypoints = {plan.start, plan.start};
  plan.waypoints[1][slide] = 1.0;
  plan.status = PlanningStatus::Solved;
  return plan;
}

std::vector<Marker> goalMarkersOf(const ShownPlan& plan, const std::string& name)
{
  std::vector<Marker> markers;
  for (const Marker& marker : goalMarkers(plan))
    if (marker.ns == name)
      markers.push_back(marker);
  return markers;
}

bool isRed(const Marker& marker)
{
  return marker.color.r > 2.0F * marker.color.g && marker.color.r > 2.0F * marker.color.b;
}

bool isGreen(const Marker& marker)
{
  return marker.color.g > 2.0F * marker.color.r && marker.color.g > 2.0F * marker.color.b;
}

bool isGrey(const Marker& marker)
{
  return marker.color.r == marker.color.g && marker.color.g == marker.color.b;
}

TEST(GoalMarkers, TheReachedGoalIsGreenAndOthersAreGrey)
{
  ShownPlan plan = driveOfCart();
  plan.goal_regions = {cartGoal(plan, 0.5), cartGoal(plan, 1.0)};
  const std::vector<Marker> goals = goalMarkersOf(plan, "goals");
  ASSERT_EQ(2u, goals.size());
  EXPECT_EQ(Marker::SPHERE, goals[0].type);
  EXPECT_NEAR(0.5, goals[0].pose.position.x, 1e-9);
  EXPECT_NEAR(1.0, goals[1].pose.position.x, 1e-9);
  EXPECT_TRUE(isGrey(goals[0]));
  EXPECT_TRUE(isGreen(goals[1]));
  EXPECT_TRUE(goalMarkersOf(plan, "goal_reasons").empty());
}

TEST(GoalMarkers, APathThatIsNoSolutionReachesNoGoal)
{
  ShownPlan plan = driveOfCart();
  plan.goal_regions = {cartGoal(plan, 1.0)};
  for (const PlanningStatus status :
       {PlanningStatus::Approximate, PlanningStatus::NoSolution, PlanningStatus::StartInCollision})
  {
    plan.status = status;
    ASSERT_EQ(1u, goalMarkersOf(plan, "goals").size());
    EXPECT_TRUE(isGrey(goalMarkersOf(plan, "goals")[0]));
  }
}

TEST(GoalMarkers, GoalsWithoutAValidStateAreRedAndTheFirstHasTheReason)
{
  ShownPlan plan = driveOfCart();
  plan.goal_regions = {cartGoal(plan, 7.0), cartGoal(plan, 8.0)};
  plan.waypoints.clear();
  plan.message = "the goal is unreachable";
  for (const PlanningStatus status :
       {PlanningStatus::GoalUnreachable, PlanningStatus::GoalInCollision, PlanningStatus::GoalViolatesConstraints})
  {
    plan.status = status;
    const std::vector<Marker> goals = goalMarkersOf(plan, "goals");
    ASSERT_EQ(2u, goals.size());
    EXPECT_TRUE(isRed(goals[0]));
    EXPECT_TRUE(isRed(goals[1]));
    const std::vector<Marker> reasons = goalMarkersOf(plan, "goal_reasons");
    ASSERT_EQ(1u, reasons.size());
    EXPECT_EQ(Marker::TEXT_VIEW_FACING, reasons[0].type);
    EXPECT_EQ("the goal is unreachable", reasons[0].text);
    EXPECT_NEAR(7.0, reasons[0].pose.position.x, 1e-9);
  }
}

TEST(GoalMarkers, AxesStandInTheGoalPose)
{
  ShownPlan plan = driveOfCart();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(0.5 * std::acos(-1.0), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(1.0, 2.0, 3.0);
  plan.goal_regions = {KinematicConstraints::pose(plan.scene->robot->linkIndex("cart"), Eigen::Isometry3d::Identity(),
                                                  pose, 1e-3, 1e-3)};
  EXPECT_TRUE(goalMarkersOf(plan, "goal_regions").empty());
  const std::vector<Marker> axes = goalMarkersOf(plan, "goal_axes");
  ASSERT_EQ(1u, axes.size());
  EXPECT_EQ(plan.scene->robot->planningFrame(), axes[0].header.frame_id);
  ASSERT_EQ(6u, axes[0].points.size());
  ASSERT_EQ(6u, axes[0].colors.size());
  EXPECT_EQ(1.0F, axes[0].colors[1].r);
  EXPECT_EQ(1.0F, axes[0].colors[3].g);
  EXPECT_EQ(1.0F, axes[0].colors[5].b);
  const Eigen::Isometry3d placed = isometryOf(axes[0].pose);
  const auto point = [&](std::size_t i)
  { return Eigen::Vector3d(placed * Eigen::Vector3d(axes[0].points[i].x, axes[0].points[i].y, axes[0].points[i].z)); };
  EXPECT_LT((point(0) - pose.translation()).norm(), 1e-9);
  EXPECT_LT((point(1) - Eigen::Vector3d(1.0, 2.1, 3.0)).norm(), 1e-9) << "the x axis points along y";
  EXPECT_LT((point(5) - Eigen::Vector3d(1.0, 2.0, 3.1)).norm(), 1e-9);
}

TEST(GoalMarkers, APositionWithoutAnOrientationIsARegion)
{
  ShownPlan plan = driveOfCart();
  KinematicConstraints box = cartGoal(plan, 1.0, kAnyOrientation);
  box.positions[0].region = Box{Eigen::Vector3d(0.4, 0.2, 0.1)};
  plan.goal_regions = {cartGoal(plan, 0.5, kAnyOrientation), box};
  EXPECT_TRUE(goalMarkersOf(plan, "goal_axes").empty());
  EXPECT_EQ(2u, goalMarkersOf(plan, "goals").size());
  const std::vector<Marker> regions = goalMarkersOf(plan, "goal_regions");
  ASSERT_EQ(2u, regions.size());
  EXPECT_EQ(Marker::SPHERE_LIST, regions[0].type);
  EXPECT_NEAR(0.1, regions[0].scale.x, 1e-9);
  EXPECT_EQ(Marker::CUBE_LIST, regions[1].type);
  EXPECT_NEAR(0.4, regions[1].scale.x, 1e-9);
  EXPECT_NEAR(1.0, regions[1].points.at(0).x, 1e-9);
  EXPECT_TRUE(isGrey(regions[0]));
  EXPECT_TRUE(isGreen(regions[1]));
  EXPECT_LT(regions[0].color.a, 0.5F);
}

TEST(GoalMarkers, AnOrientationWithoutAPositionIsAtItsLink)
{
  ShownPlan plan = driveOfCart();
  plan.goal_regions = {cartGoal(plan, 5.0)};
  plan.goal_regions[0].positions.clear();
  ASSERT_EQ(1u, goalMarkersOf(plan, "goal_axes").size());
  EXPECT_NEAR(1.0, goalMarkersOf(plan, "goal_axes")[0].pose.position.x, 1e-9) << "at the end of the path";
  EXPECT_TRUE(isGreen(goalMarkersOf(plan, "goals").at(0)));
  plan.waypoints.clear();
  plan.status = PlanningStatus::NoSolution;
  EXPECT_NEAR(-1.0, goalMarkersOf(plan, "goal_axes").at(0).pose.position.x, 1e-9) << "at the start";
}

TEST(GoalMarkers, OfManyGoalsTheReachedOneIsDrawn)
{
  ShownPlan plan = driveOfCart();
  for (int i = 0; i < 100; ++i)
    plan.goal_regions.push_back(cartGoal(plan, 10.0 + i));
  plan.goal_regions.push_back(cartGoal(plan, 1.0));
  const std::vector<Marker> goals = goalMarkersOf(plan, "goals");
  ASSERT_EQ(33u, goals.size());
  EXPECT_TRUE(isGreen(goals.back()));
}

TEST(GoalMarkers, GoalsOfJointsHaveNoMarker)
{
  ShownPlan plan = driveOfCart();
  EXPECT_TRUE(goalMarkers(plan).empty());
  plan.goal_regions.emplace_back();
  plan.goal_regions[0].addJoint(*plan.scene->robot, plan.scene->robot->variableIndex("slide"), 0.9, 1.0);
  EXPECT_TRUE(goalMarkers(plan).empty());
}
}  // namespace
}  // namespace gpu_planning_scene::core
