// The validity checker gives the StateChecker's answers for states within bounds and checks each state once. Variables
// outside the group have their values in the scene.

#include <cmath>
#include <iostream>
#include <mutex>
#include <random>
#include <thread>

#include <gtest/gtest.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/planning/state_validity_checker.h"
#include "model/model_testing.h"
#include "scene/slider_robot.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;
using Row = std::vector<double>;

/// Answers as CpuChecker and records the calls.
class RecordingChecker : public StateChecker
{
 public:
  explicit RecordingChecker(std::shared_ptr<const PlanningScene> scene) : checker_(std::move(scene)) {}

  void setScene(std::shared_ptr<const PlanningScene> scene) override { checker_.setScene(std::move(scene)); }
  BatchResult checkBatch(const StateBatch& batch) override
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    batches.push_back(batch.count);
    groups.push_back(batch.group);
    return checker_.checkBatch(batch);
  }
  SceneReport report(const std::string& group) override { return checker_.report(group); }
  std::string deviceName() const override { return "recorder"; }

  std::vector<std::size_t> batches;  // number of states in each check
  std::vector<std::string> groups;

 private:
  std::mutex mutex_;
  CpuChecker checker_;
};

/// A wall from x = 0.9 to 1.1 m, which the cart can hit, and a lamp that the pole hits when the cart is at x = -1 m.
std::shared_ptr<PlanningScene> wallAndLamp(std::shared_ptr<const RobotModel> robot)
{
  auto scene = std::make_shared<PlanningScene>(std::move(robot));
  const auto at = [](double x, double z) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0.0, z)); };
  scene->objects.push_back({"wall", at(1.0, 0.0), {{Box{{0.2, 1.0, 0.2}}}}});
  scene->objects.push_back({"lamp", at(-1.0, 0.5), {{Sphere{0.1}}}});
  return scene;
}

/// The objects for planning for a group of a scene.
struct GroupPlanning
{
  explicit GroupPlanning(std::shared_ptr<const PlanningScene> the_scene, const std::string& group)
    : scene(std::move(the_scene)),
      space(std::make_shared<GroupStateSpace>(scene->robot, group)),
      information(std::make_shared<ob::SpaceInformation>(space)),
      checker(std::make_shared<RecordingChecker>(scene)),
      validity(std::make_shared<StateValidityChecker>(information, scene, checker))
  {
    information->setStateValidityChecker(validity);
    information->setup();
  }

  ob::ScopedState<> stateOf(const Row& row) const
  {
    ob::ScopedState<> state(space);
    space->copyFromRow(row.data(), state.get());
    return state;
  }

  /// The state with these values, for a group whose joints all have limits.
  ob::ScopedState<> joints(const Row& values) const
  {
    ob::ScopedState<> state(space);
    for (std::size_t i = 0; i < values.size(); ++i)
      state[static_cast<unsigned int>(i)] = values[i];
    return state;
  }

  bool isValid(const Row& values) const { return information->isValid(joints(values).get()); }

  std::vector<std::uint8_t> validate(const std::vector<Row>& states) const
  {
    std::vector<ob::ScopedState<>> kept;
    std::vector<const ob::State*> pointers;
    for (const Row& values : states)
      kept.push_back(joints(values));
    for (const ob::ScopedState<>& state : kept)
      pointers.push_back(state.get());
    return validity->validateStates(pointers);
  }

  std::shared_ptr<const PlanningScene> scene;
  std::shared_ptr<GroupStateSpace> space;
  ob::SpaceInformationPtr information;
  std::shared_ptr<RecordingChecker> checker;
  std::shared_ptr<StateValidityChecker> validity;
};

/// Expects the answers of a CpuChecker for `rows`, in bulk and one by one. Variables outside the group must have their
/// values in the scene.
void expectCheckersAnswers(const GroupPlanning& planning, const std::vector<Row>& rows)
{
  CpuChecker peer(planning.scene);
  std::vector<ob::ScopedState<>> states;
  std::vector<const ob::State*> pointers;
  for (const Row& row : rows)
    states.push_back(planning.stateOf(row));
  for (const ob::ScopedState<>& state : states)
    pointers.push_back(state.get());
  const std::vector<std::uint8_t> bulk = planning.validity->validateStates(pointers);
  ASSERT_EQ(bulk.size(), rows.size());
  std::size_t valid = 0;
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    const std::uint8_t expected = peer.check(rows[i].data(), 1, planning.space->group().name).valid[0];
    EXPECT_EQ(bulk[i], expected) << "state " << i;
    EXPECT_EQ(planning.information->isValid(pointers[i]), expected != 0) << "state " << i;
    valid += expected;
  }
  std::cout << valid << " of " << rows.size() << " states are valid\n";
  EXPECT_GT(valid, rows.size() / 20);
  EXPECT_LT(valid, rows.size() - rows.size() / 20);
  EXPECT_EQ(planning.validity->statesChecked(), 2 * rows.size());
}

