// The kinematics shader generated for a robot gives the model's poses, up to the rounding of float32.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "collision/gpu/gpu_checker.h"
#include "collision/gpu/problem/gpu_kinematics.h"
#include "collision/gpu/problem/gpu_scene.h"
#include "collision/gpu/problem/placeable_states.h"
#include "gpu/egl_context.h"
#include "gpu/float_arithmetic.h"
#include "model/model_testing.h"
#include "model/real_robots.h"
#include "support/seed.h"
#include "support/shader_folder.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kPosedStates = 200;

/// Two shapes on each link, one of them rotated, relative to an origin.
CollisionProblem shapesOn(const RobotModel& robot)
{
  CollisionProblem problem;
  problem.origin = {0.5, -0.25, 0.125};
  for (std::size_t link = 0; link < robot.links().size(); ++link)
    for (const double angle : {0.0, 1.0})
      problem.robot.push_back({0, static_cast<std::int32_t>(link), static_cast<std::int32_t>(link),
                               Eigen::Translation3d(0.1 * angle, 0.2, -0.3 * angle) *
                                   Eigen::AngleAxisd(angle, Eigen::Vector3d(1.0, 2.0, -2.0) / 3.0)});
  return problem;
}

/// Random states. Some variables are at their upper limit, and some values are displaced by up to 1e4.
std::vector<double> statesOf(const RobotModel& robot)
{
  std::mt19937_64 generator(kSeed);
  const std::size_t width = robot.variables().size();
  std::vector<double> states(kPosedStates * width);
  for (std::size_t i = 0; i < kPosedStates; ++i)
  {
    robot.randomState(generator, &states[i * width]);
    for (std::size_t v = 0; v < width; ++v)
    {
      const Variable& variable = robot.variables()[v];
      if (generator() % 8 == 0)
        states[i * width + v] = variable.upper;
      if (generator() % 8 == 0)
        states[i * width + v] += std::uniform_real_distribution<double>(-1e4, 1e4)(generator);
    }
  }
  return states;
}

void expectPosesOfTheModel(const std::shared_ptr<const RobotModel>& robot)
{
  EglContext context("auto");
  const CollisionProblem problem = shapesOn(*robot);
  const std::vector<double> states = statesOf(*robot);
  GpuKinematics kinematics(shaderFolder(), robot);
  kinematics.setInstances(problem);
  kinematics.setStates(states.data());
  const std::size_t count = problem.robot.size();
  TexelBuffer poses;
  poses.reserve(kPosedStates * count * 12 * sizeof(float));
  const Buffer no_list(COUNTER_WORDS * sizeof(std::uint32_t));
  no_list.bindStorage(BINDING_COUNTERS);
  no_list.bindStorage(BINDING_OPEN_STATES);
  kinematics.begin(0, kPosedStates);
  kinematics.place(poses);
  std::vector<float> found(kPosedStates * count * 12);
  poses.buffer().read(found.data(), found.size() * sizeof(float));

  std::vector<Eigen::Isometry3d> links(robot->links().size());
  for (std::size_t i = 0; i < kPosedStates; ++i)
  {
    robot->linkPoses(&states[i * robot->variables().size()], links.data());
    for (std::size_t k = 0; k < count; ++k)
    {
      const ShapeInstance& shape = problem.robot[k];
      Eigen::Isometry3d pose = links[static_cast<std::size_t>(shape.link)] * shape.pose;
      pose.translation() -= problem.origin;
      // Half a unit in the last place of a float, and the error of the computation in double.
      const double scale = 1.0 + links[static_cast<std::size_t>(shape.link)].translation().norm();
      for (int entry = 0; entry < 12; ++entry)
      {
        const double expected = pose(entry / 4, entry % 4);
        ASSERT_NEAR(found[(k * kPosedStates + i) * 12 + static_cast<std::size_t>(entry)], expected,
                    0x1p-24 * std::abs(expected) + 1e-13 * scale)
            << "state " << i << ", shape " << k << " on " << robot->links()[static_cast<std::size_t>(shape.link)].name
            << ", seed " << kSeed;
      }
    }
  }
}

TEST(GpuKinematics, PlacesTheLinksOfRealRobots)
{
  const std::vector<RealRobot> robots = realRobots();
  if (robots.empty())
    GTEST_SKIP() << "there is no robot to try";
  for (const RealRobot& robot : robots)
  {
    SCOPED_TRACE(robot.name);
    expectPosesOfTheModel(robot.load());
  }
}

