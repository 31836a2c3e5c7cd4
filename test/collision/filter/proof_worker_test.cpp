// While and after the proofs of a robot are made in the background, checkers answer as the exact checker does.

#include "collision/filter/proofs/proof_worker.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Translation3d;

namespace fs = std::filesystem;

constexpr std::size_t kManyStates = 25000;  // more than are checked before proofs are made
constexpr std::size_t kEvery = 10;
constexpr std::uint64_t kSeed = 43;

/// The slider robot, with a padded pole and a carried ball, among one object of each kind.
std::shared_ptr<PlanningScene> sceneOf(const std::shared_ptr<const RobotModel>& robot)
{
  auto scene = std::make_shared<PlanningScene>(robot);
  const auto add = [&scene](const std::string& id, const Shape& shape, const Isometry3d& pose) {
    scene->objects.push_back({id, pose, {{shape, Isometry3d::Identity()}}, 0.0});
  };
  const Isometry3d tilted(Eigen::AngleAxisd(0.6, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()));
  add("box", Box{{0.2, 0.3, 0.1}}, Translation3d(0.5, 0.3, 0.4) * tilted);
  add("ball", Sphere{0.15}, Isometry3d(Translation3d(-0.5, 0.2, 0.5)));
  add("can", Cylinder{0.1, 0.3}, Translation3d(0.1, -0.3, 0.5) * tilted);
  add("cone", Cone{0.1, 0.3}, Translation3d(-0.8, -0.2, 0.5) * tilted);
  add("stone", tessellate(Sphere{0.1}).mesh, Isometry3d(Translation3d(0.9, -0.1, 0.6)));
  add("floor", HalfSpace{Eigen::Vector3d::UnitZ(), -0.4}, Isometry3d::Identity());
  scene->link_padding.assign(robot->links().size(), 0.01);
  scene->attached.push_back(
      {{"load", Isometry3d(Translation3d(0.3, 0.0, 0.0)), {{Sphere{0.08}, Isometry3d::Identity()}}, 0.0},
       robot->linkIndex("pole")});
  return scene;
}

/// The same neighbourhood for each state.
JointNeighbourhood around(const RobotModel& robot, std::size_t count)
{
  return {std::vector<JointTravel>(robot.joints().size(), {0.005, 0.02}), std::vector<std::uint32_t>(count, 0)};
}

/// The verdicts of every tenth state, one state at a time: so the exact checker decides them alone.
std::vector<std::uint8_t> exactVerdicts(const std::shared_ptr<const PlanningScene>& scene,
                                        const std::vector<double>& states, bool with_margins)
{
  CpuChecker checker(scene);
  const std::size_t width = scene->robot->variables().size();
  const JointNeighbourhood neighbourhood = around(*scene->robot, 1);
  std::vector<std::uint8_t> valid;
  for (std::size_t i = 0; i < states.size(); i += kEvery * width)
    valid.push_back(checker.check(states.data() + i, 1, "", with_margins ? &neighbourhood : nullptr).valid[0]);
  return valid;
}

void expectVerdicts(const std::vector<std::uint8_t>& expected, const std::vector<std::uint8_t>& valid)
{
  for (std::size_t i = 0; i < expected.size(); ++i)
    ASSERT_EQ(valid.at(kEvery * i), expected[i]) << "state " << kEvery * i << ", seed " << kSeed;
}

void compare(const std::shared_ptr<const RobotModel>& robot)
{
  const auto scene = sceneOf(robot);
  std::mt19937_64 generator(kSeed);
  std::vector<double> states(kManyStates * robot->variables().size());
  for (std::size_t i = 0; i < kManyStates; ++i)
    robot->randomState(generator, states.data() + i * robot->variables().size());
  const std::vector<std::uint8_t> exact = exactVerdicts(scene, states, false);
  const std::vector<std::uint8_t> exact_near = exactVerdicts(scene, states, true);
  const auto free = std::count(exact.begin(), exact.end(), 1);
  EXPECT_GT(free, static_cast<std::ptrdiff_t>(exact.size() / 20));
  EXPECT_LT(free, static_cast<std::ptrdiff_t>(exact.size() * 19 / 20));
  EXPECT_LT(std::count(exact_near.begin(), exact_near.end(), 1), free);
  CpuChecker checker(scene);
  const JointNeighbourhood neighbourhood = around(*robot, kManyStates);
  for (int round = 0; round < 3; ++round)
  {
    SCOPED_TRACE("round " + std::to_string(round));
    expectVerdicts(exact, checker.check(states.data(), kManyStates).valid);
    expectVerdicts(exact_near, checker.check(states.data(), kManyStates, "", &neighbourhood).valid);
    if (round == 1)  // the second round has started to make the proofs
      waitForProofs();
  }
  std::uint64_t decided = 0;
  std::uint64_t alone = 0;
  for (const DecidedStates& stage : checker.report().decided)
  {
    decided += stage.states;
    alone += stage.by == "the exact checker alone" ? stage.states : 0;
  }
  EXPECT_EQ(decided, 6 * kManyStates);
  EXPECT_LT(alone, 5 * kManyStates);
  EXPECT_GE(alone, 16384u);
}

TEST(ProofWorker, ChangesNoVerdictOfCheckersInSeveralThreads)
{
  setenv("GPU_PLANNING_SCENE_PROOF_CACHE", "off", 1);
  std::vector<std::thread> threads;
  threads.emplace_back([] { compare(sliderRobot()); });
  threads.emplace_back([] { compare(sliderRobotOnFloor("planar")); });
  threads.emplace_back([] { compare(sliderRobotOnFloor("floating")); });
  for (std::thread& thread : threads)
    thread.join();
}

