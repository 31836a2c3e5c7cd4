// Pairs that are left out of a problem change no answer, within the joint limits, outside of them, and for groups.
#include <iostream>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "collision/bounds/problem_maker.h"
#include "collision/exact/exact_checker.h"
#include "collision/report/scene_text.h"
#include "collision/trees/binned_sah.h"
#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "model/model_testing.h"
#include "scene/slider_robot.h"
#include "support/carrying_scene.h"
#include "support/kept_trees.h"
#include "support/repetitions.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
struct Setting
{
  std::string name;
  Reductions reductions;
};

Reductions only(bool reach, bool rigid_pairs, bool shared_trees, bool direct_primitives)
{
  Reductions reductions = Reductions::none();
  reductions.reach = reach;
  reductions.rigid_pairs = rigid_pairs;
  reductions.shared_trees = shared_trees;
  reductions.direct_primitives = direct_primitives;
  return reductions;
}

const Setting kNone = {"none", only(false, false, false, false)};
const Setting kAll = {"all", Reductions()};
const Setting kDirect = {"direct primitives", only(false, false, false, true)};
const std::vector<Setting> kEach = {{"reach", only(true, false, false, false)},
                                    {"rigid pairs", only(false, true, false, false)},
                                    {"shared trees", only(false, false, true, false)},
                                    kAll};

CheckerOptions with(const Reductions& reductions)
{
  CheckerOptions options;
  options.reductions = reductions;
  return options;
}

/// Two of three states are within the limits, some of them at limits. The others are outside by up to 3 rad or 3 m.
std::vector<double> statesInAndOut(const RobotModel& robot, std::size_t count)
{
  std::mt19937_64 generator(kSeed);
  const std::size_t width = robot.variables().size();
  std::vector<double> states(count * width);
  for (std::size_t i = 0; i < count; ++i)
  {
    robot.randomState(generator, &states[i * width]);
    for (std::size_t v = 0; v < width; ++v)
    {
      const Variable& variable = robot.variables()[v];
      if (variable.bounded && generator() % 4 == 0)
        states[i * width + v] = variable.upper;
      if (i % 3 == 0 && generator() % 2 == 0)
        states[i * width + v] += std::uniform_real_distribution<double>(-3.0, 3.0)(generator);
    }
  }
  return states;
}

/// A scene of testScene(), or carryingScene() for "carrying".
const TestScene& sceneCalled(const std::string& name)
{
  if (name != "carrying")
    return testScene(name);
  static const TestScene carrying = carryingScene();
  return carrying;
}

class ReductionsIn : public testing::TestWithParam<const char*>
{
 protected:
  void SetUp() override
  {
    const std::string name = GetParam();
    if (const std::string missing = missingFor(name == "carrying" ? "ur5_table_pick" : name); !missing.empty())
      GTEST_SKIP() << "there is no " << missing;
    scene_ = sceneCalled(name).scene;
    keepTrees(*scene_);
    groups_ = {""};
    for (const Group& group : scene_->robot->groups())
      groups_.push_back(group.name);
    std::cout << "seed " << kSeed << std::endl;
  }

  /// The verdicts of the CPU without reductions, by group.
  std::map<std::string, std::vector<std::uint8_t>> validWithAllPairs(const std::vector<double>& states) const
  {
    CpuChecker checker(scene_, with(kNone.reductions));
    const std::size_t count = states.size() / scene_->robot->variables().size();
    std::map<std::string, std::vector<std::uint8_t>> valid;
    for (const std::string& group : groups_)
      valid[group] = checker.check(states.data(), count, group).valid;
    return valid;
  }

  std::shared_ptr<const PlanningScene> scene_;
  std::vector<std::string> groups_;
};

TEST_P(ReductionsIn, ChangeNoAnswerOfTheCpu)
{
  constexpr std::size_t kStates = repetitions(15, 120);
  const std::vector<double> states = statesInAndOut(*scene_->robot, kStates);
  const std::map<std::string, std::vector<std::uint8_t>> whole = validWithAllPairs(states);
  for (const Setting& setting : kEach)
  {
    CpuChecker reduced(scene_, with(setting.reductions));
    for (const std::string& group : groups_)
      EXPECT_EQ(reduced.check(states.data(), kStates, group).valid, whole.at(group))
          << setting.name << ", group '" << group << "', seed " << kSeed;
  }
}

