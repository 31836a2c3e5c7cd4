// ~plan finds motions over ROS with any planner, also for two clients at once, and reports errors of a request. The
// node has planners.yaml, plan_parameters.yaml and the slider robot.

#include <algorithm>
#include <cmath>
#include <thread>

#include <gpu_planning_scene/PlanMotion.h>
#include <visualization_msgs/MarkerArray.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/motion_checker.h"
#include "node/node_client.h"
#include "node/planning/plan_service.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
using Response = PlanMotion::Response;

constexpr double kTurned = 0.785;  // radians: at this angle the pole does not fit into the slot

CollisionObject plate(const std::string& id, const Eigen::Vector3d& position, const Eigen::Vector3d& size)
{
  CollisionObject object = boxObject(id, position, 1.0);
  object.primitives[0].dimensions = {size.x(), size.y(), size.z()};
  return object;
}

class Planning : public RunningNode
{
 public:
  void SetUp() override
  {
    RunningNode::SetUp();
    // The pole is 0.1 m wide. It fits between the plates only if it is turned.
    apply(diffWith(plate("left", {0.0, 0.565, 0.5}, {0.4, 1.0, 0.4})));
    apply(diffWith(plate("right", {0.0, -0.565, 0.5}, {0.4, 1.0, 0.4})));
  }

  static PlanMotion::Request request()
  {
    PlanMotion::Request request;
    request.group = "drive";
    request.start_names = request.goal_names = {"slide", "turn"};
    request.start = {-1.0, kTurned};
    request.goals = {1.0, kTurned};
    request.simplify = true;
    return request;
  }

  static Response plan(const PlanMotion::Request& request) { return call<PlanMotion>("plan", request); }

  /// Expects a solution from start to goal whose motions are free.
  static void expectSolved(const Response& response, const std::vector<double>& start, const std::vector<double>& goal)
  {
    ASSERT_TRUE(response.success) << response.message;
    EXPECT_EQ(response.status, AnswerStatus::OK);
    EXPECT_EQ(response.trajectory.joint_names, (std::vector<std::string>{"slide", "turn"}));
    ASSERT_GT(response.trajectory.points.size(), 2u);
    EXPECT_EQ(response.trajectory.points.front().positions, start);
    EXPECT_EQ(response.trajectory.points.back().positions, goal);
    EXPECT_GT(response.states_checked, 0u);
    EXPECT_GT(response.planning_time, 0.0);
    for (std::size_t i = 0; i + 1 < response.trajectory.points.size(); ++i)
    {
      CheckMotions::Request motion;
      motion.group = "drive";
      motion.joint_names = response.trajectory.joint_names;
      motion.starts = response.trajectory.points[i].positions;
      motion.ends = response.trajectory.points[i + 1].positions;
      motion.resolution = motion.translation_resolution = 0.001;
      const auto checked = call<CheckMotions>("check_motions", motion);
      ASSERT_TRUE(checked.success) << checked.message;
      EXPECT_EQ(checked.valid, std::vector<std::uint8_t>{1}) << "motion " << i;
    }
  }

  static void expectStatus(const PlanMotion::Request& request, std::uint8_t status, const std::string& message)
  {
    const Response response = plan(request);
    EXPECT_FALSE(response.success);
    EXPECT_EQ(response.status, status) << response.message;
    EXPECT_NE(response.message.find(message), std::string::npos) << response.message;
  }
};

TEST_F(Planning, FindsThePathThroughASlotByPlannersOfAnyName)
{
  for (const std::string name :
       {"", "Batch", "RRTConnectkConfigDefault", "KPIECEkConfigDefault", "gpu_planning_scene/BatchRrtConnect",
        "gpu_planning_scene/AnytimeBatch", "geometric::PRM", "geometric::BITstar"})
  {
    SCOPED_TRACE(name);
    PlanMotion::Request wanted = request();
    wanted.planner = name;
    expectSolved(plan(wanted), wanted.start, wanted.goals);
  }
}

TEST_F(Planning, KnowsTheWayBack)
{
  PlanMotion::Request there = request();
  there.planner = "Batch";
  there.start[0] -= 0.1;  // no other test has found this way
  expectSolved(plan(there), there.start, there.goals);
  PlanMotion::Request back = there;
  std::swap(back.start, back.goals);
  back.parameters.resize(1);
  back.parameters[0].key = "max_rounds";
  back.parameters[0].value = "1";  // the straight motion, and known paths
  expectSolved(plan(back), back.start, back.goals);
}

