#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <geometric_shapes/mesh_operations.h>
#include <moveit/kinematic_constraints/kinematic_constraint.h>
#include <moveit/robot_state/conversions.h>
#include <octomap/OcTree.h>
#include <srdfdom/model.h>
#include <urdf_parser/urdf_parser.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/moveit/collision_detector_allocator.h"
#include "moveit/moveit_resources.h"
#include "moveit/panda_planner.h"
#include "moveit/planner/scene_conversion.h"
#include "moveit/planner_fixtures.h"

// The planner for MoveIt, loaded as MoveIt loads it. Paths are checked with MoveIt's FCL detector.
namespace gpu_planning_scene::pipeline
{
namespace
{
using collision_detection::CollisionRequest;
using collision_detection::CollisionResult;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using moveit::core::RobotState;
using moveit_msgs::MoveItErrorCodes;
using planning_interface::MotionPlanRequest;
using planning_interface::MotionPlanResponse;

TEST_F(Planner, FindsAPathAroundObjectsThatIsFreeForFcl)
{
  addPost();
  addObject("ball", std::make_shared<shapes::Sphere>(0.1), at(0.3, 0.5, 0.7));
  addObject("table", box(0.4, 2.0, 0.02), at(0.7, 0.0, 0.1));
  const MotionPlanRequest asked = request(goal_);
  MotionPlanResponse response;
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(asked, response));
  EXPECT_EQ(0, collidingStates(*response.trajectory_));
  EXPECT_LT(2u, response.trajectory_->getWayPointCount());
  EXPECT_EQ(0.0, response.trajectory_->getFirstWayPoint().distance(start_));
  EXPECT_TRUE(fulfils(response.trajectory_->getLastWayPoint(), asked.goal_constraints[0]));
  EXPECT_EQ("gpu_planning_scene/BatchRrtConnect", response.planner_id_);
}

TEST_F(Planner, WaypointsAreNotFartherApartThanTheDistance)
{
  MotionPlanResponse response;
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(request(goal_), response));
  for (std::size_t i = 1; i < response.trajectory_->getWayPointCount(); ++i)
    EXPECT_LE(std::abs(response.trajectory_->getWayPoint(i).getVariablePosition("panda_joint1") -
                       response.trajectory_->getWayPoint(i - 1).getVariablePosition("panda_joint1")),
              0.1 + 1e-9);
}

TEST_F(Planner, CarriesAttachedObjectsAroundObstacles)
{
  addPost();
  attachBox(kHandLinks, {0.05, 0.05, 0.3}, at(0.0, 0.0, 0.25));
  MotionPlanResponse response;
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(request(goal_), response));
  EXPECT_TRUE(response.trajectory_->getFirstWayPoint().hasAttachedBody("tool"));
  EXPECT_EQ(0, collidingStates(*response.trajectory_));
}

TEST_F(Planner, TakesAttachedObjectsOfTheStartState)
{
  addObject("shelf", box(0.05, 0.05, 0.05), goal_.getGlobalLinkTransform("panda_hand") * at(0.0, 0.0, 0.35));
  EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), plan(request(goal_)));
  MotionPlanRequest carrying = request(goal_);
  RobotState with_tool = start_;
  with_tool.attachBody("tool", at(0.0, 0.0, 0.25), {box(0.05, 0.05, 0.3)}, {Isometry3d::Identity()}, kHandLinks,
                       "panda_hand");
  with_tool.update();
  moveit::core::robotStateToRobotStateMsg(with_tool, carrying.start_state);
  EXPECT_EQ(int(MoveItErrorCodes::GOAL_IN_COLLISION), plan(carrying));
  scene_->getWorldNonConst()->clearObjects();
  MotionPlanResponse response;
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(carrying, response));
  EXPECT_TRUE(response.trajectory_->getLastWayPoint().hasAttachedBody("tool"));
  ASSERT_EQ(1U, response.start_state_.attached_collision_objects.size());
  EXPECT_EQ("tool", response.start_state_.attached_collision_objects[0].object.id);
}