TEST(GpuKinematics, KnowsAllTypesOfJointsAndMimics)
{
  const std::string axis = "<axis xyz='0.6 0 0.8'/><origin xyz='0.1 0.2 0.3' rpy='0.3 -0.2 0.9'/>";
  const std::string mimic = axis + kLimits + "<mimic joint='turn' multiplier='-0.7' offset='0.25'/>";
  expectPosesOfTheModel(robotOf(
      boxLink("root") + boxLink("a") + boxLink("b") + boxLink("c") + boxLink("d") + boxLink("e") + boxLink("f") +
          boxLink("g") + jointXml("turn", "revolute", "root", "a", axis + kLimits) +
          jointXml("spin", "continuous", "a", "b", axis) + jointXml("push", "prismatic", "b", "c", axis + kLimits) +
          jointXml("slide", "planar", "root", "d", axis) + jointXml("fly", "floating", "d", "e", axis) +
          jointXml("follow", "revolute", "e", "f", mimic) + jointXml("weld", "fixed", "f", "g", axis),
      "<virtual_joint name='world' type='floating' parent_frame='map' child_link='root'/>"));
}

TEST(GpuKinematics, AndTheModelTurnByQuaternionsOfAnyLength)
{
  const auto robot = robotOf(boxLink("a") + boxLink("b") + jointXml("fly", "floating", "a", "b"));
  std::vector<Eigen::Isometry3d> links(2);
  for (const double length : {5e-324, 1e-160, 1.0, 1e160, 1.7e308})
  {
    const std::vector<double> state = {0.0, 0.0, 0.0, 0.0, length, 0.0, length};
    robot->linkPoses(state.data(), links.data());
    EXPECT_NEAR(links[1].linear()(0, 2), 1.0, 1e-12) << length;  // a quarter turn about y
  }
}

TEST(PlaceableStates, HaveNoAnglesBeyondTheSineOfTheShader)
{
  const auto robot = robotOf(boxLink("a") + boxLink("b") + jointXml("spin", "continuous", "a", "b"));
  const PlaceableStates placeable(*robot);
  for (const double angle : {0.0, 1e6, -1e6})
    EXPECT_TRUE(placeable.contains(&angle)) << angle;
  for (const double angle : {1.1e6, -1e300})
    EXPECT_FALSE(placeable.contains(&angle)) << angle;
}

TEST(PlaceableStates, HaveNoVeryShortAndNoVeryLongQuaternions)
{
  const auto robot = robotOf(boxLink("a") + boxLink("b") + jointXml("fly", "floating", "a", "b"));
  const PlaceableStates placeable(*robot);
  const auto can_place = [&](double length)
  {
    const std::vector<double> state = {0.0, 0.0, 0.0, 0.0, length, 0.0, -length};
    return placeable.contains(state.data());
  };
  for (const double length : {0.0, 1e-100, 1.0, 1e100})
    EXPECT_TRUE(can_place(length)) << length;
  for (const double length : {5e-324, 1e-310, 1e-200, 1e200, 1.7e308})
    EXPECT_FALSE(can_place(length)) << length;
}

TEST(GpuKinematics, AShaderThatPlacesALinkElsewhereIsFoundOut)
{
  EglContext context("auto");
  const auto robot = robotOf(boxLink("a") + boxLink("b") + jointXml("spin", "continuous", "a", "b"));
  ShaderFolder folder;
  EXPECT_EQ(GpuKinematics(folder.path(), robot).findFault(), "");
  folder.replace("problem/kinematics.glsl", "1.0lf / 120.0lf", "1.0lf / 121.0lf");
  EXPECT_NE(GpuKinematics(folder.path(), robot).findFault().find("link 'b'"), std::string::npos);
}

TEST(GpuKinematics, ADeviceWithOtherDoublesIsFoundOut)
{
  EglContext context("auto");
  ShaderFolder folder;
  EXPECT_EQ(findDoubleFault(folder.path()), "");
  folder.replace("self_test/double_arithmetic.comp", "n.x / n.y", "n.x / n.y * 1.000000000001lf");
  EXPECT_NE(findDoubleFault(folder.path()), "");
}

TEST(GpuKinematics, ADeviceThatEmulatesDoublesIsFoundOutAndTheCpuComputesThePoses)
{
  ShaderFolder folder;
  std::string emulation;
  for (int i = 0; i < 2000; ++i)
    emulation += "  x = x * n.y + n.y;\n";
  {
    EglContext context("auto");
    EXPECT_EQ(findEmulatedDouble(folder.path()), "");
    folder.replace("self_test/double_size.comp", "  x = x * n.y + n.y;\n", emulation);
    EXPECT_NE(findEmulatedDouble(folder.path()), "");
  }
  BatchCheckerOptions options;
  options.shader_folder = folder.path();
  // The kinematics would not compile.
  folder.replace("problem/kinematics.glsl", "DoublePose compose", "Wrong compose");
  GpuChecker checker(options);
  EXPECT_NE(checker.fault().find("emulates"), std::string::npos) << checker.fault();
  const auto robot = robotOf(boxLink("a") + boxLink("b") + jointXml("spin", "continuous", "a", "b"));
  checker.setProblem(std::make_shared<const CollisionProblem>(), robot);
  EXPECT_NE(checker.fault().find("emulates"), std::string::npos);
}
}  // namespace
}  // namespace gpu_planning_scene::core