TEST_P(ReductionsIn, ChangeNoAnswerOfTheGpu)
{
  constexpr std::size_t kStates = repetitions(15, 120);
  const std::vector<double> states = statesInAndOut(*scene_->robot, kStates);
  const std::map<std::string, std::vector<std::uint8_t>> whole = validWithAllPairs(states);
  for (const Setting& setting : {kNone, kDirect, kAll})
  {
    BatchCheckerOptions options;
    options.device_only = true;
    options.reductions = setting.reductions;
    BatchChecker reduced(scene_, options);
    for (const std::string& group : groups_)
      EXPECT_EQ(reduced.check(states.data(), kStates, group).valid, whole.at(group))
          << setting.name << ", group '" << group << "', seed " << kSeed;
  }
}

/// The pairs of bodies that `problem` checks.
std::set<BodyPair> bodyPairs(const CollisionProblem& problem)
{
  std::set<BodyPair> pairs;
  for (const auto& [a, b] : problem.self_pairs)
    pairs.insert({problem.robot[a].body, problem.robot[b].body});
  for (std::size_t i = 0; i < problem.robot.size(); ++i)
    for (std::size_t k = 0; k < problem.world.size(); ++k)
      if (problem.world_pairs[i * problem.world.size() + k])
        pairs.insert({problem.robot[i].body, problem.world[k].body});
  for (std::size_t i = 0; i < problem.robot.size(); ++i)
    for (std::size_t k = 0; k < problem.half_spaces.size(); ++k)
      if (problem.half_space_pairs[i * problem.half_spaces.size() + k])
        pairs.insert({problem.robot[i].body, problem.half_spaces[k].body});
  return pairs;
}

/// The problem without the pairs of bodies in `pairs`.
CollisionProblem withoutPairs(CollisionProblem problem, const std::set<BodyPair>& pairs)
{
  std::vector<InstancePair> self_pairs;
  for (const auto& [a, b] : problem.self_pairs)
    if (pairs.count({problem.robot[a].body, problem.robot[b].body}) == 0)
      self_pairs.push_back({a, b});
  problem.self_pairs = self_pairs;
  for (std::size_t i = 0; i < problem.robot.size(); ++i)
  {
    for (std::size_t k = 0; k < problem.world.size(); ++k)
      if (pairs.count({problem.robot[i].body, problem.world[k].body}) != 0)
        problem.world_pairs[i * problem.world.size() + k] = 0;
    for (std::size_t k = 0; k < problem.half_spaces.size(); ++k)
      if (pairs.count({problem.robot[i].body, problem.half_spaces[k].body}) != 0)
        problem.half_space_pairs[i * problem.half_spaces.size() + k] = 0;
  }
  return problem;
}

class BoundsIn : public ReductionsIn
{
};

TEST_P(BoundsIn, LeaveOutOnlyWhatCannotMeetWithinTheLimits)
{
  SceneReport report;
  const CollisionProblem reduced = ProblemMaker(with(only(true, false, true, false))).make(*scene_, "", &report);
  for (const std::string& line : describeScene(*scene_, report, "none"))
    std::cout << line << std::endl;
  const CollisionProblem whole = makeProblem(*scene_, "", nullptr);
  const auto left_out = std::make_shared<const CollisionProblem>(withoutPairs(whole, bodyPairs(reduced)));
  EXPECT_EQ(bodyPairs(*left_out).size(), report.unreachable_self_pairs + report.unreachable_world_pairs);
  const ExactChecker exact(left_out, std::make_shared<const Forest>(buildBinnedSah(left_out->tessellations)));
  ExactChecker::Scratch scratch;
  const RobotModel& robot = *scene_->robot;
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  std::vector<double> state(robot.variables().size());
  std::mt19937_64 generator(kSeed);
  for (int i = 0; i < repetitions(300, 2000); ++i)
  {
    robot.randomState(generator, state.data());
    robot.linkPoses(state.data(), poses.data());
    const auto pair = exact.firstCollision(poses.data(), scratch);
    ASSERT_FALSE(pair) << scene_->bodyName((*pair)[0]) << " - " << scene_->bodyName((*pair)[1]) << ", seed " << kSeed;
  }
}
INSTANTIATE_TEST_SUITE_P(Scenes, ReductionsIn, testing::Values("kr5", "kr5_crowded", "ur5_cage", "carrying"));
INSTANTIATE_TEST_SUITE_P(Scenes, BoundsIn,
                         testing::Values("kr5", "kr5_crowded", "wam", "drchubo", "ur5_cage", "carrying"));