TEST_F(Planning, OptimizesForAsLongAsTheRequestSays)
{
  PlanMotion::Request wanted = request();
  wanted.optimize = 0.2;
  const Response response = plan(wanted);
  expectSolved(response, wanted.start, wanted.goals);
  EXPECT_GE(response.simplification_time, 0.2);
  wanted.optimize = 1e6;
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "optimize is 1000000.000000 s; it must be from 0 to");
}

TEST_F(Planning, HasTimesIfTheRequestWantsThem)
{
  PlanMotion::Request wanted = request();
  wanted.times = true;
  wanted.max_velocity_scaling_factor = 0.5;
  const Response response = plan(wanted);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_NE(response.message.find("acceleration 1 (rad/s^2 or m/s^2) of slide, turn"), std::string::npos)
      << response.message;
  const auto& points = response.trajectory.points;
  ASSERT_GT(points.size(), 4u);
  EXPECT_EQ(points.front().positions, wanted.start);
  EXPECT_EQ(points.back().positions, wanted.goals);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    ASSERT_EQ(points[i].velocities.size(), 2u);
    ASSERT_EQ(points[i].accelerations.size(), 2u);
    for (const double velocity : points[i].velocities)
      EXPECT_LE(std::abs(velocity), 0.5 + 1e-9);
    for (const double acceleration : points[i].accelerations)
      EXPECT_LE(std::abs(acceleration), 1.0 + 1e-9);
    if (i > 0)
      EXPECT_GT(points[i].time_from_start, points[i - 1].time_from_start);
  }
  for (const auto* end : {&points.front(), &points.back()})
    EXPECT_EQ(end->velocities, (std::vector<double>{0.0, 0.0}));
  EXPECT_GE(points.back().time_from_start.toSec(), 4.0);
  wanted.times = false;
  expectSolved(plan(wanted), wanted.start, wanted.goals);
  EXPECT_TRUE(plan(wanted).trajectory.points.front().velocities.empty());
  for (const double factor : {-0.5, 1.5})
  {
    wanted.max_velocity_scaling_factor = factor;
    expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "max_velocity_scaling_factor is ");
  }
}

TEST_F(Planning, InAChangedSceneOfTheRequestLeavesTheSceneAsItIs)
{
  const PlanningSceneMessage before = scene();
  PlanMotion::Request wanted = request();
  wanted.scene_diff = diffWith(plate("post", {1.0, 0.0, 0.5}, {0.2, 0.2, 0.4}));
  expectStatus(wanted, Response::GOAL_IN_COLLISION, "post");
  wanted.scene_diff = diffWith(objectOperation("left", CollisionObject::REMOVE));
  const Response response = plan(wanted);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(before.scene_revision, response.scene_revision);
  EXPECT_EQ(before, scene());
  wanted.scene_diff.is_diff = 0;
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "scene_diff: is_diff is false");
  wanted.scene_diff = PlanningSceneMessage();
  expectSolved(plan(wanted), wanted.start, wanted.goals);

  // ~check_trajectory proves the whole path.
  const Response path = plan(wanted);
  CheckTrajectory::Request trajectory;
  trajectory.group = "drive";
  trajectory.start_state.joint_state.name = wanted.start_names;
  trajectory.start_state.joint_state.position = wanted.start;
  trajectory.joint_trajectory = path.trajectory;
  trajectory.resolution = trajectory.translation_resolution = 0.001;
  const auto checked = call<CheckTrajectory>("check_trajectory", trajectory);
  ASSERT_TRUE(checked.success) << checked.message;
  EXPECT_TRUE(checked.valid);
  EXPECT_EQ(path.trajectory.points.size(), checked.part_valid.size());
  trajectory.scene_diff = diffWith(plate("post", {0.0, 0.0, 0.5}, {0.2, 0.2, 0.4}));
  EXPECT_FALSE(call<CheckTrajectory>("check_trajectory", trajectory).valid);
  EXPECT_EQ(before, scene());
}

TEST_F(Planning, UsesAPlannerOfAnotherPackage)
{
  PlanMotion::Request wanted = request();
  wanted.planner = "Elsewhere";
  const Response response = plan(wanted);
  expectSolved(response, wanted.start, wanted.goals);
  EXPECT_EQ(response.planner, "planner_plugin/BKPIECE");
}