TEST_F(Planner, ChecksAnAttachedObjectAgainstItsOwnLinkAsMoveItDoes)
{
  attachBox({}, {0.04, 0.04, 0.04}, at(0.0, 0.11, 0.03));
  ASSERT_TRUE(collides(scene_->getCurrentState()));
  EXPECT_EQ(int(MoveItErrorCodes::START_STATE_IN_COLLISION), plan(request(goal_)));
  scene_->getAllowedCollisionMatrixNonConst().setEntry("tool", "panda_hand", true);
  EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), plan(request(goal_)));
}

TEST_F(Planner, AvoidsTheOccupiedCellsOfAnOctomap)
{
  const auto octree = std::make_shared<octomap::OcTree>(0.05);
  for (int z = 0; z < 32; ++z)
    for (int y = -2; y < 2; ++y)
      octree->updateNode(
          octomap::point3d(0.525F, 0.025F + 0.05F * static_cast<float>(y), 0.025F + 0.05F * static_cast<float>(z)),
          true);
  scene_->processOctomapPtr(octree, Isometry3d::Identity());
  MotionPlanResponse response;
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(request(goal_), response));
  EXPECT_EQ(0, collidingStates(*response.trajectory_));
  const Vector3d hand = goal_.getGlobalLinkTransform("panda_hand").translation();
  octree->updateNode(
      octomap::point3d(static_cast<float>(hand.x()), static_cast<float>(hand.y()), static_cast<float>(hand.z())), true);
  EXPECT_EQ(int(MoveItErrorCodes::GOAL_IN_COLLISION), plan(request(goal_)));
}

TEST_F(Planner, ReportsStartsAndGoalsThatCollide)
{
  addBoxInGoal();
  EXPECT_EQ(int(MoveItErrorCodes::GOAL_IN_COLLISION), plan(request(goal_)));
  scene_->setCurrentState(goal_);
  EXPECT_EQ(int(MoveItErrorCodes::START_STATE_IN_COLLISION), plan(request(start_)));
}

TEST_F(Planner, FollowsTheAllowedCollisionMatrix)
{
  addBoxInGoal();
  collision_detection::AllowedCollisionMatrix& matrix = scene_->getAllowedCollisionMatrixNonConst();
  matrix.setDefaultEntry("box", true);
  EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), plan(request(goal_)));
  matrix.setEntry("box", "panda_hand", false);
  EXPECT_EQ(int(MoveItErrorCodes::GOAL_IN_COLLISION), plan(request(goal_)));
  matrix.setEntry("box", "panda_hand", true);
  EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), plan(request(goal_)));
  // A decider may forbid a contact, so it allows none here.
  collision_detection::DecideContactFn always = [](collision_detection::Contact&) { return true; };
  matrix.setEntry("box", "panda_hand", always);
  EXPECT_EQ(int(MoveItErrorCodes::GOAL_IN_COLLISION), plan(request(goal_)));
}

TEST_F(Planner, TellsAnObjectFromALinkOfTheSameName)
{
  addObject("panda_hand", box(0.1, 0.1, 0.1), goal_.getGlobalLinkTransform("panda_hand"));
  ASSERT_TRUE(collides(goal_));
  EXPECT_EQ(int(MoveItErrorCodes::GOAL_IN_COLLISION), plan(request(goal_)));
  scene_->getAllowedCollisionMatrixNonConst().setEntry("panda_hand", "panda_hand", true);
  scene_->getWorldNonConst()->setObjectPose("panda_hand", at(2.0, 0.0, 0.0));
  EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), plan(request(goal_)));
}

TEST_F(Planner, KeepsThePaddingOfTheScene)
{
  addObject("box", box(0.02, 0.02, 0.02), goal_.getGlobalLinkTransform("panda_hand") * at(0.0, 0.0, 0.16));
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(request(goal_)));
  scene_->getCollisionEnvNonConst()->setPadding(0.06);
  scene_->propogateRobotPadding();
  ASSERT_TRUE(collides(goal_));
  EXPECT_EQ(int(MoveItErrorCodes::GOAL_IN_COLLISION), plan(request(goal_)));
}