/// base (fixed in the world, with a fixed mast) -swing-> arm; a box in the arm's path, a box far away, and a box behind
/// the base that the arm cannot reach.
class SmallScene : public testing::Test
{
 protected:
  void SetUp() override
  {
    const auto link = [](const std::string& name, const std::string& origin, const std::string& size)
    {
      return "<link name='" + name + "'><collision><origin xyz='" + origin + "'/><geometry><box size='" + size +
             "'/></geometry></collision></link>";
    };
    scene_ = std::make_shared<PlanningScene>(
        robotOf(link("base", "0 0 0", "0.2 0.2 0.2") + link("mast", "0 0 0.5", "0.05 0.05 1") +
                    link("arm", "0.35 0 0", "0.4 0.05 0.05") +
                    jointXml("weld", "fixed", "base", "mast", "<origin xyz='0 0.3 0'/>") +
                    jointXml("swing", "revolute", "base", "arm",
                             "<axis xyz='0 0 1'/><limit lower='-1' upper='1' effort='1' velocity='1'/>"),
                "<group name='arm'><joint name='swing'/></group>"));
    addBox("way", {0.45, 0.0, 0.0});
    addBox("far", {5.0, 0.0, 0.0});
    addBox("behind", {-0.45, 0.0, 0.0});  // reached only if the arm turned by more than a right angle
  }

  void addBox(const std::string& id, const Eigen::Vector3d& at)
  {
    scene_->objects.push_back({id, Eigen::Isometry3d(Eigen::Translation3d(at)), {{Box{{0.1, 0.1, 0.1}}}}});
  }

  SceneReport reportOf(const Reductions& reductions, const std::string& group = "") const
  {
    SceneReport report;
    ProblemMaker(with(reductions)).make(*scene_, group, &report);
    return report;
  }

  std::shared_ptr<PlanningScene> scene_;
};

TEST_F(SmallScene, ReportsWhatIsLeftOutAndWhy)
{
  const SceneReport whole = reportOf(kNone.reductions);
  EXPECT_EQ(whole.self_pairs, 3U);
  EXPECT_EQ(whole.world_pairs, 9U);
  EXPECT_EQ(whole.shared_trees, 0U);
  EXPECT_EQ(whole.trees, 6U);
  EXPECT_EQ(reportOf(only(false, false, true, false)).trees, 4U);
  EXPECT_EQ(reportOf(only(false, false, true, false)).shared_trees, 2U);

  const SceneReport reach = reportOf(only(true, false, true, false));
  EXPECT_EQ(reach.unreachable_objects, 2U);
  EXPECT_EQ(reach.self_pairs + reach.unreachable_self_pairs, whole.self_pairs);
  EXPECT_EQ(reach.world_pairs + reach.unreachable_world_pairs, whole.world_pairs);
  EXPECT_EQ(reach.world_pairs, 1U);  // the arm and the box in its path

  const SceneReport rigid = reportOf(only(false, true, true, false));
  EXPECT_EQ(rigid.rigid_pairs, 1U + 6U);
  EXPECT_EQ(rigid.self_pairs, 2U);
  EXPECT_EQ(rigid.world_pairs, 3U);
  EXPECT_FALSE(rigid.always_colliding);
}

TEST_F(SmallScene, AnswersStatesOutsideTheLimitsWithAllPairs)
{
  const std::vector<double> states = {0.0, 3.1, -0.9, -3.1};  // hits "way", hits "behind", free, hits "behind"
  const std::vector<std::uint8_t> expected = {0, 0, 1, 0};
  CpuChecker on_cpu(scene_);
  EXPECT_EQ(on_cpu.report().unreachable_objects, 2U);
  EXPECT_EQ(on_cpu.check(states.data(), 4).valid, expected);
  for (const bool device_only : {true, false})
  {
    BatchCheckerOptions options;
    options.device_only = device_only;
    const BatchResult result = BatchChecker(scene_, options).check(states.data(), 4);
    EXPECT_EQ(result.valid, expected);
    EXPECT_EQ(scene_->bodyName(result.colliding[3][1]), "behind");
  }
}