TEST_F(Planning, PlannerFaultsAreNotErrorsOfTheRequest)
{
  PlanMotion::Request wanted = request();
  wanted.planner = "broken_planner/Broken";
  expectStatus(wanted, AnswerStatus::INTERNAL_ERROR, "a planner that is broken");
  wanted.planner = "planner_plugin/BKPIECE";
  expectSolved(plan(wanted), wanted.start, wanted.goals);
}

/// A PlanService in this process, with parameters of its own below ~NAME.
class OwnPlanService
{
 public:
  explicit OwnPlanService(const std::string& name, const PlanServiceOptions& options = {})
    : own(ros::NodeHandle("~"), name),
      service(
          own, store, {},
          [](std::shared_ptr<const PlanningScene> scene) { return std::make_shared<CpuChecker>(std::move(scene)); },
          memory, [](const std::shared_ptr<const ShownPlan>&) {}, options)
  {
  }

  ros::NodeHandle own;
  SceneStore store{sliderAndWall(), {}, {}};
  MemoryGuard memory{0};
  PlanService service;
};

TEST_F(Planning, AWrongDefaultPlannerIsAFaultOfTheNode)
{
  ros::NodeHandle("~").setParam("wrong/planners/planner_configs/Mistyped/type", "geometric::RRTConnekt");
  ros::NodeHandle("~").setParam("wrong/planners/drive/default_planner_config", "Mistyped");
  OwnPlanService node("wrong");
  PlanMotion::Request wanted = request();
  wanted.goals = {0.5, kTurned};
  for (const std::string name : {"", "Mistyped"})
  {
    wanted.planner = name;
    const Response of_node = node.service.plan(wanted);
    EXPECT_EQ(AnswerStatus::INTERNAL_ERROR, of_node.status);
    EXPECT_EQ(0u, of_node.message.find("~planners: ")) << of_node.message;
  }
  wanted.planner = "geometric::RRTConnekt";
  EXPECT_EQ(AnswerStatus::INVALID_REQUEST, node.service.plan(wanted).status);
  wanted.planner = "geometric::RRTConnect";
  EXPECT_EQ(AnswerStatus::OK, node.service.plan(wanted).status);
}

TEST_F(Planning, ABusyAndAnEndingNodeSaySo)
{
  PlanServiceOptions options;
  options.at_once = 1;
  options.max_waiting = 0;
  options.max_seconds = 1000.0;
  OwnPlanService node("crowded", options);
  PlanMotion::Request wanted = request();
  wanted.goals = {1.5, 0.0};  // behind the wall
  wanted.allowed_planning_time = 1000.0;
  Response long_one;
  const auto plan_long = [&node, wanted, &long_one]
  {
    do
      long_one = node.service.plan(wanted);
    while (long_one.status == AnswerStatus::BUSY);  // the request below came first
  };
  std::thread client(plan_long);
  wanted.goals = {-0.9, kTurned};
  EXPECT_TRUE(becomes([&] { return node.service.plan(wanted).status == AnswerStatus::BUSY; }));
  node.service.stop();
  client.join();
  EXPECT_EQ(AnswerStatus::SHUTTING_DOWN, long_one.status) << long_one.message;
  EXPECT_EQ(AnswerStatus::SHUTTING_DOWN, node.service.plan(wanted).status);
}

TEST_F(Planning, TakesTheDefaultOfTheGroupAndParametersOfTheRequest)
{
  PlanMotion::Request wanted = request();
  EXPECT_EQ(plan(wanted).planner, "geometric::RRTConnect");
  wanted.parameters.resize(1);
  wanted.parameters[0].key = "range";
  wanted.parameters[0].value = "0.2";
  expectSolved(plan(wanted), wanted.start, wanted.goals);
  wanted.parameters[0].key = "reach";
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "has no parameter 'reach'; it has");
  wanted.parameters[0].key = "range";
  wanted.parameters[0].value = "far";
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "parameter range of planner RRTConnect cannot be 'far'");
  // Values that would keep a planner busy far beyond its time.
  wanted.parameters[0].value = "1e-9";
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "parameter range is 1e-9; it must be 0");
  wanted.planner = "geometric::BITstar";
  wanted.parameters[0].key = "samples_per_batch";
  for (const std::string count : {"1000000", "-1", "inf"})
  {
    wanted.parameters[0].value = count;
    expectStatus(wanted, AnswerStatus::INVALID_REQUEST,
                 "samples_per_batch is " + count + "; it must be from 0 to 1000 (limits/planner_parameter)");
  }
  wanted.parameters[0].value = "50";
  expectSolved(plan(wanted), wanted.start, wanted.goals);
  // With this parameter OMPL's planner would use an object that it has not created.
  wanted.planner = "geometric::RRTstar";
  wanted.parameters[0].key = "ordered_sampling";
  wanted.parameters[0].value = "1";
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "has no parameter 'ordered_sampling'");
}