TEST_F(Planner, ScalesLinksForTheCheckWithTheWorldOnly)
{
  addObject("box", box(0.02, 0.02, 0.02), goal_.getGlobalLinkTransform("panda_hand") * at(0.0, 0.0, 0.14));
  ASSERT_FALSE(collides(goal_));
  scene_->getCollisionEnvNonConst()->setScale(2.5);
  ASSERT_FALSE(collides(start_));  // the scaled links overlap
  ASSERT_TRUE(collides(goal_));
  EXPECT_EQ(int(MoveItErrorCodes::GOAL_IN_COLLISION), plan(request(goal_)));
  scene_->getWorldNonConst()->clearObjects();
  EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), plan(request(goal_)));
}

TEST_F(Planner, RefusesGroupsConstraintsAndGoalsThatItDoesNotPlanFor)
{
  const auto refused = [this](const MotionPlanRequest& asked)
  {
    EXPECT_FALSE(manager().canServiceRequest(asked));
    return plan(asked);
  };
  EXPECT_TRUE(manager().canServiceRequest(request(goal_)));
  MotionPlanRequest asked = request(goal_);
  asked.group_name = "no_such_group";
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_GROUP_NAME), refused(asked));
  asked = request(goal_);
  asked.path_constraints.visibility_constraints.resize(1);
  EXPECT_EQ(int(MoveItErrorCodes::PLANNING_FAILED), refused(asked));
  asked = request(goal_);
  asked.trajectory_constraints.constraints.resize(1);
  EXPECT_EQ(int(MoveItErrorCodes::PLANNING_FAILED), refused(asked));
  asked = request(goal_);
  asked.goal_constraints.clear();
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS), refused(asked));
  moveit_msgs::VisibilityConstraint visibility;
  asked.goal_constraints.resize(1);
  asked.goal_constraints[0].visibility_constraints.push_back(visibility);
  EXPECT_EQ(int(MoveItErrorCodes::UNRECOGNIZED_GOAL_TYPE), refused(asked));
}

TEST_F(Planner, RefusesGoalConstraintsThatCannotBeFulfilled)
{
  const auto with = [this](const std::function<void(moveit_msgs::JointConstraint&)>& change)
  {
    MotionPlanRequest asked = request(goal_);
    change(asked.goal_constraints[0].joint_constraints[0]);
    return plan(asked);
  };
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS), with([](auto& joint) { joint.joint_name = "elbow"; }));
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS), with([](auto& joint) { joint.position = NAN; }));
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS), with([](auto& joint) { joint.tolerance_below = -1.0; }));
  EXPECT_EQ(int(MoveItErrorCodes::GOAL_STATE_INVALID), with([](auto& joint) { joint.position = 5.0; }));
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS), with(
                                                                 [](auto& joint)
                                                                 {
                                                                   joint.joint_name = "panda_finger_joint1";
                                                                   joint.position = 0.03;
                                                                 }));
}

TEST_F(Planner, SearchesAFreeStateWithinTheTolerances)
{
  addBoxInGoal();
  const MotionPlanRequest asked = request(goal_, 0.3);
  MotionPlanResponse response;
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(asked, response));
  EXPECT_EQ(0, collidingStates(*response.trajectory_));
  EXPECT_TRUE(fulfils(response.trajectory_->getLastWayPoint(), asked.goal_constraints[0]));
}

TEST_F(Planner, ReachesOneOfSeveralGoals)
{
  addBoxInGoal();
  MotionPlanRequest asked = request(goal_);
  RobotState other = goal_;
  other.setVariablePosition("panda_joint1", 0.2);
  other.update();
  asked.goal_constraints.push_back(request(other).goal_constraints[0]);
  MotionPlanResponse response;
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(asked, response));
  EXPECT_TRUE(fulfils(response.trajectory_->getLastWayPoint(), asked.goal_constraints[1]));
}

TEST_F(Planner, LeavesJointsWithoutAConstraintToTheSearch)
{
  MotionPlanRequest asked = request(goal_);
  asked.goal_constraints[0].joint_constraints.resize(2);
  MotionPlanResponse response;
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(asked, response));
  EXPECT_TRUE(fulfils(response.trajectory_->getLastWayPoint(), asked.goal_constraints[0]));
}