TEST_F(SmallScene, CollidesInEveryStateWhereAFixedPairDoes)
{
  addBox("on_mast", {0.0, 0.3, 1.0});
  const std::vector<double> states = {0.9, -0.9, 3.1};
  CpuChecker on_cpu(scene_);
  BatchCheckerOptions options;
  options.device_only = true;
  BatchChecker on_gpu(scene_, options);
  for (StateChecker* checker : {static_cast<StateChecker*>(&on_cpu), static_cast<StateChecker*>(&on_gpu)})
  {
    const SceneReport report = checker->report();
    ASSERT_TRUE(report.always_colliding);
    const BatchResult result = checker->check(states.data(), 3);
    EXPECT_EQ(result.valid, std::vector<std::uint8_t>(3, 0));
    EXPECT_EQ(scene_->bodyName(result.colliding[0][0]), "mast");
    EXPECT_EQ(scene_->bodyName(result.colliding[0][1]), "on_mast");
    // The group does not move the mast.
    EXPECT_FALSE(checker->report("arm").always_colliding);
    EXPECT_EQ(checker->check(states.data(), 2, "arm").valid, std::vector<std::uint8_t>(2, 1));
  }
  scene_->allowed_collisions.setEntry("mast", "on_mast", true);
  on_gpu.setScene(scene_);
  EXPECT_EQ(on_gpu.check(states.data(), 2).valid, std::vector<std::uint8_t>(2, 1));
}

/// The names of the pairs that collided in all samples.
std::vector<std::string> sampledPairs(const std::shared_ptr<const PlanningScene>& scene)
{
  std::vector<std::string> names;
  for (const BodyPair& pair : CpuChecker(scene).report().colliding_in_samples)
    names.push_back(scene->bodyName(pair[0]) + " - " + scene->bodyName(pair[1]));
  return names;
}

/// The pose of the base comes from tf or from a state, so a crate at the origin need not touch the robot.
TEST(ReportOfSamples, SaysNothingOfObjectsAroundABaseThatMoves)
{
  const WorldObject crate{"crate", Eigen::Isometry3d::Identity(), {{Box{{10.0, 10.0, 0.2}}}}};
  for (const std::string type : {"floating", "planar"})
  {
    const auto scene = std::make_shared<PlanningScene>(sliderRobotOnFloor(type));
    scene->objects.push_back(crate);
    EXPECT_TRUE(sampledPairs(scene).empty()) << type;
    EXPECT_TRUE(warningsOfScene(*scene, CpuChecker(scene).report()).empty()) << type;
  }
  const auto fixed = std::make_shared<PlanningScene>(sliderRobotOnFloor("fixed"));
  fixed->objects.push_back(crate);
  EXPECT_EQ(std::vector<std::string>{"cart - crate"}, sampledPairs(fixed));
}

/// A tray on a caster that nobody measures, and an arm on the tray. Both are large, and overlap.
TEST(ReportOfSamples, SaysNothingOfPairsBetweenWhichAPassiveJointLies)
{
  const auto scene_with = [](const std::string& srdf)
  {
    return std::make_shared<PlanningScene>(
        robotOf("<link name='base'/>" + boxLink("tray") + boxLink("arm") +
                    jointXml("caster", "continuous", "base", "tray", "<axis xyz='0 0 1'/>") +
                    jointXml("joint", "revolute", "tray", "arm", "<axis xyz='0 0 1'/>" + std::string(kLimits)),
                "<group name='g'><joint name='joint'/></group>" + srdf));
  };
  const auto measured = scene_with("");
  const auto passive = scene_with("<passive_joint name='caster'/>");
  for (const auto& scene : {measured, passive})
    scene->objects.push_back({"crate", Eigen::Isometry3d::Identity(), {{Box{{0.5, 0.5, 0.5}}}}});
  EXPECT_EQ((std::vector<std::string>{"tray - arm", "tray - crate", "arm - crate"}), sampledPairs(measured));
  EXPECT_EQ(std::vector<std::string>{"tray - arm"}, sampledPairs(passive)) << "both links are above the caster";
}

