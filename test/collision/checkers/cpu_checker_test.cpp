#include "gpu_planning_scene/cpu_checker.h"

#include <cmath>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include "collision/checkers/open_checker.h"
#include "gpu_planning_scene/error.h"
#include "model/model_testing.h"
#include "support/obstacles.h"

namespace gpu_planning_scene::core
{
namespace
{
std::string boxOf(const std::string& name, const std::string& size, const std::string& origin)
{
  return "<link name='" + name + "'><collision><origin xyz='" + origin + "'/><geometry><box size='" + size +
         "'/></geometry></collision></link>";
}

std::string joint(const std::string& name, const std::string& parent, const std::string& child, const std::string& axis,
                  const std::string& origin)
{
  return jointXml(name, "revolute", parent, child,
                  "<origin xyz='" + origin + "'/><axis xyz='" + axis +
                      "'/><limit lower='-2.5' upper='2.5' effort='1' velocity='1'/>");
}

/// base -pan-> upper -elbow-> fore, a metre each, and base -neck-> head, among obstacles; adjacent links may touch.
std::shared_ptr<PlanningScene> armAmongObstacles()
{
  const std::string urdf = boxOf("base", "0.4 0.4 0.4", "0 0 0") + boxOf("upper", "1 0.1 0.1", "0.5 0 0") +
                           boxOf("fore", "1 0.1 0.1", "0.5 0 0") + boxOf("head", "0.2 0.2 0.6", "0.1 0 0.3") +
                           joint("pan", "base", "upper", "0 0 1", "0 0 0.1") +
                           joint("elbow", "upper", "fore", "0 1 0", "1 0 0") +
                           joint("neck", "base", "head", "1 0 0", "0 0 0.3");
  auto scene = std::make_shared<PlanningScene>(robotOf(urdf, "<group name='head'><joint name='neck'/></group>"));
  scene->allowed_collisions = AllowedCollisionMatrix();
  for (const auto& [first, second] : scene->robot->adjacentLinks())
    scene->allowed_collisions.setEntry(scene->robot->links()[first].name, scene->robot->links()[second].name, true);
  scene->objects = generateObstacles({20, {0.0, 0.0, 0.0}, 0.8, 2.0, 0.4}, 5);
  scene->revision = 17;
  return scene;
}

std::vector<double> randomStates(const RobotModel& robot, std::size_t count)
{
  std::mt19937_64 generator(9);
  std::vector<double> states(count * robot.variables().size());
  for (std::size_t i = 0; i < count; ++i)
    robot.randomState(generator, states.data() + i * robot.variables().size());
  return states;
}

class CpuCheckerTest : public testing::Test
{
 protected:
  static constexpr std::size_t kCount = 500;

  std::shared_ptr<PlanningScene> scene_ = armAmongObstacles();
  std::size_t width_ = scene_->robot->variables().size();
  std::vector<double> states_ = randomStates(*scene_->robot, kCount);
  CpuChecker checker_{scene_};
};

TEST_F(CpuCheckerTest, NamesAPairForCollidingStatesOnly)
{
  const BatchResult result = checker_.check(states_.data(), kCount);
  const int bodies = static_cast<int>(scene_->robot->links().size() + scene_->objects.size());
  std::size_t free = 0;
  for (std::size_t i = 0; i < kCount; ++i)
  {
    free += result.valid[i];
    if (result.valid[i] != 0)
    {
      EXPECT_EQ((BodyPair{-1, -1}), result.colliding[i]);
    }
    else
    {
      EXPECT_GE(result.colliding[i][0], 0);
      EXPECT_LT(result.colliding[i][0], result.colliding[i][1]);
      EXPECT_LT(result.colliding[i][1], bodies);
    }
  }
  EXPECT_GT(free, kCount / 20);
  EXPECT_LT(free, kCount - kCount / 20);
  EXPECT_EQ(17u, result.revision);
}

TEST_F(CpuCheckerTest, AnswersAlikeInBatchesOfAnySizeAndFromSeveralThreads)
{
  const BatchResult expected = checker_.check(states_.data(), kCount);
  std::vector<std::thread> threads;
  for (const std::size_t batch : {1, 7, 64, 500})
  {
    threads.emplace_back(
        [&, batch]
        {
          for (std::size_t i = 0; i < kCount; i += batch)
          {
            const std::size_t count = std::min(batch, kCount - i);
            const BatchResult part = checker_.check(states_.data() + i * width_, count);
            EXPECT_TRUE(std::equal(part.valid.begin(), part.valid.end(), expected.valid.begin() + i)) << "at " << i;
          }
        });
  }
  for (std::thread& thread : threads)
    thread.join();
}

TEST_F(CpuCheckerTest, AGroupLeavesOutWhatItDoesNotMove)
{
  const std::vector<std::uint8_t> all = checker_.check(states_.data(), kCount).valid;
  const BatchResult head = checker_.check(states_.data(), kCount, "head");
  const int head_link = scene_->robot->linkIndex("head");
  std::size_t freed = 0;
  for (std::size_t i = 0; i < kCount; ++i)
  {
    EXPECT_LE(all[i], head.valid[i]);
    freed += all[i] < head.valid[i] ? 1 : 0;
    if (head.valid[i] == 0)
      EXPECT_TRUE(head.colliding[i][0] == head_link || head.colliding[i][1] == head_link);
  }
  EXPECT_GT(freed, 0u);
  EXPECT_LT(checker_.report("head").world_pairs, checker_.report().world_pairs);
}

TEST(OpenCpuChecker, TakesTheOptions)
{
  BatchCheckerOptions options;
  options.device = "cpu";
  const auto scene = std::make_shared<PlanningScene>(robotOf(armUrdf()));
  const auto shared_trees = [&]
  {
    const auto checker = openChecker(scene, options, [](const std::string&) {});
    EXPECT_EQ(checker->deviceName(), "CPU");
    return checker->report().shared_trees;
  };
  EXPECT_GT(shared_trees(), 0u);
  options.reductions.shared_trees = false;
  EXPECT_EQ(shared_trees(), 0u);
}

TEST_F(CpuCheckerTest, RefusesWhatItCannotCheckAndGoesOn)
{
  const BatchResult expected = checker_.check(states_.data(), kCount);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()})
  {
    std::vector<double> spoiled = states_;
    spoiled[3 * width_ + 1] = bad;
    const std::string error = errorOf([&] { checker_.check(spoiled.data(), kCount); });
    EXPECT_NE(std::string::npos, error.find("state 3")) << error;
    EXPECT_NE(std::string::npos, error.find(scene_->robot->variables()[1].name)) << error;
  }
  EXPECT_THROW(checker_.check(states_.data(), kCount, "leg"), Error);
  EXPECT_THROW(checker_.report("leg"), Error);
  EXPECT_EQ(expected.valid, checker_.check(states_.data(), kCount).valid);
  EXPECT_TRUE(checker_.check(nullptr, 0).valid.empty());
}