TEST_F(Planner, RefusesStartStatesThatItCannotUse)
{
  MotionPlanRequest asked = request(goal_);
  asked.start_state.joint_state.name = {"elbow"};
  asked.start_state.joint_state.position = {0.0};
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_ROBOT_STATE), plan(asked));
  asked.start_state.joint_state.name = {"panda_joint1"};
  asked.start_state.joint_state.position = {5.0};
  EXPECT_EQ(int(MoveItErrorCodes::START_STATE_INVALID), plan(asked));
  asked.start_state.joint_state.position = {-1.0};
  EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), plan(asked));
  moveit_msgs::AttachedCollisionObject tool;
  tool.link_name = "panda_hand";
  tool.object.header.frame_id = "nowhere";
  tool.object.id = "tool";
  tool.object.primitives.resize(1);
  tool.object.primitives[0].type = shape_msgs::SolidPrimitive::SPHERE;
  tool.object.primitives[0].dimensions = {0.1};
  tool.object.primitive_poses.resize(1);
  tool.object.primitive_poses[0].orientation.w = 1.0;
  asked.start_state.attached_collision_objects.push_back(tool);
  EXPECT_EQ(int(MoveItErrorCodes::FRAME_TRANSFORM_FAILURE), plan(asked));
}

/// A sphere in front of the hand, as a part of a start state.
moveit_msgs::AttachedCollisionObject ball(double radius)
{
  moveit_msgs::AttachedCollisionObject ball;
  ball.link_name = "panda_hand";
  ball.touch_links = {kHandLinks.begin(), kHandLinks.end()};
  ball.object.header.frame_id = "panda_hand";
  ball.object.id = "ball";
  ball.object.pose.position.z = 0.2;
  ball.object.pose.orientation.w = 1.0;
  ball.object.primitives.resize(1);
  ball.object.primitives[0].type = shape_msgs::SolidPrimitive::SPHERE;
  ball.object.primitives[0].dimensions = {radius};
  ball.object.primitive_poses.resize(1);
  ball.object.primitive_poses[0].orientation.w = 1.0;
  return ball;
}

TEST_F(Planner, RefusesStartStatesWithValuesThatAreNoNumbers)
{
  for (const double value : {double(NAN), double(INFINITY)})
  {
    MotionPlanRequest asked = request(goal_);
    asked.start_state.joint_state.name = {"panda_joint1"};
    asked.start_state.joint_state.position = {value};
    EXPECT_EQ(int(MoveItErrorCodes::INVALID_ROBOT_STATE), plan(asked));
    asked = request(goal_);
    asked.start_state.attached_collision_objects = {ball(0.02)};
    EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), plan(asked));
    asked.start_state.attached_collision_objects[0].object.pose.position.x = value;
    EXPECT_EQ(int(MoveItErrorCodes::INVALID_ROBOT_STATE), plan(asked));
  }
  scene_->getCurrentStateNonConst().setVariablePosition("panda_joint1", NAN);
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_ROBOT_STATE), plan(request(goal_)));
}

TEST_F(Planner, AnAttachedObjectThatIsNotValidIsNotReplacedByTheOldOne)
{
  MotionPlanRequest asked = request(goal_);
  asked.start_state.attached_collision_objects = {ball(0.02)};
  RobotState carrying = start_;
  ASSERT_TRUE(moveit::core::robotStateMsgToRobotState(scene_->getTransforms(), asked.start_state, carrying));
  scene_->setCurrentState(carrying);
  EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), plan(request(goal_)));
  // MoveIt logs that the new ball has no pose for its shape, and keeps the old ball, which has one shape too.
  asked.start_state.attached_collision_objects[0].object.primitive_poses.clear();
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_ROBOT_STATE), plan(asked));
  asked.start_state.attached_collision_objects = {ball(-1.0)};
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_ROBOT_STATE), plan(asked));
}