TEST(WarningsOfAScene, NameABodyBeyondTheRangeInWhichAnswersAreExact)
{
  const auto robot_at = [](const std::string& metres)
  {
    return robotOf("<link name='map'/>" + boxLink("base") + boxLink("arm") +
                   jointXml("mount", "fixed", "map", "base", "<origin xyz='0 " + metres + " 0'/>") +
                   jointXml("joint", "continuous", "base", "arm", "<origin xyz='3 0 0'/><axis xyz='0 0 1'/>"));
  };
  const auto warnings = [](const PlanningScene& scene) { return warningsOfScene(scene, SceneReport()); };
  PlanningScene near(robot_at("990"));
  EXPECT_TRUE(warnings(near).empty());
  for (const PlanningScene& far : {PlanningScene(robot_at("1001")), PlanningScene(robot_at("-9e5"))})
  {
    ASSERT_EQ(1U, warnings(far).size());
    EXPECT_EQ(0U, warnings(far)[0].find("'base' is more than 1 km from the origin of the planning frame"));
  }
  near.objects.push_back({"crate", Eigen::Isometry3d(Eigen::Translation3d(0, 0, 2000)), {{Box{{1.0, 1.0, 1.0}}}}});
  ASSERT_EQ(1U, warnings(near).size());
  EXPECT_EQ(0U, warnings(near)[0].find("'crate' is more than 1 km"));

  // The base that drives there is near in the default state.
  PlanningScene driven(sliderRobotOnFloor("planar"));
  EXPECT_TRUE(warnings(driven).empty());
  driven.current_state = driven.robot->defaultState();
  driven.current_state.at(static_cast<std::size_t>(driven.robot->variableIndex("floor/x"))) = 5000.0;
  EXPECT_EQ(1U, warnings(driven).size());
}

TEST_F(SmallScene, ReportsThePairsThatCollideInEverySample)
{
  const auto pairs_of = [this](StateChecker& checker)
  {
    std::set<std::string> names;
    for (const BodyPair& pair : checker.report().colliding_in_samples)
      names.insert(scene_->bodyName(pair[0]) + " - " + scene_->bodyName(pair[1]));
    return names;
  };
  CpuChecker on_cpu(scene_);
  EXPECT_TRUE(pairs_of(on_cpu).empty());  // "way" is hit in some states only
  EXPECT_TRUE(warningsOfScene(*scene_, on_cpu.report()).empty());
  scene_ = std::make_shared<PlanningScene>(*scene_);
  scene_->objects.push_back({"plate", Eigen::Isometry3d::Identity(), {{Box{{0.5, 0.5, 0.02}}}}});
  addBox("on_mast", {0.0, 0.3, 1.0});
  // The arm hits this bar unless it turns to the right by more than 0.9 rad.
  scene_->objects.push_back(
      {"bar", Eigen::Isometry3d(Eigen::Translation3d(0.31, 0.125, 0.0)), {{Box{{0.02, 0.95, 0.02}}}}});
  const std::set<std::string> expected = {"base - plate", "arm - plate", "mast - on_mast"};
  on_cpu.setScene(scene_);
  EXPECT_EQ(pairs_of(on_cpu), expected);
  EXPECT_EQ(pairs_of(on_cpu), expected);  // the second report is the first one
  BatchCheckerOptions options;
  options.device_only = true;
  BatchChecker on_gpu(scene_, options);
  EXPECT_EQ(pairs_of(on_gpu), expected);
  const std::vector<std::string> warnings = warningsOfScene(*scene_, on_cpu.report());
  ASSERT_EQ(1U, warnings.size());
  EXPECT_EQ(0U, warnings[0].find("3 pairs in collision in each of 64 random states, so probably no state is valid: "))
      << warnings[0];
  EXPECT_NE(std::string::npos, warnings[0].find("arm - plate")) << warnings[0];
  EXPECT_NE(std::string::npos, warnings[0].find("move these bodies apart;")) << warnings[0];
  EXPECT_NE(std::string::npos, warnings[0].find("allowed_collisions: [[base, plate]]")) << warnings[0];
  EXPECT_EQ(std::string::npos, warnings[0].find("[[arm")) << "the arm need not touch the plate";
}

