#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <geometric_shapes/mesh_operations.h>
#include <geometric_shapes/shapes.h>
#include <gtest/gtest.h>
#include <moveit/collision_detection_fcl/collision_detector_allocator_fcl.h>
#include <moveit/robot_model/planar_joint_model.h>
#include <moveit/utils/robot_model_test_utils.h>

#include "gpu_planning_scene/moveit/collision_detector_allocator.h"
#include "moveit/follower_robot.h"
#include "moveit/moveit_resources.h"
#include "moveit/shapes.h"

// Motions of joints for which MoveIt's interpolation has special cases: followers (mimic joints), joints without
// limits, and bases. Dense samples are checked with MoveIt's FCL detector.
namespace gpu_planning_scene::detector
{
namespace
{
using collision_detection::CollisionEnv;
using collision_detection::CollisionEnvPtr;
using collision_detection::CollisionRequest;
using collision_detection::CollisionResult;
using Eigen::Isometry3d;
using moveit::core::RobotModelPtr;
using moveit::core::RobotState;

/// Whether one of many states of a motion collides, by MoveIt's FCL detector.
bool hasCollidingSample(const CollisionEnv& fcl, const RobotState& from, const RobotState& to, int samples)
{
  RobotState between(from);
  for (int i = 0; i <= samples; ++i)
  {
    from.interpolate(to, i / static_cast<double>(samples), between);
    between.update();
    CollisionResult sample;
    fcl.checkRobotCollision(CollisionRequest(), sample, between);
    if (sample.collision)
      return true;
  }
  return false;
}

bool motionCollides(const CollisionEnv& env, const RobotState& from, const RobotState& to)
{
  CollisionResult result;
  env.checkRobotCollision(CollisionRequest(), result, from, to);
  return result.collision;
}

/// The same world for MoveIt's FCL detector.
CollisionEnvPtr fclFor(const CollisionEnvPtr& env)
{
  return collision_detection::CollisionDetectorAllocatorFCL().allocateEnv(env->getWorld(), env->getRobotModel());
}

/// MoveIt interpolates only the leader, so a follower has its given value at the ends of a motion alone.
TEST(MotionsOfFollowers, AreCheckedAtTheirEndsWithTheGivenValues)
{
  const std::string limits = "<limit lower='-1' upper='1' effort='1' velocity='1'/>";
  const RobotModelPtr robot = robotFromUrdf(
      "<link name='palm'/>" + jointWithLink("left", "prismatic", "palm", "left_finger", "0 5 0", "1 0 0", limits) +
          jointWithLink("right", "prismatic", "palm", "right_finger", "0 0 0", "1 0 0",
                        limits + "<mimic joint='left'/>"),
      "");
  const auto env = CollisionDetectorAllocator().allocateEnv(robot);
  env->getWorld()->addToObject("box", at(0.7, 0, 0), box(0.1), Isometry3d::Identity());
  RobotState with(robot);
  with.setToDefaultValues();
  with.update();
  RobotState away = with;
  std::vector<double> values(2, 0.0);
  values[static_cast<std::size_t>(robot->getVariableIndex("right"))] = 0.5;
  away.setVariablePositions(values);
  away.update();
  EXPECT_FALSE(motionCollides(*env, with, with));
  EXPECT_TRUE(motionCollides(*env, with, away));
  EXPECT_TRUE(motionCollides(*env, away, with));
}

/// An arm of 1 m that a continuous joint turns.
RobotModelPtr turningRobot()
{
  moveit::core::RobotModelBuilder builder("turner", "base");
  geometry_msgs::Pose pose;
  pose.orientation.w = 1.0;
  builder.addChain("base->arm", "continuous", {pose}, urdf::Vector3(0, 0, 1));
  pose.position.x = 0.5;
  builder.addCollisionBox("arm", {1.0, 0.05, 0.05}, pose);
  builder.addVirtualJoint("world", "base", "fixed", "root");
  builder.addGroupChain("base", "arm", "arm");
  return builder.build();
}

/// Expects that the motion is a collision, and that one of its samples collides.
void expectMotionThroughAnObject(const CollisionEnvPtr& env, RobotState& from, RobotState& to)
{
  from.update();
  to.update();
  EXPECT_TRUE(hasCollidingSample(*fclFor(env), from, to, 2000));
  EXPECT_TRUE(motionCollides(*env, from, to));
}

/// MoveIt does not reduce the values of a continuous joint, so it turns further than the distance of the two angles.
TEST(MotionsOfATurningArm, AreCheckedAlongTheirPathBeyondATurn)
{
  const RobotModelPtr robot = turningRobot();
  const auto env = CollisionDetectorAllocator().allocateEnv(robot);
  for (const double angle : {0.5, 1.2, 2.0, 2.9, 3.7, 4.5, 5.5})
    env->getWorld()->addToObject("post" + std::to_string(angle), at(0.8 * std::cos(angle), 0.8 * std::sin(angle), 0),
                                 box(0.05), Isometry3d::Identity());
  for (const auto& [from, to] :
       {std::pair(0.0, 4.0 * M_PI + 0.1), std::pair(0.0, 3.4 * M_PI), std::pair(0.0, -4.0 * M_PI - 0.1),
        std::pair(4.0 * M_PI + 0.1, 0.0), std::pair(-4.0 * M_PI - 0.1, 0.1)})
  {
    RobotState from_state(robot);
    RobotState to_state(robot);
    from_state.setVariablePosition(0, from);
    to_state.setVariablePosition(0, to);
    expectMotionThroughAnObject(env, from_state, to_state);
  }
}

/// A bar of 1 m that a joint moves in the world.
RobotModelPtr barOnABase(const char* joint)
{
  moveit::core::RobotModelBuilder builder("bar", "bar");
  geometry_msgs::Pose pose;
  pose.orientation.w = 1.0;
  pose.position.x = 0.5;
  builder.addCollisionBox("bar", {1.0, 0.05, 0.05}, pose);
  builder.addVirtualJoint("world", "bar", joint, "root");
  return builder.build();
}

/// MoveIt turns a floating joint the longer way if the product of the two quaternions is negative.
TEST(MotionsOfABase, AreCheckedOnTheLongerWayOfAFloatingJoint)
{
  const RobotModelPtr robot = barOnABase("floating");
  const CollisionEnvPtr env = CollisionDetectorAllocator().allocateEnv(robot);
  env->getWorld()->addToObject("post", at(-0.8, 0, 0), box(0.05), Isometry3d::Identity());
  RobotState from(robot);
  from.setToDefaultValues();
  RobotState to(robot);
  to.setVariablePositions(std::vector<double>{0, 0, 0, 0, 0, -std::sin(0.1), -std::cos(0.1)});
  expectMotionThroughAnObject(env, from, to);
}

/// MoveIt turns a base with the model `diff_drive` towards its goal, drives, and turns it again.
TEST(MotionsOfABase, AreNotProvenByAStraightWayIfTheBaseTurnsBeforeItDrives)
{
  const RobotModelPtr robot = barOnABase("planar");
  auto* base = dynamic_cast<moveit::core::PlanarJointModel*>(robot->getJointModel("root"));
  const CollisionEnvPtr env = CollisionDetectorAllocator().allocateEnv(robot);
  env->getWorld()->addToObject("post", at(0.55, 0.55, 0), box(0.05), Isometry3d::Identity());
  RobotState from(robot);
  from.setToDefaultValues();
  RobotState to = from;
  to.setVariablePosition("root/y", 0.05);
  from.update();
  to.update();
  ASSERT_FALSE(hasCollidingSample(*fclFor(env), from, to, 2000));
  EXPECT_FALSE(motionCollides(*env, from, to)) << "of a base that drives sideways";
  base->setMotionModel(moveit::core::PlanarJointModel::DIFF_DRIVE);
  expectMotionThroughAnObject(env, from, to);
}

/// The objects among which random motions are checked: at most `reach` from the origin.
void addObjects(CollisionEnv& env, int count, double reach, random_numbers::RandomNumberGenerator& random)
{
  for (int i = 0; i < count; ++i)
  {
    shapes::ShapeConstPtr shape = box(0.1);
    if (i % 2 == 1)
      shape.reset(shapes::createMeshFromShape(shapes::Cylinder(0.05, 0.15)));
    env.getWorld()->addToObject(
        "object" + std::to_string(i),
        at(random.uniformReal(-reach, reach), random.uniformReal(-reach, reach), random.uniformReal(-0.6, 1.2)), shape,
        Isometry3d::Identity());
  }
}

struct Motions
{
  int free = 0;
  int colliding = 0;  // by FCL, at a sample
  int open = 0;       // not proven free, and without a colliding sample
};

/// Changes each variable by at most `change`. The rotation of a floating joint becomes a random one, to which MoveIt
/// turns the shorter way.
void moveRandomly(RobotState& state, double change, random_numbers::RandomNumberGenerator& random)
{
  for (const moveit::core::JointModel* joint : state.getRobotModel()->getActiveJointModels())
  {
    const bool is_floating = joint->getType() == moveit::core::JointModel::FLOATING;
    std::vector<double> values(state.getJointPositions(joint),
                               state.getJointPositions(joint) + joint->getVariableCount());
    for (std::size_t i = 0; i < (is_floating ? 3 : values.size()); ++i)
      values[i] += random.uniformReal(-change, change);
    if (is_floating)
    {
      Eigen::Map<Eigen::Vector4d> rotation(values.data() + 3);
      Eigen::Vector4d goal;
      random.quaternion(goal.data());
      rotation = rotation.dot(goal) < 0.0 ? Eigen::Vector4d(-goal) : goal;
    }
    state.setJointPositions(joint, values);
  }
}

/// Checks random motions among random objects with the detector and, at 300 samples each, with FCL's. `change`: see
/// moveRandomly.
Motions expectProofsToHold(const RobotModelPtr& robot, int motions, int objects, double reach, double change,
                           std::uint32_t seed)
{
  constexpr int kMotionsPerWorld = 10;
  SCOPED_TRACE("seed " + std::to_string(seed));
  random_numbers::RandomNumberGenerator random(seed);
  Motions count;
  RobotState from(robot);
  RobotState to(robot);
  CollisionEnvPtr env;
  CollisionEnvPtr fcl;
  for (int i = 0; i < motions; ++i)
  {
    if (i % kMotionsPerWorld == 0)
    {
      env = CollisionDetectorAllocator().allocateEnv(robot);
      addObjects(*env, objects, reach, random);
      fcl = fclFor(env);
    }
    from.setToRandomPositions(random);
    to = from;
    moveRandomly(to, change, random);
    from.update();
    to.update();
    const bool is_free = !motionCollides(*env, from, to);
    const bool is_hit = hasCollidingSample(*fcl, from, to, 300);
    EXPECT_FALSE(is_free && is_hit) << "motion " << i << " is proven free and collides";
    count.free += is_free ? 1 : 0;
    count.colliding += is_hit ? 1 : 0;
    count.open += !is_free && !is_hit ? 1 : 0;
  }
  return count;
}

TEST(RandomMotions, OfPandaThatAreProvenFreeHaveNoStateThatCollidesForFcl)
{
  ASSERT_TRUE(kUsesMoveItResources);
  const Motions count = expectProofsToHold(moveit::core::loadTestingRobotModel("panda"), 150, 8, 0.7, 0.3, 11);
  EXPECT_GT(count.free, 40);
  EXPECT_GT(count.colliding, 20);
  EXPECT_LE(count.open, 5);
}

TEST(RandomMotions, OfFollowersThatAreProvenFreeHaveNoStateThatCollidesForFcl)
{
  const Motions count = expectProofsToHold(followerRobot(), 300, 12, 1.2, 0.6, 12);
  EXPECT_GT(count.free, 40);
  EXPECT_GT(count.colliding, 40);
  EXPECT_LE(count.open, 20) << "those that begin near a whole turn and those near an object";
}

TEST(RandomMotions, OfBasesThatAreProvenFreeHaveNoStateThatCollidesForFcl)
{
  for (const char* base : {"planar", "floating"})
  {
    const RobotModelPtr robot = barOnABase(base);
    SCOPED_TRACE(base);
    const Motions count = expectProofsToHold(robot, 200, 30, 1.2, 1.5, 13);
    EXPECT_GT(count.free, 20);
    EXPECT_GT(count.colliding, 20);
    EXPECT_LE(count.open, 10);
  }
}
}  // namespace
}  // namespace gpu_planning_scene::detector