TEST_F(Planning, ServesTwoClientsAtOnce)
{
  std::vector<std::thread> clients;
  std::vector<std::vector<Response>> answers(2);
  for (std::vector<Response>& mine : answers)
    clients.emplace_back(
        [&mine]
        {
          for (int i = 0; i < 10; ++i)
            mine.push_back(plan(request()));
        });
  for (std::thread& client : clients)
    client.join();
  for (const std::vector<Response>& mine : answers)
    for (const Response& response : mine)
      expectSolved(response, request().start, request().goals);
}

TEST_F(Planning, GoesToAnyOfSeveralGoalsAndLeavesOutThoseInCollision)
{
  PlanMotion::Request wanted = request();
  wanted.goals = {0.0, kTurned, 1.0, 0.0};
  expectSolved(plan(wanted), wanted.start, {1.0, 0.0});
}

TEST_F(Planning, StartsAtTheCurrentStateWhereNoneIsGiven)
{
  PlanningSceneMessage change = diffScene();
  change.robot_state.is_diff = true;
  change.robot_state.joint_state.name = {"slide", "turn"};
  change.robot_state.joint_state.position = {-0.9, kTurned};
  apply(change);
  PlanMotion::Request wanted = request();
  wanted.start_names.clear();
  wanted.start.clear();
  expectSolved(plan(wanted), {-0.9, kTurned}, wanted.goals);
}

TEST_F(Planning, UnderTheBoundDoesNotJumpAWallOfAMillimetreAndBySamplesDoes)
{
  apply(diffWith(plate("sheet", {0.5003, 0.0, 0.0}, {0.001, 2.0, 0.15})));
  PlanMotion::Request wanted = request();
  wanted.start = {0.3, 0.0};
  wanted.goals = {0.9, 0.0};
  wanted.allowed_planning_time = 0.5;
  const Response bound = plan(wanted);
  EXPECT_FALSE(bound.success);
  EXPECT_TRUE(bound.status == Response::APPROXIMATE || bound.status == Response::NO_SOLUTION);
  EXPECT_NE(bound.message.find("no solution within 0.5"), std::string::npos) << bound.message;
  wanted.motion_rule = "samples";
  wanted.translation_resolution = 0.6;
  EXPECT_TRUE(plan(wanted).success);
}

TEST_F(Planning, SaysWhichBodiesCollideAtTheStartAndAtTheGoal)
{
  PlanMotion::Request wanted = request();
  wanted.start = {0.0, kTurned};
  expectStatus(wanted, Response::START_IN_COLLISION, "the start is in collision: pole and ");
  wanted = request();
  wanted.goals = {0.0, kTurned};
  expectStatus(wanted, Response::GOAL_IN_COLLISION, "the goal is in collision: pole and ");
}

TEST_F(Planning, SaysWhatIsOutOfBounds)
{
  PlanMotion::Request wanted = request();
  wanted.start = {-2.5, 0.0};
  expectStatus(wanted, Response::OUT_OF_BOUNDS, "the start is out of bounds: joint 'slide' is -2.5");
  wanted = request();
  wanted.goals = {1.0, 3.5};
  expectStatus(wanted, Response::OUT_OF_BOUNDS, "the goal is out of bounds: joint 'turn' is 3.5");
}