TEST_F(SmallScene, NamesTouchLinksOnlyIfACarriedObjectAlwaysCollides)
{
  AttachedObject held;
  held.object = {"held", Eigen::Isometry3d::Identity(), {{Box{{0.1, 0.1, 0.1}}}}};
  held.link = scene_->robot->linkIndex("arm");
  scene_->attached.push_back(held);
  const int held_body = static_cast<int>(scene_->robot->links().size() + scene_->objects.size());
  ASSERT_EQ("held", scene_->bodyName(held_body));
  SceneReport report;
  const auto warning = [&](int body)
  {
    report.colliding_in_samples = {{scene_->robot->linkIndex("base"), body}};
    const std::vector<std::string> warnings = warningsOfScene(*scene_, report);
    EXPECT_EQ(1U, warnings.size());
    return warnings.empty() ? std::string() : warnings[0];
  };
  EXPECT_NE(std::string::npos, warning(held_body).find("move these bodies apart, or name the links that hold a "
                                                       "carried object in its touch_links"));
  EXPECT_EQ(std::string::npos, warning(held_body - 1).find("touch_links"));
}

TEST_F(SmallScene, WarnsOfLinksThatAlwaysCollideWithTheToolThatAllowsThem)
{
  SceneReport report;
  report.colliding_in_samples = {{scene_->robot->linkIndex("base"), scene_->robot->linkIndex("arm")}};
  const std::vector<std::string> warnings = warningsOfScene(*scene_, report);
  ASSERT_EQ(1U, warnings.size());
  EXPECT_NE(std::string::npos, warnings[0].find("generate_acm --srdf OLD --out NEW")) << warnings[0];

  const PlanningScene without_srdf(RobotModel::fromXml(
      "<robot name='two'><link name='a'/><link name='b'/>" + jointXml("joint", "fixed", "a", "b", "") + "</robot>", "",
      {}));
  report.colliding_in_samples = {{0, 1}};
  const std::string warning = warningsOfScene(without_srdf, report).at(0);
  EXPECT_NE(std::string::npos, warning.find("generate_acm --out NEW")) << warning;
}

TEST_F(SmallScene, AsksForFixedLinksOnlyWhereTheGroupMovesThem)
{
  const auto link = [](const std::string& name, const std::string& at)
  {
    return "<link name='" + name + "'><collision><origin xyz='" + at +
           "'/><geometry><box size='1 1 1'/></geometry></collision></link>";
  };
  const auto scene = std::make_shared<const PlanningScene>(
      robotOf(link("base", "0 0 0") + link("shelf", "0.5 0 0") + link("arm", "5 0 0") +
                  jointXml("weld", "fixed", "base", "shelf") +
                  jointXml("swing", "continuous", "base", "arm", "<axis xyz='0 0 1'/>"),
              "<group name='arm'><joint name='swing'/></group>"));
  const double state = 0.0;
  CpuChecker checker(scene);
  EXPECT_EQ(checker.check(&state, 1).valid, std::vector<std::uint8_t>{0});
  EXPECT_EQ(checker.check(&state, 1, "arm").valid, std::vector<std::uint8_t>{1});
  EXPECT_EQ(checker.check(&state, 1).valid, std::vector<std::uint8_t>{0});
}

TEST_F(SmallScene, CountsPaddingWhenItLeavesOutPairs)
{
  scene_->objects[1].pose.translation().x() = 0.7;  // 0.1 m beyond the arm
  EXPECT_EQ(reportOf(kAll.reductions).unreachable_objects, 2U);
  scene_->objects[1].padding = 0.06;
  scene_->link_padding.assign(3, 0.05);
  EXPECT_EQ(reportOf(kAll.reductions).unreachable_objects, 1U);
  const double state = 0.0;
  scene_->objects.erase(scene_->objects.begin());
  EXPECT_EQ(CpuChecker(scene_).check(&state, 1).valid, std::vector<std::uint8_t>{0});
}

TEST_F(SmallScene, CountsPaddingThatGrowsBetweenScenes)
{
  scene_->objects = {scene_->objects[1]};
  scene_->objects[0].pose.translation().x() = 0.7;  // 0.1 m beyond the arm
  CpuChecker checker(scene_);
  const auto is_free = [&](double of_links, double of_object)
  {
    scene_->link_padding.assign(3, of_links);
    scene_->objects[0].padding = of_object;
    checker.setScene(std::make_shared<const PlanningScene>(*scene_));
    const double state = 0.0;
    return checker.check(&state, 1).valid[0] == 1;
  };
  EXPECT_TRUE(is_free(0.0, 0.0));
  EXPECT_FALSE(is_free(0.11, 0.0));
  EXPECT_TRUE(is_free(0.0, 0.0));
  EXPECT_FALSE(is_free(0.0, 0.11));
}
}  // namespace
}  // namespace gpu_planning_scene::core
