// Padding and floors from scene files on a real robot. The oracle computes the true distances.

#include <random>

#include <gtest/gtest.h>

#include "collision/bounds/problem_maker.h"
#include "collision/problem/collision_problem.h"
#include "model/model_testing.h"
#include "model/real_robots.h"
#include "oracle/problem_oracle.h"
#include "support/checkers.h"

namespace gpu_planning_scene::core
{
namespace
{
class PaddedRobot : public testing::TestWithParam<const char*>
{
 public:
  void SetUp() override
  {
    SKIP_WITHOUT(kr5());
    static const auto loaded = kr5().load();
    robot = loaded;
    state = robot->defaultState();
  }

  PlanningScene load(const std::string& yaml) const
  {
    return loadSceneFile(folder_.write("scene.yaml", yaml), robot, {});
  }

  /// The smallest value of distance minus required distance over all checked pairs.
  double clearance(const PlanningScene& scene) const
  {
    const oracle::ProblemOracle oracle(std::make_shared<const CollisionProblem>(makeProblem(scene, "", nullptr)));
    return oracle.clearance(oracle::linkPoses(*robot, state.data()), 10.0);
  }

  bool isFree(const PlanningScene& scene) const
  {
    return checkerOf(GetParam(), scene).check(state.data(), 1).valid[0] != 0;
  }

  std::shared_ptr<const RobotModel> robot;
  std::vector<double> state;

 private:
  TemporaryFolder folder_;
};

/// A scene file with a ball beside the robot and padding for every link.
std::string ballScene(const RobotModel& robot, double padding)
{
  std::string yaml = "link_padding:\n";
  for (const Link& link : robot.links())
    yaml += "  - {link_name: " + link.name + ", padding: " + std::to_string(padding) + "}\n";
  return yaml +
         "world: {collision_objects: [{id: ball, pose: {position: [0.5, 0.2, 0.2]}, "
         "primitives: [{type: sphere, dimensions: [0.1]}]}]}\n";
}

void allowLinksAmongThemselves(PlanningScene& scene)
{
  const auto& links = scene.robot->links();
  for (const Link& a : links)
    for (const Link& b : links)
      scene.allowed_collisions.setEntry(a.name, b.name, true);
}

TEST_P(PaddedRobot, CollidesAtTheSumOfThePaddings)
{
  PlanningScene scene = load(ballScene(*robot, 0.03));
  allowLinksAmongThemselves(scene);
  const double rest = clearance(scene);
  ASSERT_GT(rest, 0.01);  // not touching yet, and near enough to be measured
  ASSERT_LT(rest, 0.1);
  EXPECT_TRUE(isFree(scene));
  for (const double offset : {1e-3, 1e-6, 1e-8})
  {
    SCOPED_TRACE(offset);
    scene.objects[0].padding = rest - offset;
    EXPECT_TRUE(isFree(scene));
    scene.objects[0].padding = rest + offset;
    EXPECT_FALSE(isFree(scene));
  }
}

TEST_P(PaddedRobot, IsNotPaddedAgainstItself)
{
  PlanningScene scene = load(ballScene(*robot, 0.0));
  scene.objects.clear();
  ASSERT_TRUE(isFree(scene));
  scene.link_padding.assign(robot->links().size(), 10.0);
  EXPECT_TRUE(isFree(scene));
}

TEST_P(PaddedRobot, StandsOnAFloorOfAPlane)
{
  PlanningScene scene = load("world: {collision_objects: [{id: floor, planes: [{coef: [0, 0, 2, 1]}]}]}");  // z <= -0.5
  allowLinksAmongThemselves(scene);
  scene.allowed_collisions.setEntry(robot->links()[0].name, "floor", true);
  const double rest = clearance(scene);
  ASSERT_GT(rest, 0.01);
  ASSERT_LT(rest, 5.0);
  EXPECT_TRUE(isFree(scene));
  for (const double offset : {1e-3, 1e-6, 1e-8})
  {
    SCOPED_TRACE(offset);
    scene.objects[0].pose.translation().z() = rest - offset;
    EXPECT_TRUE(isFree(scene));
    scene.objects[0].pose.translation().z() = rest + offset;
    EXPECT_FALSE(isFree(scene));
  }
  scene.objects[0].pose.translation().z() = rest - 0.02;
  scene.link_padding.assign(robot->links().size(), 0.0201);
  EXPECT_FALSE(isFree(scene));
}

INSTANTIATE_TEST_SUITE_P(Checkers, PaddedRobot, testing::Values("cpu", "breadth_first", "work_queue"),
                         [](const auto& parameter) { return std::string(parameter.param); });

/// Padding can be large compared with a link and all other shapes. The rounding error of a comparison is then larger
/// than an error bound from the link's size.
TEST(Padding, OfMetresAroundATinyLinkIsKept)
{
  constexpr std::uint64_t kSeed = 7;
  std::mt19937_64 generator(kSeed);
  std::uniform_real_distribution<double> uniform(0.7, 1.3);
  const std::string size = "<geometry><box size=\"0.002 0.002 0.002\"/></geometry>";
  const auto robot = robotOf(
      "<link name=\"base\"/><link name=\"tiny\"><collision>" + size + "</collision></link>" +
      jointXml("slide", "prismatic", "base", "tiny", "<limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/>"));
  PlanningScene scene(robot);
  scene.objects.resize(1);
  scene.objects[0].id = "box";
  scene.objects[0].shapes.resize(1);
  scene.objects[0].shapes[0].shape = Box{Eigen::Vector3d::Constant(0.002)};
  // The displacement of the link towards the object, from the position at the required distance.
  std::vector<double> states;
  for (int i = 0; i < 64; ++i)
    states.push_back(1e-9 * (i - 8));
  for (int i = 0; i < 40; ++i)
  {
    const double padding = 3.0 * uniform(generator);
    scene.link_padding.assign(robot->links().size(), padding);
    scene.objects[0].pose.translation().x() = padding + 0.002;
    const auto exact = checkerOf("cpu", scene).check(states.data(), states.size());
    EXPECT_FALSE(exact.valid.back()) << "padding " << padding;
    for (const char* checker : {"breadth_first", "work_queue"})
      EXPECT_EQ(checkerOf(checker, scene).check(states.data(), states.size()).valid, exact.valid)
          << checker << ", padding " << padding << ", seed " << kSeed;
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
