#include <gtest/gtest.h>

#include "model/joint_limits.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
/// A revolute joint "arm" and a prismatic joint "lift", from -1 to 2, and a continuous joint "pan".
class LimitedJoints : public testing::Test
{
 public:
  std::optional<ValueOutsideLimits> find(const std::vector<double>& rows) const
  {
    return findValueOutsideLimits(*robot, {robot->variableIndex("arm"), robot->variableIndex("lift")}, rows.data(),
                                  rows.size() / 2);
  }

  std::shared_ptr<const RobotModel> robot = robotOf(
      boxLink("base") + boxLink("a") + boxLink("b") + boxLink("c") + jointXml("arm", "revolute", "base", "a", kLimits) +
      jointXml("lift", "prismatic", "a", "b", kLimits) + jointXml("pan", "continuous", "b", "c"));
};

TEST_F(LimitedJoints, ValuesWithinThemGiveNoLine)
{
  EXPECT_FALSE(find({-1.0, 2.0, 2.0 + 1e-7, -1.0 - 1e-7}));
  const std::vector<double> turns = {100.0};
  EXPECT_FALSE(findValueOutsideLimits(*robot, {robot->variableIndex("pan")}, turns.data(), 1));
}

TEST_F(LimitedJoints, TheFirstValueOutsideThemIsNamedAndTheOthersAreCounted)
{
  const auto found = find({0.0, 0.0, 0.0, 2.5, -300.0, 0.0, 0.0, -2.0});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->row, 1u);
  EXPECT_EQ(found->text, "joint 'lift' is 2.5, outside its limits -1 to 2; 2 more values are outside the limits");
}

TEST_F(LimitedJoints, AValueHardlyOutsideThemHasEnoughDigits)
{
  ValuesOutsideLimits outside(*robot);
  outside.add(robot->variableIndex("lift"), 2.0 + 1e-7);
  EXPECT_EQ(outside.text(), "joint 'lift' is 2.0000000999999998, outside its limits -1 to 2");
}

TEST_F(LimitedJoints, DegreesAreSuggestedForAnglesThatTheyWouldFit)
{
  EXPECT_EQ(find({90.0, 0.0})->text,
            "joint 'arm' is 90, outside its limits -1 to 2 rad; values are in radians, and 90 degrees are 1.5708 rad");
  EXPECT_EQ(find({2.5, 0.0})->text, "joint 'arm' is 2.5, outside its limits -1 to 2 rad") << "hardly degrees";
  EXPECT_EQ(find({-300.0, 0.0})->text, "joint 'arm' is -300, outside its limits -1 to 2 rad");
  EXPECT_EQ(find({0.0, 90.0})->text, "joint 'lift' is 90, outside its limits -1 to 2");
}

TEST_F(LimitedJoints, DegreesAreSuggestedAlsoIfTheFirstValueIsSmall)
{
  EXPECT_EQ(
      find({5.0, 0.0, 90.0, 0.0})->text,
      "joint 'arm' is 5, outside its limits -1 to 2 rad; values are in radians, and joint 'arm' is 90: 90 degrees "
      "are 1.5708 rad; 1 more value is outside the limits");
  EXPECT_EQ(find({0.0, 3.0, 90.0, 0.0})->text,
            "joint 'lift' is 3, outside its limits -1 to 2; values are in radians, and joint 'arm' is 90: 90 degrees "
            "are 1.5708 rad; 1 more value is outside the limits");
}

/// Robots on a map, for example with UTM coordinates, may be far from the origin of their planning frame.
TEST_F(LimitedJoints, AWholeNumberOfManyTurnsOfAContinuousJointMayBeInDegrees)
{
  const std::vector<int> pan = {robot->variableIndex("pan")};
  for (const double measured : {6.0, -6.28, 90.25, 1234.5678})
    EXPECT_FALSE(findManyTurns(*robot, pan, &measured, 1)) << measured;
  const std::vector<double> typed = {0.0, 90.0};
  const auto found = findManyTurns(*robot, pan, typed.data(), 2);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->row, 1u);
  EXPECT_EQ(found->text, "joint 'pan' is 90 rad, more than one turn; 90 degrees are 1.5708 rad");
  EXPECT_EQ(findDoubtfulValue(*robot, pan, typed.data(), 2)->text, found->text);
}

TEST_F(LimitedJoints, OtherValuesThanTheGivenOnesAreFoundInAFullState)
{
  std::vector<double> state = robot->defaultState();
  const int arm = robot->variableIndex("arm");
  state[static_cast<std::size_t>(arm)] = 90.0;
  EXPECT_EQ(otherValueOutsideLimits(*robot, {arm}, state.data()), "");
  EXPECT_EQ(otherValueOutsideLimits(*robot, {robot->variableIndex("lift")}, state.data()),
            "joint 'arm' is 90, outside its limits -1 to 2 rad; values are in radians, and 90 degrees are 1.5708 rad");
}

TEST(FarTranslations, AreNamedBecauseAnswersAreNotExactThere)
{
  const auto robot = robotOf(boxLink("base"),
                             "<virtual_joint name=\"drive\" type=\"planar\" parent_frame=\"map\" "
                             "child_link=\"base\"/>");
  const std::vector<int> columns = {0, 1, 2};
  const std::vector<double> rows = {1000.0, -1000.0, 5000.0, 0.0, -4e5, 0.0};
  EXPECT_FALSE(findValueOutsideLimits(*robot, columns, rows.data(), 1)) << "the last value is an angle";
  const auto found = findValueOutsideLimits(*robot, columns, rows.data(), 2);
  ASSERT_TRUE(found);
  EXPECT_EQ(1u, found->row);
  EXPECT_EQ("joint 'drive/y' is -400000; answers are exact only within 1000 m of the origin of the planning frame",
            found->text);
}

TEST(OutsideOtherRanges, AreTranslationsAndLargeAngles)
{
  const auto robot = robotOf(boxLink("base") + boxLink("arm") + jointXml("pan", "continuous", "base", "arm"),
                             "<virtual_joint name=\"drive\" type=\"planar\" parent_frame=\"map\" "
                             "child_link=\"base\"/>");
  ValuesOutsideLimits far(*robot);
  far.add(robot->variableIndex("drive/x"), 3.0);
  EXPECT_EQ(
      "joint 'drive/x' is 3, outside -1 to 1, the range of translations without limits; set a larger "
      "unbounded_translation, or give the request a workspace",
      far.text());
  ValuesOutsideLimits turned(*robot);
  turned.add(robot->variableIndex("pan"), 2e9);
  EXPECT_EQ("joint 'pan' is 2e+09, too large: it, or a joint that follows it, turns by more than 1e+06 rad",
            turned.text());
}
}  // namespace
}  // namespace gpu_planning_scene::core
