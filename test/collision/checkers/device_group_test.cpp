// Several devices answer like one, also if some of them are lost.

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "collision/checkers/device_group.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "model/model_testing.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
using Scene = std::shared_ptr<const PlanningScene>;

/// A CPU checker that is lost at its check number `lost_at` (from 0; negative: never), and counts its states. With
/// `only_counts`, it checks nothing and calls all states free.
class LosableChecker : public CpuChecker
{
 public:
  LosableChecker(const Scene& scene, int lost_at) : CpuChecker(scene), left_(lost_at) {}

  BatchResult check(const double* states, std::size_t count, const std::string& group,
                    const JointNeighbourhood* around) override
  {
    if (left_-- == 0)
      throw DeviceLost("the test has switched it off");
    checked += count;
    batches.push_back(count);
    if (only_counts)
      return allFree(count);
    return CpuChecker::check(states, count, group, around);
  }

  SceneReport report(const std::string& group) override
  {
    if (lost_in_report)
      throw DeviceLost("the test has switched it off");
    return CpuChecker::report(group);
  }

  void setScene(Scene scene) override
  {
    if (scene->revision == refused)
      throw Error("the scene is too large for this device");
    CpuChecker::setScene(std::move(scene));
  }

  std::size_t checked = 0;
  bool only_counts = false;
  bool lost_in_report = false;
  std::vector<std::size_t> batches;           // the numbers of states of all checks
  std::uint64_t refused = ~std::uint64_t{0};  // revision of a scene that the device does not take

 private:
  static BatchResult allFree(std::size_t count)
  {
    BatchResult result;
    result.valid.assign(count, 1);
    result.colliding.assign(count, kNoPair);
    return result;
  }

  int left_;
};

class DeviceGroups : public testing::Test
{
 protected:
  static constexpr std::size_t kCount = 50'000;  // a share for each of two or three devices

  /// Devices that are lost at these checks; -1: never.
  std::unique_ptr<DeviceGroup> groupOf(const std::vector<int>& lost_at)
  {
    checkers_.clear();
    std::vector<std::string> names;
    for (const int check : lost_at)
      names.push_back(std::to_string(check));
    return std::make_unique<DeviceGroup>(scene_, names,
                                         [this](const Scene& scene, const std::string& name)
                                         {
                                           auto made = std::make_unique<LosableChecker>(scene, std::stoi(name));
                                           checkers_.push_back(made.get());
                                           return made;
                                         });
  }

  static std::vector<double> randomStates(const RobotModel& robot)
  {
    std::mt19937_64 generator(3);
    std::vector<double> states(kCount * robot.variables().size());
    for (std::size_t i = 0; i < states.size(); i += robot.variables().size())
      robot.randomState(generator, states.data() + i);
    return states;
  }

  Scene scene_ = std::make_shared<PlanningScene>(sliderAndWall());
  std::size_t width_ = scene_->robot->variables().size();
  std::vector<double> states_ = randomStates(*scene_->robot);
  BatchResult expected_ = CpuChecker(scene_).check(states_.data(), kCount);
  std::vector<LosableChecker*> checkers_;
};

TEST_F(DeviceGroups, ShareTheStatesOfALargeBatch)
{
  const auto group = groupOf({-1, -1});
  std::size_t batches = 0;
  // On a busy machine, one thread may check a whole batch before the other one starts.
  while (batches < 100 && (checkers_[0]->checked == 0 || checkers_[1]->checked == 0))
  {
    const BatchResult result = group->check(states_.data(), kCount);
    EXPECT_EQ(result.valid, expected_.valid);
    EXPECT_EQ(result.revision, expected_.revision);
    ++batches;
  }
  EXPECT_GT(checkers_[0]->checked, 0u);
  EXPECT_GT(checkers_[1]->checked, 0u);
  EXPECT_EQ(checkers_[0]->checked + checkers_[1]->checked, batches * kCount);
  EXPECT_EQ(group->deviceName(), "CPU + CPU");
  EXPECT_EQ(group->deviceWarning(), "");
  std::uint64_t decided = 0;
  for (const DecidedStates& stage : group->report().decided)
    decided += stage.states;
  EXPECT_EQ(decided, batches * kCount);
}

