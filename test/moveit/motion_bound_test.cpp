#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <moveit/robot_model/planar_joint_model.h>
#include <moveit/utils/robot_model_test_utils.h>

#include "moveit/follower_robot.h"
#include "moveit/pairs/workspace.h"
#include "moveit/queries/motion_bound.h"
#include "moveit/shapes/robot_geometry.h"

// The bound of a motion between two states, against the motion that MoveIt interpolates.
namespace gpu_planning_scene::detector
{
namespace
{
using Eigen::Vector3d;
using moveit::core::JointModel;
using moveit::core::RobotModelPtr;
using moveit::core::RobotState;

/// Random values of all joints. Continuous joints are up to two turns away, bases up to 2 m.
void randomize(RobotState& state, random_numbers::RandomNumberGenerator& random)
{
  state.setToRandomPositions(random);
  for (const JointModel* joint : state.getRobotModel()->getActiveJointModels())
  {
    const std::vector<std::string>& names = joint->getVariableNames();
    const bool is_base = joint->getType() == JointModel::PLANAR || joint->getType() == JointModel::FLOATING;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (is_base && i < (joint->getType() == JointModel::PLANAR ? 2 : 3))
        state.setVariablePosition(names[i], random.uniformReal(-2.0, 2.0));
      else if (!joint->getVariableBounds()[i].position_bounded_ && joint->getType() != JointModel::FLOATING)
        state.setVariablePosition(names[i], random.uniformReal(-4.0 * M_PI, 4.0 * M_PI));
  }
  state.update();
}

/// The corners of the boxes of shape instances, in the world.
std::vector<std::vector<Vector3d>> cornersOf(const std::vector<ShapeInstance>& instances)
{
  std::vector<std::vector<Vector3d>> all;
  for (const ShapeInstance& instance : instances)
  {
    const core::CpuTree& tree = instance.shape->tree();
    std::vector<Vector3d> corners;
    for (unsigned k = 0; k < 8; ++k)
      corners.push_back(*instance.pose * (tree.center + Vector3d((k & 1u) != 0 ? tree.half.x() : -tree.half.x(),
                                                                 (k & 2u) != 0 ? tree.half.y() : -tree.half.y(),
                                                                 (k & 4u) != 0 ? tree.half.z() : -tree.half.z())));
    all.push_back(std::move(corners));
  }
  return all;
}

/// Whether a floating joint has quaternions with a negative product. MoveIt then turns it the longer way.
bool turnsTheLongerWay(const RobotState& from, const RobotState& to)
{
  const auto& joints = from.getRobotModel()->getActiveJointModels();
  return std::any_of(joints.begin(), joints.end(),
                     [&](const JointModel* joint)
                     {
                       if (joint->getType() != JointModel::FLOATING)
                         return false;
                       return Eigen::Map<const Eigen::Vector4d>(from.getJointPositions(joint) + 3)
                                  .dot(Eigen::Map<const Eigen::Vector4d>(to.getJointPositions(joint) + 3)) < 0.0;
                     });
}

/// Sets both ends of a motion.
using SetMotion = void (*)(RobotState& from, RobotState& to, random_numbers::RandomNumberGenerator& random);

void randomizeBoth(RobotState& from, RobotState& to, random_numbers::RandomNumberGenerator& random)
{
  randomize(from, random);
  randomize(to, random);
}

/// Checks random motions. Returns the largest displacement of a point as a part of its bound.
double expectBoundsToHold(const RobotModelPtr& robot, int motions, SetMotion set_motion = randomizeBoth)
{
  constexpr int kSamples = 40;
  const RobotGeometry geometry(*robot, {}, {});
  random_numbers::RandomNumberGenerator random(5);
  RobotState from(robot);
  RobotState to(robot);
  double largest = 0.0;
  for (int motion = 0; motion < motions; ++motion)
  {
    set_motion(from, to, random);
    RobotState state = from;
    std::vector<double> bounds;
    std::vector<std::vector<Vector3d>> before;
    for (int sample = 0; sample <= kSamples; ++sample)
    {
      from.interpolate(to, sample / double(kSamples), state);
      state.update();
      Workspace work;
      geometry.place(state, nullptr, work->instances, work->attached);
      if (sample == 0)
        bounds = displacementBounds(from, to, state, work->instances);
      const std::vector<std::vector<Vector3d>> corners = cornersOf(work->instances);
      for (std::size_t instance = 0; sample > 0 && instance < corners.size(); ++instance)
      {
        if (!std::isfinite(bounds[instance]))
        {
          EXPECT_TRUE(turnsTheLongerWay(from, to) || followersJump(from, to))
              << *work->instances[instance].body.name << " in motion " << motion;
          continue;
        }
        double moved = 0.0;
        for (std::size_t k = 0; k < corners[instance].size(); ++k)
          moved = std::max(moved, (corners[instance][k] - before[instance][k]).norm());
        const double allowed = bounds[instance] / kSamples;
        EXPECT_LE(moved, allowed + 1e-9) << *work->instances[instance].body.name << " in motion " << motion;
        if (allowed > 1e-6)
          largest = std::max(largest, moved / allowed);
      }
      before = corners;
    }
  }
  return largest;
}

TEST(MotionBound, HoldsForPandaWithFingersThatFollow)
{
  EXPECT_GT(expectBoundsToHold(moveit::core::loadTestingRobotModel("panda"), 100), 0.5);
}

TEST(MotionBound, HoldsForPr2OnItsBase)
{
  EXPECT_GT(expectBoundsToHold(moveit::core::loadTestingRobotModel("pr2"), 30), 0.5);
}

TEST(MotionBound, HoldsForFollowersOfAllKinds)
{
  EXPECT_GT(expectBoundsToHold(followerRobot(), 300), 0.99);
}

/// The bound of each shape instance of a robot, for a small motion of all its joints.
std::vector<double> boundsOf(const RobotModelPtr& robot)
{
  RobotState from(robot);
  from.setToDefaultValues();
  RobotState to = from;
  for (const std::string& variable : robot->getVariableNames())
    if (variable.find("rot_") == std::string::npos)
      to.setVariablePosition(variable, 0.1);
  from.update();
  to.update();
  Workspace work;
  RobotGeometry(*robot, {}, {}).place(from, nullptr, work->instances, work->attached);
  return displacementBounds(from, to, from, work->instances);
}

TEST(MotionBound, IsInfiniteForABaseThatTurnsBeforeItDrives)
{
  const RobotModelPtr robot = moveit::core::loadTestingRobotModel("pr2");
  auto* base = dynamic_cast<moveit::core::PlanarJointModel*>(robot->getJointModel("world_joint"));
  ASSERT_NE(base, nullptr);
  for (const double bound : boundsOf(robot))
    EXPECT_TRUE(std::isfinite(bound));
  base->setMotionModel(moveit::core::PlanarJointModel::DIFF_DRIVE);
  for (const double bound : boundsOf(robot))
    EXPECT_FALSE(std::isfinite(bound));
}

/// MoveIt lets a planar or floating follower have the first variable of its leader, and keeps its other variables.
TEST(MotionBound, IsInfiniteForFollowersWithSeveralVariables)
{
  for (const char* type : {"planar", "floating"})
  {
    const RobotModelPtr robot =
        robotFromUrdf("<link name='base'/>" + jointWithLink("lead", type, "base", "leader", "0 0 0", "0 0 1", "") +
                          jointWithLink("follow", type, "base", "follower", "0 0 0", "0 0 1", "<mimic joint='lead'/>"),
                      "");
    const std::vector<double> bounds = boundsOf(robot);
    ASSERT_EQ(bounds.size(), 2U);
    EXPECT_EQ(std::count_if(bounds.begin(), bounds.end(), [](double bound) { return std::isfinite(bound); }), 1)
        << type;
  }
}

/// Small rotations of a floating joint. The norms of the quaternions are wrong by up to the tolerance of 1e-6.
void turnALittle(RobotState& from, RobotState& to, random_numbers::RandomNumberGenerator& random)
{
  const JointModel* joint = from.getRobotModel()->getActiveJointModels().front();
  const double angle = std::pow(10.0, random.uniformReal(-5.0, -0.5));
  const Vector3d axis =
      Vector3d(random.uniformReal(-1.0, 1.0), random.uniformReal(-1.0, 1.0), random.uniformReal(-1.0, 1.0))
          .normalized();
  const Eigen::Quaterniond start(
      Eigen::AngleAxisd(random.uniformReal(-3.0, 3.0), Vector3d(axis.y(), axis.z(), axis.x())));
  const Eigen::Quaterniond end = start * Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
  const auto set = [&](RobotState& state, const Eigen::Quaterniond& rotation)
  {
    std::array<double, 7> values = {};
    const Eigen::Vector4d coefficients = (1.0 + random.uniformReal(-9e-7, 9e-7)) * rotation.coeffs();
    std::copy_n(coefficients.data(), 4, values.begin() + 3);
    state.setJointPositions(joint, values.data());
    state.update();
  };
  set(from, start);
  set(to, end);
}

TEST(MotionBound, HoldsForQuaternionsThatAreNotExactlyNormalised)
{
  const RobotModelPtr robot =
      robotFromUrdf("<link name='base'/>" + jointWithLink("move", "floating", "base", "bar", "0 0 0", "0 0 1", ""), "");
  EXPECT_GT(expectBoundsToHold(robot, 2000, turnALittle), 0.5);
}

TEST(MotionBound, HoldsForAChainOfAllKindsOfJoints)
{
  geometry_msgs::Pose pose;
  pose.orientation.w = 1.0;
  pose.position.x = 0.3;
  for (const char* base : {"planar", "floating"})
  {
    moveit::core::RobotModelBuilder builder("chain", "base");
    builder.addCollisionBox("base", {0.4, 0.3, 0.2}, pose);
    std::string last = "base";
    int number = 0;
    for (const char* type :
         {"prismatic", "continuous", "prismatic", "revolute", "planar", "revolute", "floating", "revolute"})
    {
      const std::string link = "link" + std::to_string(number++);
      builder.addChain(last + "->" + link, type, {pose},
                       urdf::Vector3(number % 3 == 0, number % 3 == 1, number % 3 == 2));
      builder.addCollisionBox(link, {0.2, 0.1, 0.1}, pose);
      last = link;
    }
    builder.addVirtualJoint("world", "base", base, "root");
    builder.addGroupChain("base", last, "all");
    EXPECT_GT(expectBoundsToHold(builder.build(), 200), 0.2);
  }
}
}  // namespace
}  // namespace gpu_planning_scene::detector