TEST_F(Planner, AnInfiniteToleranceAllowsEveryValueOnItsSide)
{
  MotionPlanRequest asked = request(goal_);
  moveit_msgs::JointConstraint& first = asked.goal_constraints[0].joint_constraints[0];
  first.position = 5.0;  // outside the limits of the joint
  first.tolerance_below = first.tolerance_above = INFINITY;
  MotionPlanResponse response;
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(asked, response));
  EXPECT_TRUE(fulfils(response.trajectory_->getLastWayPoint(), asked.goal_constraints[0]));
  first.tolerance_below = 0.0;
  EXPECT_EQ(int(MoveItErrorCodes::GOAL_STATE_INVALID), plan(asked));

  // A joint that the group does not move is at 0 in the start.
  first.joint_name = "panda_finger_joint1";
  first.position = 0.03;
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS), plan(asked));
  first.tolerance_below = INFINITY;
  EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), plan(asked));
  first.tolerance_above = 0.0;
  EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), plan(asked));
  first.position = -0.01;
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS), plan(asked));
}

TEST_F(Planner, AContextOutlivesItsManager)
{
  for (const char* planner : {"", "geometric::RRTConnect"})
  {
    MotionPlanRequest asked = request(goal_);
    asked.planner_id = planner;
    planning_interface::PlannerManagerPtr manager = loadManager(robot());
    moveit_msgs::MoveItErrorCodes code;
    planning_interface::PlanningContextPtr context = manager->getPlanningContext(scene_, asked, code);
    ASSERT_TRUE(context);
    manager.reset();
    MotionPlanResponse response;
    EXPECT_TRUE(context->solve(response));
    EXPECT_EQ(0, collidingStates(*response.trajectory_));
    context.reset();
  }
}

TEST_F(Planner, ChecksFlatBoxes)
{
  addObject("flat", box(0.0, 0.3, 0.3), goal_.getGlobalLinkTransform("panda_hand"));
  EXPECT_EQ(int(MoveItErrorCodes::GOAL_IN_COLLISION), plan(request(goal_)));
}

TEST_F(Planner, RefusesScenesThatItCannotCheckExactly)
{
  scene_->setStateFeasibilityPredicate([](const RobotState&, bool) { return true; });
  EXPECT_EQ(int(MoveItErrorCodes::COLLISION_CHECKING_UNAVAILABLE), plan(request(goal_)));
  scene_->setStateFeasibilityPredicate({});
  scene_->setMotionFeasibilityPredicate([](const RobotState&, const RobotState&, bool) { return true; });
  EXPECT_EQ(int(MoveItErrorCodes::COLLISION_CHECKING_UNAVAILABLE), plan(request(goal_)));
  scene_->setMotionFeasibilityPredicate({});
  scene_->getCurrentStateNonConst().attachBody("plane", Isometry3d::Identity(),
                                               {std::make_shared<shapes::Plane>(0.0, 0.0, 1.0, 0.0)},
                                               {Isometry3d::Identity()}, kHandLinks, "panda_hand");
  EXPECT_EQ(int(MoveItErrorCodes::COLLISION_CHECKING_UNAVAILABLE), plan(request(goal_)));
}

TEST_F(Planner, PlansWithTheNamedPlanner)
{
  MotionPlanRequest asked = request(goal_);
  asked.planner_id = "geometric::RRTConnect";
  MotionPlanResponse response;
  EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), plan(asked, response));
  EXPECT_EQ(asked.planner_id, response.planner_id_);
  asked.planner_id = "geometric::NoSuchPlanner";
  EXPECT_EQ(int(MoveItErrorCodes::PLANNING_FAILED), plan(asked));

  const planning_interface::PlannerConfigurationMap before = manager().getPlannerConfigurations();
  EXPECT_EQ(1u, before.count(kArm));
  planning_interface::PlannerConfigurationMap changed = before;
  changed["panda_arm[Lazy]"] = {kArm, "panda_arm[Lazy]", {{"type", "geometric::SBL"}, {"range", "0.5"}}};
  manager().setPlannerConfigurations(changed);
  for (const char* id : {"Lazy", "panda_arm[Lazy]"})
  {
    asked.planner_id = id;
    EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), plan(asked, response));
    EXPECT_EQ("geometric::SBL", response.planner_id_);
  }
  changed["panda_arm[Wrong]"] = {kArm, "panda_arm[Wrong]", {{"type", "geometric::SBL"}, {"no_such_parameter", "1"}}};
  changed["hand[Other]"] = {"hand", "hand[Other]", {{"type", "geometric::SBL"}}};
  manager().setPlannerConfigurations(changed);
  for (const char* id : {"Wrong", "hand[Other]"})
  {
    asked.planner_id = id;
    EXPECT_EQ(int(MoveItErrorCodes::PLANNING_FAILED), plan(asked)) << id;
  }
  std::vector<std::string> names;
  manager().getPlanningAlgorithms(names);
  EXPECT_EQ(1, std::count(names.begin(), names.end(), "panda_arm[Lazy]"));
  manager().setPlannerConfigurations(before);
}

