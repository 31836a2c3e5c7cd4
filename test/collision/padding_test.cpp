// Padding and floors on real robots, as scene files ask for them. What is true of a distance comes from the oracle.

#include <gtest/gtest.h>

#include "collision/collision_problem.h"
#include "model/model_testing.h"
#include "model/real_robots.h"
#include "oracle/problem_oracle.h"
#include "support/checkers.h"

namespace gpu_planning_scene
{
namespace
{
class PaddedRobot : public testing::TestWithParam<const char*>
{
 public:
  void SetUp() override
  {
    SKIP_WITHOUT(kr5());
    static const auto robot = kr5().load();
    robot_ = robot;
    state_ = robot_->defaultState();
  }

  PlanningScene load(const std::string& yaml) const
  {
    return loadSceneFile(folder_.write("scene.yaml", yaml), robot_, {});
  }

  /// By how much the closest checked pair is further apart than its padding.
  double clearance(const PlanningScene& scene) const
  {
    const oracle::ProblemOracle oracle(std::make_shared<const CollisionProblem>(makeProblem(scene, "", nullptr)));
    return oracle.clearance(oracle::linkPoses(*robot_, state_.data()), 10.0);
  }

  bool isFree(const PlanningScene& scene) const
  {
    return checkerOf(GetParam(), scene).check(state_.data(), 1).valid[0] != 0;
  }

  std::shared_ptr<const RobotModel> robot_;
  std::vector<double> state_;

 private:
  TemporaryFolder folder_;
};

/// A scene file of a ball beside the robot, with padding for every link.
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
  PlanningScene scene = load(ballScene(*robot_, 0.03));
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
  PlanningScene scene = load(ballScene(*robot_, 0.0));
  scene.objects.clear();
  ASSERT_TRUE(isFree(scene));
  scene.link_padding.assign(robot_->links().size(), 10.0);
  EXPECT_TRUE(isFree(scene));
}

TEST_P(PaddedRobot, StandsOnAFloorOfAPlane)
{
  PlanningScene scene = load("world: {collision_objects: [{id: floor, planes: [{coef: [0, 0, 2, 1]}]}]}");  // z <= -0.5
  allowLinksAmongThemselves(scene);
  scene.allowed_collisions.setEntry(robot_->links()[0].name, "floor", true);
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
  scene.link_padding.assign(robot_->links().size(), 0.0201);
  EXPECT_FALSE(isFree(scene));
}

INSTANTIATE_TEST_SUITE_P(Checkers, PaddedRobot, testing::Values("cpu", "breadth_first", "work_queue"),
                         [](const auto& parameter) { return std::string(parameter.param); });
}  // namespace
}  // namespace gpu_planning_scene