/// A user's cache folder of a test.
class CacheOfATest
{
 public:
  CacheOfATest()
  {
    std::string name = (fs::temp_directory_path() / "gpu_planning_scene_worker_XXXXXX").string();
    EXPECT_NE(mkdtemp(name.data()), nullptr);
    home_ = name;
    if (const char* const before = std::getenv("XDG_CACHE_HOME"))
      before_ = before;
    setenv("XDG_CACHE_HOME", name.c_str(), 1);
    unsetenv("GPU_PLANNING_SCENE_PROOF_CACHE");
  }
  ~CacheOfATest()
  {
    setenv("GPU_PLANNING_SCENE_PROOF_CACHE", "off", 1);
    setenv("XDG_CACHE_HOME", before_.c_str(), 1);
    fs::remove_all(home_);
  }
  CacheOfATest(const CacheOfATest&) = delete;
  CacheOfATest& operator=(const CacheOfATest&) = delete;

  std::vector<fs::path> files() const
  {
    const fs::path folder = home_ / "gpu_planning_scene" / "proofs";
    if (!fs::exists(folder))
      return {};
    return {fs::directory_iterator(folder), fs::directory_iterator{}};
  }
  /// Makes all files an hour old.
  void age() const
  {
    for (const fs::path& file : files())
      fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(1));
  }
  /// Whether all files were loaded since they were aged.
  bool isUsed() const
  {
    const auto recent = fs::file_time_type::clock::now() - std::chrono::minutes(30);
    const std::vector<fs::path> all = files();
    return !all.empty() && std::all_of(all.begin(), all.end(),
                                       [&](const fs::path& file) { return fs::last_write_time(file) > recent; });
  }

 private:
  fs::path home_;
  std::string before_;
};

/// A checker in a new process: nobody else has its robot and its trees.
struct FreshChecker
{
  std::shared_ptr<const RobotModel> robot = sliderRobot();
  CpuChecker checker{sceneOf(robot)};
};

TEST(ProofWorker, HasNothingToDoForACheckerWithoutProofs)
{
  const CacheOfATest cache;
  CheckerOptions options;
  options.reductions.proofs = false;
  const std::shared_ptr<const RobotModel> robot = sliderRobot();
  CpuChecker checker(sceneOf(robot), options);
  std::mt19937_64 generator(kSeed);
  std::vector<double> states(kManyStates * robot->variables().size());
  for (std::size_t i = 0; i < kManyStates; ++i)
    robot->randomState(generator, states.data() + i * robot->variables().size());
  checker.check(states.data(), kManyStates);
  checker.check(states.data(), kManyStates);
  waitForProofs();
  EXPECT_TRUE(cache.files().empty());
  const std::vector<DecidedStates> decided = checker.report().decided;
  ASSERT_EQ(decided.size(), 1U);
  EXPECT_EQ(decided[0].states, 2 * kManyStates);
}

TEST(ProofWorker, LoadsProofsForTheFirstLargeBatchAndMakesNone)
{
  const CacheOfATest cache;
  std::mt19937_64 generator(kSeed);
  std::vector<double> states(kManyStates * sliderRobot()->variables().size());
  for (std::size_t i = 0; i < kManyStates; ++i)
    sliderRobot()->randomState(generator, states.data() + i * 2);
  const auto check = [&states](FreshChecker& fresh, std::size_t count)
  {
    const std::vector<std::uint8_t> valid = fresh.checker.check(states.data(), count).valid;
    waitForProofs();
    return valid;
  };
  std::vector<std::uint8_t> exact;
  {
    FreshChecker fresh;
    check(fresh, 5000);
    check(fresh, 15000);
    EXPECT_TRUE(cache.files().empty()) << "before 20,000 states, no proof is made";
    exact = check(fresh, kManyStates);
    EXPECT_FALSE(cache.files().empty());
  }
  const std::size_t files = cache.files().size();
  {
    FreshChecker fresh;
    cache.age();
    check(fresh, 64);
    for (int i = 0; i < 9; ++i)
      check(fresh, 1);
    EXPECT_FALSE(cache.isUsed()) << "few states need no proofs";
    check(fresh, 65);
    EXPECT_TRUE(cache.isUsed());
    std::vector<std::uint8_t> valid = check(fresh, 5000);
    EXPECT_EQ(valid, std::vector<std::uint8_t>(exact.begin(), exact.begin() + 5000));
  }
  {
    FreshChecker fresh;
    cache.age();
    for (int i = 0; i < 15; ++i)
      check(fresh, 64);
    EXPECT_FALSE(cache.isUsed());
    check(fresh, 64);
    EXPECT_TRUE(cache.isUsed()) << "after 1,000 states";
  }
  fs::remove(cache.files().at(0));
  FreshChecker fresh;
  EXPECT_EQ(check(fresh, kManyStates - 6000), std::vector<std::uint8_t>(exact.begin(), exact.end() - 6000));
  EXPECT_EQ(cache.files().size(), files - 1) << "before 20,000 states, the missing proof is not made";
  check(fresh, 6000);
  check(fresh, 6000);
  EXPECT_EQ(cache.files().size(), files);
}
}  // namespace
}  // namespace gpu_planning_scene::core