TEST_F(Planner, ReturnsTheShortestOfSeveralAttempts)
{
  addPost();
  MotionPlanRequest asked = request(goal_);
  asked.num_planning_attempts = 4;
  planning_interface::MotionPlanDetailedResponse response;
  moveit_msgs::MoveItErrorCodes code;
  const planning_interface::PlanningContextPtr context = manager().getPlanningContext(scene_, asked, code);
  ASSERT_TRUE(context->solve(response));
  ASSERT_EQ(1u, response.trajectory_.size());
  EXPECT_EQ(response.trajectory_.size(), response.description_.size());
  EXPECT_EQ(response.trajectory_.size(), response.processing_time_.size());
  EXPECT_EQ(0, collidingStates(*response.trajectory_[0]));
}

TEST_F(Planner, KeepsTheMeasuredValueOfAMimicJoint)
{
  start_.setVariablePosition("panda_finger_joint1", 0.02);
  std::vector<double> values(start_.getVariablePositions(), start_.getVariablePositions() + start_.getVariableCount());
  const int follower = robot()->getVariableIndex("panda_finger_joint2");
  values[follower] = 0.0213;  // a measured value, which setVariablePosition would overwrite
  start_.setVariablePositions(values);
  start_.update();
  scene_->setCurrentState(start_);
  scene_->getCurrentStateNonConst().setVariablePositions(values);
  scene_->getCurrentStateNonConst().update();
  MotionPlanResponse response;
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(request(goal_), response));
  EXPECT_EQ(0.0213, response.trajectory_->getLastWayPoint().getVariablePosition(follower));

  MotionPlanRequest hand;
  hand.group_name = "hand";
  hand.allowed_planning_time = 5.0;
  hand.goal_constraints.resize(1);
  hand.goal_constraints[0].joint_constraints.resize(1);
  hand.goal_constraints[0].joint_constraints[0].joint_name = "panda_finger_joint1";
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_ROBOT_STATE), plan(hand));
  values[follower] = 0.02;
  scene_->getCurrentStateNonConst().setVariablePositions(values);
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(hand, response));
  EXPECT_EQ(0.0, response.trajectory_->getLastWayPoint().getVariablePosition(follower));
}