class ValidityOnFloors : public testing::TestWithParam<const char*>
{
};

TEST_P(ValidityOnFloors, AnswersAreThoseOfTheChecker)
{
  const unsigned seed = 23;
  std::cout << "seed " << seed << '\n';
  std::mt19937_64 generator(seed);
  std::string srdf = sliderSrdf();
  srdf.insert(srdf.find("</robot>"), std::string("<virtual_joint name=\"floor\" type=\"") + GetParam() + R"("
    parent_frame="hall" child_link="rail"/>
    <group name="everything"><joint name="floor"/><joint name="slide"/><joint name="turn"/></group>)");
  const auto scene = wallAndLamp(RobotModel::fromXml(sliderUrdf(), srdf, {}));
  scene->objects.push_back({"dome", Eigen::Isometry3d::Identity(), {{Sphere{0.9}}}});
  const GroupPlanning planning(scene, "everything");
  std::vector<Row> rows(400, Row(planning.scene->robot->variables().size()));
  for (Row& row : rows)
    planning.scene->robot->randomState(generator, row.data());
  expectCheckersAnswers(planning, rows);
}

INSTANTIATE_TEST_SUITE_P(All, ValidityOnFloors, testing::Values("planar", "floating"),
                         [](const auto& floor) { return std::string(floor.param); });

TEST(StateValidityChecker, AnswersForUr5AreThoseOfTheChecker)
{
  const std::string name = "ur5_bookshelf_small";
  if (const std::string missing = missingFor(name); !missing.empty())
    GTEST_SKIP() << missing << " is not there";
  const std::uint64_t seed = 5;
  std::cout << "seed " << seed << '\n';
  const TestScene& made = testScene(name);
  const GroupPlanning planning(made.scene, "manipulator");
  const std::size_t count = 200;
  const Row random = made.randomStates(count, seed);
  const Row reference =
      made.scene->current_state.empty() ? made.scene->robot->defaultState() : made.scene->current_state;
  std::vector<Row> rows(count, reference);
  for (std::size_t i = 0; i < count; ++i)
    for (const int variable : planning.space->group().variables)
      rows[i][variable] = random[i * reference.size() + variable];
  expectCheckersAnswers(planning, rows);
}

TEST(StateValidityChecker, AllStatesAreCheckedInOneCallForTheGroup)
{
  const GroupPlanning planning(wallAndLamp(sliderRobot()), "drive");
  EXPECT_EQ(planning.validate({{0, 0}, {1, 0}, {-1, 0}, {-0.5, 2}}), (std::vector<std::uint8_t>{1, 0, 0, 1}));
  EXPECT_EQ(planning.checker->batches, std::vector<std::size_t>{4});
  EXPECT_EQ(planning.checker->groups, std::vector<std::string>{"drive"});
  EXPECT_EQ(planning.validity->statesChecked(), 4U);
  EXPECT_TRUE(planning.validate({}).empty());
  EXPECT_EQ(planning.checker->batches.size(), 1U);
}

TEST(StateValidityChecker, StatesOutOfBoundsAreInvalidAndNotChecked)
{
  const GroupPlanning planning(wallAndLamp(sliderRobot()), "drive");
  EXPECT_EQ(planning.validate({{2.5, 0}, {0, 0}, {0, -3.5}, {1, 0}, {0.5, 1}}),
            (std::vector<std::uint8_t>{0, 1, 0, 0, 1}));
  EXPECT_EQ(planning.checker->batches, std::vector<std::size_t>{3});
  EXPECT_FALSE(planning.isValid({-2.5, 0}));
  EXPECT_EQ(planning.checker->batches.size(), 1U);
  EXPECT_EQ(planning.validity->statesChecked(), 3U);
}

TEST(StateValidityChecker, ValuesThatAreNotFiniteAreInvalidAndLeaveTheOthersTheirAnswers)
{
  const GroupPlanning planning(wallAndLamp(sliderRobot()), "drive");
  EXPECT_EQ(planning.validate({{std::nan(""), 0}, {0, 0}, {0, std::nan("")}, {HUGE_VAL, 0}, {1, 0}}),
            (std::vector<std::uint8_t>{0, 1, 0, 0, 0}));
  EXPECT_EQ(planning.checker->batches, std::vector<std::size_t>{2});
}