TEST(StatesFarAway, AreRefusedWithTheVariableAndItsBound)
{
  const std::string limits = "<limit lower='-9' upper='9' effort='1' velocity='1'/>";
  const std::string follower = "<axis xyz='1 0 0'/>" + limits + "<mimic joint='turn' multiplier='1000' offset='5'/>";
  const auto robot =
      robotOf(boxOf("base", "1 1 1", "0 0 0") + boxOf("a", "1 1 1", "0 0 0") + boxOf("b", "1 1 1", "0 0 0") +
                  boxOf("c", "1 1 1", "0 0 0") + joint("turn", "base", "a", "0 0 1", "0 0 0") +
                  jointXml("push", "prismatic", "base", "b", follower) + jointXml("cart", "planar", "base", "c"),
              "<virtual_joint name='world' type='floating' parent_frame='map' child_link='base'/>");
  CpuChecker checker(std::make_shared<PlanningScene>(robot));
  const auto refusal = [&](const std::string& variable, double value)
  {
    std::vector<double> state = robot->defaultState();
    state[static_cast<std::size_t>(robot->variableIndex(variable))] = value;
    return errorOf([&] { checker.check(state.data(), 1); });
  };
  for (const char* variable : {"world/trans_x", "world/trans_z", "cart/x", "cart/y"})
  {
    EXPECT_EQ("", refusal(variable, -1e6)) << variable;
    for (const double value : {1.1e6, -1e39, 1e300})
      EXPECT_NE(std::string::npos, refusal(variable, value).find(std::string("'") + variable + "'")) << value;
    EXPECT_NE(std::string::npos, refusal(variable, -1e39).find("-1e+39; it must be within 1000000")) << variable;
  }
  EXPECT_EQ("", refusal("turn", 999.0));
  EXPECT_NE(std::string::npos, refusal("turn", 1001.0).find("within 999.995")) << "push follows it, by 1000 m a radian";
  for (const char* variable : {"world/rot_x", "cart/theta"})
    EXPECT_EQ("", refusal(variable, 1e300)) << variable;
}

TEST_F(CpuCheckerTest, ANewSceneReplacesTheOldOneUnlessItIsRefused)
{
  const BatchResult expected = checker_.check(states_.data(), kCount);
  checker_.check(states_.data(), kCount, "head");
  auto broken = std::make_shared<PlanningScene>(*scene_);
  broken->objects[0].shapes.push_back({Sphere{0.0}});
  EXPECT_THROW(checker_.setScene(broken), Error);
  EXPECT_THROW(checker_.setScene(nullptr), Error);
  EXPECT_EQ(expected.valid, checker_.check(states_.data(), kCount).valid);

  auto other = std::make_shared<PlanningScene>(*scene_);
  other->objects = generateObstacles({30, {0.0, 0.0, 0.0}, 0.6, 1.8, 0.6}, 6);
  other->objects[0].pose = Eigen::Isometry3d::Identity();
  other->objects[0].pose.translation().z() = 0.6;
  other->objects[0].shapes = {{sheetMesh(3.0)}};
  other->revision = 18;
  checker_.setScene(other);
  const BatchResult result = checker_.check(states_.data(), kCount);
  EXPECT_EQ(18u, result.revision);
  EXPECT_NE(expected.valid, result.valid);
  EXPECT_EQ(CpuChecker(other).check(states_.data(), kCount).valid, result.valid);
  EXPECT_EQ(CpuChecker(other).check(states_.data(), kCount, "head").valid,
            checker_.check(states_.data(), kCount, "head").valid);
}
}  // namespace
}  // namespace gpu_planning_scene::core