/// Fills a scene with shapes of all kinds, an octomap, padding, attached objects and a random matrix.
void fillScene(planning_scene::PlanningScene& scene, random_numbers::RandomNumberGenerator& random,
               const std::string& carrying_link)
{
  collision_detection::World& world = *scene.getWorldNonConst();
  const auto place = [&random]
  {
    double q[4];
    random.quaternion(q);
    return Isometry3d(Eigen::Translation3d(random.uniformReal(-1.0, 1.0), random.uniformReal(-1.0, 1.0),
                                           random.uniformReal(-0.2, 1.4)) *
                      Eigen::Quaterniond(q[3], q[0], q[1], q[2]));
  };
  for (int i = 0; i < 4; ++i)
  {
    const std::string number = std::to_string(i);
    world.addToObject("box" + number, place(), box(0.1, 0.2, 0.3), place());
    world.addToObject("ball" + number, place(), std::make_shared<shapes::Sphere>(0.1), Isometry3d::Identity());
    world.addToObject("can" + number, place(), std::make_shared<shapes::Cylinder>(0.1, 0.3), Isometry3d::Identity());
    world.addToObject("cone" + number, place(), std::make_shared<shapes::Cone>(0.1, 0.3), Isometry3d::Identity());
    world.addToObject("mesh" + number, place(),
                      shapes::ShapeConstPtr(shapes::createMeshFromShape(shapes::Cylinder(0.1, 0.3))),
                      Isometry3d::Identity());
  }
  world.addToObject("floor", Isometry3d::Identity(), std::make_shared<shapes::Plane>(0.0, 0.0, 1.0, 0.6),
                    Isometry3d::Identity());
  const auto octree = std::make_shared<octomap::OcTree>(0.05);
  for (int i = 0; i < 60; ++i)
  {
    const Vector3d cell = place().translation();
    octree->updateNode(
        octomap::point3d(static_cast<float>(cell.x()), static_cast<float>(cell.y()), static_cast<float>(cell.z())),
        true);
  }
  // Eight cells become one leaf of twice the size.
  for (int i = 0; i < 20; ++i)
  {
    const Vector3d cell = (place().translation() / 0.1).array().floor() * 0.1 + 0.025;
    for (unsigned k = 0; k < 8; ++k)
      octree->updateNode(cell.x() + ((k & 1u) != 0 ? 0.05 : 0.0), cell.y() + ((k & 2u) != 0 ? 0.05 : 0.0),
                         cell.z() + ((k & 4u) != 0 ? 0.05 : 0.0), true);
  }
  octree->prune();
  scene.processOctomapPtr(octree, at(0.1, 0.2, 0.3));
  for (const moveit::core::LinkModel* link : scene.getRobotModel()->getLinkModels())
  {
    scene.getCollisionEnvNonConst()->setLinkPadding(link->getName(), random.uniformReal(0.0, 0.03));
    if (random.uniform01() < 0.3)
      scene.getCollisionEnvNonConst()->setLinkScale(link->getName(), random.uniformReal(0.5, 1.5));
  }
  scene.getCollisionEnvNonConst()->setLinkScale(carrying_link, 1.2);
  RobotState& state = scene.getCurrentStateNonConst();
  state.attachBody("tool", at(0.0, 0.0, 0.2), {box(0.05, 0.05, 0.05)}, {at(0.0, 0.0, 0.01)}, std::set<std::string>(),
                   carrying_link);
  state.attachBody("grip", at(0.0, 0.1, 0.1), {std::make_shared<shapes::Sphere>(0.05)}, {Isometry3d::Identity()},
                   std::set<std::string>{carrying_link}, carrying_link);
  state.update();
  collision_detection::AllowedCollisionMatrix& matrix = scene.getAllowedCollisionMatrixNonConst();
  matrix.setDefaultEntry("ball0", true);
  matrix.setDefaultEntry(carrying_link, true);
  matrix.setDefaultEntry("can1", false);
  matrix.setEntry("ball0", carrying_link, false);
  matrix.setEntry("floor", true);
  matrix.setEntry("tool", "box1", true);
  matrix.setEntry(planning_scene::PlanningScene::OCTOMAP_NS, "grip", true);
}

/// Allows the pairs that collide in a few random states, because the matrix of MoveIt's pr2 allows few pairs of links.
void allowCollidingPairs(planning_scene::PlanningScene& scene, random_numbers::RandomNumberGenerator& random)
{
  RobotState state = scene.getCurrentState();
  for (int i = 0; i < 5; ++i)
  {
    CollisionRequest request;
    request.contacts = true;
    request.max_contacts = 1000000;
    CollisionResult result;
    scene.checkCollision(request, result, state);
    for (const auto& [pair, contacts] : result.contacts)
      scene.getAllowedCollisionMatrixNonConst().setEntry(pair.first, pair.second, true);
    state.setToRandomPositions(random);
    state.update();
  }
}