/// A small share takes a GPU nearly as long as a larger one.
TEST_F(DeviceGroups, CutABatchIntoLargeShares)
{
  std::vector<double> states = states_;
  for (int doubled = 0; doubled < 6; ++doubled)
    states.insert(states.end(), states.begin(), states.begin() + static_cast<std::ptrdiff_t>(states.size()));
  const auto shares_of = [&](std::size_t count)
  {
    const auto group = groupOf({-1, -1});
    for (LosableChecker* const checker : checkers_)
      checker->only_counts = true;
    EXPECT_EQ(group->check(states.data(), count).valid, std::vector<std::uint8_t>(count, 1));
    std::vector<std::size_t> shares = checkers_[0]->batches;
    shares.insert(shares.end(), checkers_[1]->batches.begin(), checkers_[1]->batches.end());
    std::sort(shares.begin(), shares.end());
    return shares;
  };
  EXPECT_EQ(shares_of(10'000), (std::vector<std::size_t>{10'000}));
  EXPECT_EQ(shares_of(40'001), (std::vector<std::size_t>{20'000, 20'001}));
  EXPECT_EQ(shares_of(100'000), (std::vector<std::size_t>{50'000, 50'000}));
  EXPECT_EQ(shares_of(131'073), (std::vector<std::size_t>{65'536, 65'537})) << "no share of one state";
  EXPECT_EQ(shares_of(200'000), (std::vector<std::size_t>{66'666, 66'667, 66'667}));
  EXPECT_EQ(shares_of(1'000'000), std::vector<std::size_t>(8, 125'000)) << "four for each device";
  EXPECT_EQ(shares_of(2'400'000), std::vector<std::size_t>(10, 240'000)) << "no share is too large";
}

TEST_F(DeviceGroups, LoseNoStateIfDevicesAreLost)
{
  for (const auto& [lost_at, left] : {std::pair(std::vector{0, -1}, 1), std::pair(std::vector{-1, 1, 0}, 1),
                                      std::pair(std::vector{0, 0, -1}, 1), std::pair(std::vector{1, -1, -1}, 2)})
  {
    const auto group = groupOf(lost_at);
    const std::string names = left == 1 ? "CPU" : "CPU + CPU";
    for (int batches = 0; batches < 100 && group->deviceName() != names; ++batches)
      EXPECT_EQ(group->check(states_.data(), kCount).valid, expected_.valid);
    EXPECT_EQ(group->deviceName(), names);
    EXPECT_EQ(group->check(states_.data(), kCount).valid, expected_.valid);
    EXPECT_NE(group->deviceWarning().find("was lost: the test has switched it off"), std::string::npos);
  }
}

TEST_F(DeviceGroups, ReportWithoutADeviceThatIsLostMeanwhile)
{
  const auto group = groupOf({-1, -1});
  checkers_[0]->lost_in_report = true;
  EXPECT_EQ(group->report().world_pairs, CpuChecker(scene_).report().world_pairs);
  EXPECT_EQ(group->deviceName(), "CPU");
  EXPECT_EQ(group->check(states_.data(), kCount).valid, expected_.valid);
}

TEST_F(DeviceGroups, AreLostIfNoDeviceIsLeft)
{
  const auto group = groupOf({0, 1});
  EXPECT_THROW(group->check(states_.data(), kCount), DeviceLost);
  EXPECT_THROW(group->check(states_.data(), kCount), DeviceLost);
  EXPECT_THROW(group->setScene(scene_), DeviceLost);
  EXPECT_THROW(group->report(), DeviceLost);
}

TEST_F(DeviceGroups, NameTheStateOfTheWholeBatchInErrors)
{
  const auto group = groupOf({-1, -1});
  states_[30'000 * width_ + 1] = NAN;
  EXPECT_NE(errorOf([&] { group->check(states_.data(), kCount); }).find("state 30000"), std::string::npos);
  EXPECT_NE(errorOf([&] { group->check(states_.data(), kCount, "no group"); }), "");
}

TEST_F(DeviceGroups, KeepTheOldSceneOnAllDevicesIfOneRefusesTheNewOne)
{
  const auto group = groupOf({-1, -1});
  auto empty = std::make_shared<PlanningScene>(scene_->robot);
  empty->revision = 77;
  checkers_[1]->refused = 77;
  EXPECT_EQ(errorOf([&] { group->setScene(empty); }), "the scene is too large for this device");
  EXPECT_EQ(group->check(states_.data(), kCount).valid, expected_.valid);
  EXPECT_EQ(group->deviceName(), "CPU + CPU");
  checkers_[1]->refused = 78;
  group->setScene(empty);
  const BatchResult result = group->check(states_.data(), kCount);
  EXPECT_EQ(result.revision, 77u);
  EXPECT_EQ(result.valid, CpuChecker(empty).check(states_.data(), kCount).valid);
}

TEST_F(DeviceGroups, DropADeviceThatDoesNotTakeTheOldSceneAgain)
{
  const auto group = groupOf({-1, -1, -1});
  auto empty = std::make_shared<PlanningScene>(scene_->robot);
  empty->revision = 77;
  checkers_[0]->refused = scene_->revision;
  checkers_[1]->refused = 77;
  EXPECT_EQ(errorOf([&] { group->setScene(empty); }), "the scene is too large for this device");
  EXPECT_EQ(group->deviceName(), "CPU + CPU");
  EXPECT_NE(group->deviceWarning().find("it has not taken the old scene again"), std::string::npos);
  const BatchResult result = group->check(states_.data(), kCount);
  EXPECT_EQ(result.valid, expected_.valid);
  EXPECT_EQ(result.revision, scene_->revision);
}

TEST_F(DeviceGroups, DropADeviceThatAnswersForAnotherScene)
{
  const auto group = groupOf({-1, -1});
  auto empty = std::make_shared<PlanningScene>(scene_->robot);
  empty->revision = 77;
  checkers_[0]->setScene(empty);
  for (int batches = 0; batches < 100 && group->deviceName() != "CPU"; ++batches)
    EXPECT_EQ(group->check(states_.data(), kCount).valid, expected_.valid);
  EXPECT_NE(group->deviceWarning().find("another revision"), std::string::npos);
}

TEST_F(DeviceGroups, AreSelectedByNamesWithPlusBetweenThem)
{
  EXPECT_EQ(devicesOf("0"), std::vector<std::string>{"0"});
  EXPECT_EQ(devicesOf("0+software"), (std::vector<std::string>{"0", "software"}));
  for (const char* selection : {"", "0+", "+0", "0++1"})
    EXPECT_NE(errorOf([&] { devicesOf(selection); }).find("empty part"), std::string::npos) << selection;
}

TEST_F(DeviceGroups, KeepTheNeighbourhoodOfEachState)
{
  const std::size_t joints = scene_->robot->joints().size();
  JointNeighbourhood around;
  for (std::size_t row = 0; row < 5; ++row)
    around.travel.insert(around.travel.end(), joints, JointTravel{0.0, 0.01 * static_cast<double>(row)});
  for (std::uint32_t i = 0; i < kCount; ++i)
    around.rows.push_back(i * 7 % 5);
  const std::vector<std::uint8_t> one = CpuChecker(scene_).check(states_.data(), kCount, "", &around).valid;
  EXPECT_NE(one, expected_.valid);
  EXPECT_EQ(groupOf({-1, -1, -1})->check(states_.data(), kCount, "", &around).valid, one);
  around.rows.clear();
  EXPECT_TRUE(groupOf({-1, -1})->check(nullptr, 0, "", &around).valid.empty());
}
}  // namespace
}  // namespace gpu_planning_scene::core