TEST_F(Planning, DistinguishesAnApproximateSolutionFromASolution)
{
  apply(diffWith(plate("wall", {0.6, 0.0, 0.0}, {0.1, 2.0, 0.15})));
  PlanMotion::Request wanted = request();
  wanted.allowed_planning_time = 1.0;
  wanted.planner = "gpu_planning_scene/BatchRrtConnect";
  const Response response = plan(wanted);
  EXPECT_FALSE(response.success);
  EXPECT_EQ(response.status, Response::APPROXIMATE) << response.message;
  ASSERT_FALSE(response.trajectory.points.empty());
  EXPECT_EQ(response.trajectory.points.front().positions, wanted.start);
  EXPECT_GT(response.trajectory.points.back().positions[0], -0.9);
  EXPECT_LT(response.trajectory.points.back().positions[0], 0.5);
  EXPECT_NE(response.message.find("the path ends"), std::string::npos) << response.message;
}

TEST_F(Planning, StartAndGoalMayBeStatesOfTheSrdf)
{
  PlanMotion::Request wanted = request();
  wanted.start_names = wanted.goal_names = {};
  wanted.start = wanted.goals = {};
  wanted.named_start = "left";
  wanted.named_goal = "drive/right";
  expectSolved(plan(wanted), {-1.0, 0.8}, {1.0, 0.8});
  wanted.named_goal = "home";
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST,
               "the SRDF has no state 'home'; its states: drive/left, drive/right");
  wanted.named_goal = "right";
  wanted.start_names = {"slide"};
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST,
               "named_start is 'left', but start_names is not empty; give one of the two");
  // A state of both joints counts for the group's joint.
  wanted.named_start.clear();
  wanted.start_names = {"slide", "turn"};
  wanted.start = {-1.0, 0.0};
  wanted.group = "mast";
  EXPECT_TRUE(plan(wanted).success);
}

TEST_F(Planning, AStateOfTheSrdfCanBeChecked)
{
  CheckStates::Request wanted;
  wanted.named_state = "left";
  EXPECT_EQ(std::vector<std::uint8_t>{1}, call<CheckStates>("check_states", wanted).valid);
  apply(diffWith(plate("wall", {-1.0, 0.0, 0.0}, {0.1, 2.0, 0.15})));
  EXPECT_EQ(std::vector<std::uint8_t>{0}, call<CheckStates>("check_states", wanted).valid);
  wanted.joint_names = {"slide"};
  wanted.positions = {0.0};
  EXPECT_NE(std::string::npos, call<CheckStates>("check_states", wanted).message.find("give one of the two"));
}

TEST_F(Planning, RefusesInvalidRequests)
{
  PlanMotion::Request wanted = request();
  wanted.group = "crane";
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "crane");
  wanted = request();
  wanted.planner = "geometric::Best";
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST,
               "planner 'geometric::Best' is neither in the planner_configs of ~planners nor a plugin");
  wanted = request();
  wanted.group = "mast";
  wanted.goal_names = {"turn"};
  wanted.goals = {0.0};
  wanted.planner = "RRTConnectkConfigDefault";
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "is not among the planner_configs of group 'mast'");
  wanted.planner.clear();
  wanted.goal_names = {"slide"};
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "goal_names has slide, which group 'mast' does not plan for");
  wanted = request();
  wanted.goals = {1.0, NAN};
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "turn");
  wanted.goals.clear();
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "goals is empty, but goal_names names slide, turn");
  wanted.goal_names.clear();
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "goal_names is empty");
  wanted.goal_names = request().goal_names;
  wanted.goals = {1, 0, 1, 0, 1, 0, 1, 0};
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "4 goals are more than 3 (limits/goals)");
  wanted = request();
  wanted.start = {-1, 0, -1, 0};
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "start has 2 rows");
  wanted.start.clear();
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "start is empty, but start_names names slide, turn");
  wanted = request();
  wanted.start_names.clear();
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "start_names is empty");
  wanted = request();
  wanted.workspace_parameters.min_corner.x = 1.0;
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST,
               "workspace_parameters: the corners must be finite, and min_corner must");
  wanted.workspace_parameters.max_corner.x = 2.0;
  wanted.workspace_parameters.header.frame_id = "cart";
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST,
               "workspace_parameters are in the frame 'cart'; give them in the planning");
  wanted = request();
  wanted.allowed_planning_time = 9.0;
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "the limit is 8.0");
  wanted.allowed_planning_time = -1.0;
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "the planning time is -1.0");
  wanted = request();
  wanted.motion_rule = "hope";
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "the motion rule is 'hope'");
  wanted = request();
  wanted.resolution = -0.1;
  expectStatus(wanted, AnswerStatus::INVALID_REQUEST, "the revolute step of motions is -0.1");
}

