// Proofs are loaded from the user's cache when a checker has many states, and made when it has very many.

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <random>

#include <gtest/gtest.h>

#include "collision/proofs/proof_scene.h"
#include "collision/proofs/proof_worker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace fs = std::filesystem;

constexpr std::size_t kManyStates = 25000;  // more than are checked before proofs are made

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
    if (before_.empty())
      unsetenv("XDG_CACHE_HOME");
    else
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
  FreshChecker() : robot(sliderRobot()), checker(proofScene(robot)) {}

  std::shared_ptr<const RobotModel> robot;
  CpuChecker checker;
};

TEST(ProofLoading, IsLeftOutForACheckerWithoutProofs)
{
  const CacheOfATest cache;
  CheckerOptions options;
  options.reductions.proofs = false;
  const std::shared_ptr<const RobotModel> robot = sliderRobot();
  CpuChecker checker(proofScene(robot), options);
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

TEST(ProofLoading, BeginsWithTheFirstLargeBatchAndMakesNoProofs)
{
  const CacheOfATest cache;
  std::mt19937_64 generator(kSeed);
  const std::shared_ptr<const RobotModel> robot = sliderRobot();
  std::vector<double> states(kManyStates * robot->variables().size());
  for (std::size_t i = 0; i < kManyStates; ++i)
    robot->randomState(generator, states.data() + i * robot->variables().size());
  const auto check = [&states](FreshChecker& fresh, std::size_t count)
  {
    std::vector<std::uint8_t> valid = fresh.checker.check(states.data(), count).valid;
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

TEST(ProofLoading, ProofsAreUsedOnceASceneHasMoreThanSixteenStates)
{
  const CacheOfATest cache;
  FreshChecker fresh;
  std::mt19937_64 generator(kSeed);
  std::vector<double> states(kManyStates * fresh.robot->variables().size());
  for (std::size_t i = 0; i < states.size(); i += 2)
    fresh.robot->randomState(generator, states.data() + i);
  fresh.checker.check(states.data(), kManyStates);
  waitForProofs();
  const auto stages = [&fresh]
  {
    std::vector<std::string> names;
    for (const DecidedStates& decided : fresh.checker.report().decided)
      if (decided.states != 0)
        names.push_back(decided.by);
    return names;
  };
  fresh.checker.setScene(proofScene(fresh.robot));
  const auto check_eight = [&]
  {
    fresh.checker.check(states.data(), 8);
    waitForProofs();
  };
  check_eight();
  check_eight();
  EXPECT_EQ(stages(), std::vector<std::string>{"the exact checker alone"}) << "16 states request no proofs";
  check_eight();
  check_eight();
  EXPECT_GT(stages().size(), 1U);
}
}  // namespace
}  // namespace gpu_planning_scene::core