/// The converted scene has the answers of the detector, which takes MoveIt's scene as it is.
void expectEqualAnswers(const moveit::core::RobotModelPtr& robot, const std::string& group_name,
                        const std::string& carrying_link, int states)
{
  random_numbers::RandomNumberGenerator random(7);
  planning_scene::PlanningScene scene(robot);
  scene.getCurrentStateNonConst().setToDefaultValues();
  fillScene(scene, random, carrying_link);
  scene.setActiveCollisionDetector(detector::CollisionDetectorAllocator::create(), true);
  if (robot->getName() == "pr2")
    allowCollidingPairs(scene, random);
  const moveit::core::JointModelGroup& group = *robot->getJointModelGroup(group_name);
  SceneConverter converter;
  const ConvertedScene converted = converter.convert(scene, scene.getCurrentState(), group, std::nullopt);
  core::CpuChecker checker(converted.scene);
  RobotState state = scene.getCurrentState();
  int colliding = 0;
  for (int i = 0; i < states; ++i)
  {
    state.setToRandomPositions(&group, random);
    state.update();
    CollisionRequest request;
    request.group_name = group_name;
    CollisionResult result;
    scene.checkCollision(request, result, state);
    const core::BatchResult answer = checker.check(converted.robot->row(state).data(), 1, group_name);
    EXPECT_EQ(result.collision, answer.valid[0] == 0) << "state " << i;
    colliding += result.collision ? 1 : 0;
  }
  EXPECT_LT(states / 100, colliding);
  EXPECT_LT(colliding, states - states / 100);
}

TEST(ConvertedScene, FollowersKeepTheirMultiplierAndOffset)
{
  const auto joint = [](const std::string& name, const std::string& child, const std::string& rest)
  {
    return "<link name='" + child + "'/><joint name='" + name +
           "' type='prismatic'><parent link='palm'/><child link='" + child +
           "'/><axis xyz='1 0 0'/><limit lower='-1' upper='1' effort='1' velocity='1'/>" + rest + "</joint>";
  };
  const urdf::ModelInterfaceSharedPtr urdf = urdf::parseURDF(
      "<robot name='gripper'><link name='palm'/>" + joint("left", "left_finger", "") +
      joint("right", "right_finger", "<mimic joint='left' multiplier='-0.5' offset='0.1'/>") + "</robot>");
  const auto srdf = std::make_shared<srdf::Model>();
  ASSERT_TRUE(urdf && srdf->initString(*urdf,
                                       "<robot name='gripper'><group name='hand'><joint name='left'/>"
                                       "<joint name='right'/></group></robot>"));
  const auto model = std::make_shared<moveit::core::RobotModel>(urdf, srdf);
  planning_scene::PlanningScene scene(model);
  RobotState& state = scene.getCurrentStateNonConst();
  state.setToDefaultValues();
  state.update();
  SceneConverter converter;
  const RobotConversion& robot =
      *converter.convert(scene, state, *model->getJointModelGroup("hand"), std::nullopt).robot;
  for (const double value : {-0.3, 0.0, 0.2})
  {
    state.setVariablePosition("left", value);
    state.update();
    const std::vector<double> row = robot.row(state);
    std::vector<Isometry3d> poses(robot.robot()->links().size());
    robot.robot()->linkPoses(row.data(), poses.data());
    for (const moveit::core::LinkModel* link : model->getLinkModels())
      EXPECT_TRUE(poses[static_cast<std::size_t>(RobotConversion::link(*link))].isApprox(
          state.getGlobalLinkTransform(link), 1e-12))
          << link->getName() << " at " << value;
    RobotState back(model);
    robot.setVariables(row.data(), back);
    EXPECT_EQ(0.0, back.distance(state));
  }
}

TEST(ConvertedScene, HasTheAnswersOfTheDetectorForPanda)
{
  expectEqualAnswers(moveit::core::loadTestingRobotModel("panda"), "panda_arm_hand", "panda_hand", 3000);
}

TEST(ConvertedScene, HasTheAnswersOfTheDetectorForPr2)
{
  expectEqualAnswers(moveit::core::loadTestingRobotModel("pr2"), "right_arm", "r_wrist_roll_link", 1000);
}
}  // namespace
}  // namespace gpu_planning_scene::pipeline