TEST_F(Planning, DrawsThePath)
{
  ros::NodeHandle node;
  visualization_msgs::MarkerArray drawn;
  const ros::Subscriber subscriber = node.subscribe<visualization_msgs::MarkerArray>(
      name("plan_markers"), 10, [&drawn](const visualization_msgs::MarkerArrayConstPtr& message) { drawn = *message; });
  const auto of = [&drawn](const std::string& name)
  {
    std::vector<visualization_msgs::Marker> markers;
    for (const visualization_msgs::Marker& marker : drawn.markers)
      if (marker.ns == name)
        markers.push_back(marker);
    return markers;
  };
  const auto wait = [&](const auto& condition)
  {
    for (int i = 0; i < 200 && !condition(); ++i)
    {
      ros::spinOnce();
      ros::WallDuration(0.05).sleep();
    }
  };
  wait([&] { return subscriber.getNumPublishers() > 0; });
  const Response response = plan(request());
  // The path of an earlier test may come first, because it waited for a subscriber.
  wait(
      [&]
      {
        return of("ghosts").size() == 8 && of("waypoints").size() == 1 &&
               of("waypoints")[0].points.size() == 2 * response.trajectory.points.size();
      });
  ASSERT_FALSE(drawn.markers.empty());
  EXPECT_EQ(drawn.markers[0].action, visualization_msgs::Marker::DELETEALL);
  EXPECT_EQ(of("ghosts").size(), 8u) << "cart and pole, four times";
  ASSERT_EQ(of("path").size(), 2u) << "pennant and nut";
  EXPECT_NEAR(of("path")[0].points.front().x, -1.0, 1e-9);
  EXPECT_NEAR(of("path")[0].points.back().x, 1.0, 1e-9);
  ASSERT_EQ(of("waypoints").size(), 1u);
  EXPECT_EQ(of("waypoints")[0].points.size(), 2 * response.trajectory.points.size());
}

TEST_F(Planning, ShowsTheGoalPoseAndTheMotion)
{
  ros::NodeHandle node;
  visualization_msgs::Marker goal;
  std::vector<double> positions;  // of the cart
  const ros::Subscriber plans = node.subscribe<visualization_msgs::MarkerArray>(
      name("plan_markers"), 10,
      [&goal](const visualization_msgs::MarkerArrayConstPtr& message)
      {
        for (const visualization_msgs::Marker& marker : message->markers)
          if (marker.ns == "goals")
            goal = marker;
      });
  const ros::Subscriber animation = node.subscribe<visualization_msgs::MarkerArray>(
      name("plan_animation"), 10,
      [&positions](const visualization_msgs::MarkerArrayConstPtr& message)
      {
        if (message->markers.at(0).action == visualization_msgs::Marker::ADD)
          positions.push_back(message->markers[0].pose.position.x);
      });
  const auto wait = [](const auto& condition)
  {
    for (int i = 0; i < 200 && !condition(); ++i)
    {
      ros::spinOnce();
      ros::WallDuration(0.05).sleep();
    }
  };
  wait([&] { return plans.getNumPublishers() > 0 && animation.getNumPublishers() > 0; });
  PlanMotion::Request wanted = request();
  wanted.goal_names.clear();
  wanted.goals.clear();
  wanted.goal_link = "cart";
  wanted.goal_poses.resize(1);
  wanted.goal_poses[0].pose.position.x = 0.9;
  wanted.goal_poses[0].pose.orientation.w = 1.0;
  const Response response = plan(wanted);
  ASSERT_TRUE(response.success) << response.message;
  positions.clear();
  const auto is_at = [&](double x)
  {
    return std::any_of(
        positions.begin(), positions.end(), [x](double position) { return std::abs(position - x) < 0.01; });
  };
  wait([&] { return goal.ns == "goals" && is_at(-1.0) && is_at(0.9); });
  EXPECT_NEAR(goal.pose.position.x, 0.9, 1e-9);
  EXPECT_GT(goal.color.g, 2.0F * goal.color.r) << "green: the path ends there";
  EXPECT_TRUE(is_at(0.9)) << "the end of the path";
  EXPECT_TRUE(std::any_of(positions.begin(), positions.end(), [](double x) { return x > -0.9 && x < 0.8; }))
      << "between the start and the goal";
}
}  // namespace
}  // namespace gpu_planning_scene::core