TEST(StateValidityChecker, OtherVariablesAreAsInTheCurrentStateOrDefault)
{
  const auto scene = wallAndLamp(sliderRobot());
  EXPECT_TRUE(GroupPlanning(scene, "mast").isValid({0.5}));
  scene->current_state = {-1.0, 0.0};
  EXPECT_FALSE(GroupPlanning(scene, "mast").isValid({0.5})) << "the pole is in the lamp";
  scene->current_state = {1.0, 0.0};
  EXPECT_TRUE(GroupPlanning(scene, "mast").isValid({0.5})) << "the group does not move the cart, which is in the wall";
}

TEST(StateValidityChecker, ClearanceIsWhatIsLeftBeyondTheRequiredDistance)
{
  const auto scene = wallAndLamp(sliderRobot());
  const GroupPlanning planning(scene, "drive");
  EXPECT_EQ(planning.validity->getSpecs().clearanceComputationType, ob::StateValidityCheckerSpecs::EXACT);
  EXPECT_NEAR(planning.validity->clearance(planning.joints({0.3, 0}).get()), 0.5, 2e-6);
  EXPECT_NEAR(planning.validity->clearance(planning.joints({-0.5, 0}).get()), 0.35, 2e-6);
  EXPECT_EQ(planning.validity->clearance(planning.joints({1, 0}).get()), 0.0);
  double distance = -1.0;
  EXPECT_TRUE(planning.validity->isValid(planning.joints({0.5, 0}).get(), distance));
  EXPECT_NEAR(distance, 0.3, 2e-6);

  const auto padded = std::make_shared<PlanningScene>(*scene);
  padded->link_padding.assign(padded->robot->links().size(), 0.05);
  const GroupPlanning padded_planning(padded, "drive");
  EXPECT_NEAR(padded_planning.validity->clearance(padded_planning.joints({0.3, 0}).get()), 0.45, 2e-6);
}

TEST(StateValidityChecker, ClearanceIsToTheRobotItselfToo)
{
  const auto scene = wallAndLamp(sliderRobot());
  scene->objects.clear();
  scene->allowed_collisions = AllowedCollisionMatrix();
  const GroupPlanning planning(scene, "mast");
  EXPECT_NEAR(planning.validity->clearance(planning.joints({0.0}).get()), 0.2, 2e-6);
}

TEST(StateValidityChecker, ThreadsGetTheSameAnswers)
{
  const GroupPlanning planning(wallAndLamp(sliderRobot()), "drive");
  std::vector<std::size_t> right(4, 0);
  std::vector<std::thread> threads;
  for (std::size_t& mine : right)
    threads.emplace_back(
        [&]
        {
          for (int i = 0; i < 25; ++i)
          {
            const double slide = 0.02 * i + 0.55;
            const ob::ScopedState<> state = planning.joints({slide, 0});
            const bool valid = planning.validity->isValid(state.get());
            mine += valid == (slide < 0.8) && (planning.validity->clearance(state.get()) > 0.0) == valid ? 1 : 0;
          }
        });
  for (std::thread& thread : threads)
    thread.join();
  EXPECT_EQ(right, std::vector<std::size_t>(4, 25));
  EXPECT_EQ(planning.validity->statesChecked(), 100U);
}

TEST(StateValidityChecker, SpacesOfOtherKindsAndRobotsAreRefused)
{
  const auto scene = wallAndLamp(sliderRobot());
  const auto refusal = [&](const ob::StateSpacePtr& space)
  {
    return errorOf(
        [&]
        {
          StateValidityChecker(std::make_shared<ob::SpaceInformation>(space), scene,
                               std::make_shared<RecordingChecker>(scene));
        });
  };
  const auto plain = std::make_shared<ob::RealVectorStateSpace>(2);
  plain->setName("plain");
  EXPECT_NE(refusal(plain).find("'plain' is not a GroupStateSpace"), std::string::npos) << refusal(plain);
  const auto other = std::make_shared<GroupStateSpace>(sliderRobot(), "drive");
  EXPECT_NE(refusal(other).find("'drive' is for another robot"), std::string::npos) << refusal(other);
  EXPECT_EQ(refusal(std::make_shared<GroupStateSpace>(scene->robot, "drive")), "");
}
}  // namespace
}  // namespace gpu_planning_scene::core
