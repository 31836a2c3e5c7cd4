// The state space of a group contains the joints that can be planned for, and interpolates as interpolation.h does.

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>
#include <ompl/base/ProjectionEvaluator.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include "gpu_planning_scene/interpolation.h"
#include "gpu_planning_scene/planning/group_state_space.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;
using Names = std::vector<std::string>;
using Row = std::vector<double>;

/// A floating base with a planar platform, followed by a chain with one joint of each other kind: with limits, without
/// limits, mimic, passive, fixed, and jammed (lower limit = upper limit).
std::string everyJointUrdf()
{
  std::string urdf;
  for (const char* link :
       {"base", "platform", "wheel", "arm", "slide", "follower", "idler", "plate", "jammed", "wrist", "tool"})
    urdf += boxLink(link);
  return urdf + jointXml("drive", "planar", "base", "platform") + jointXml("spin", "continuous", "platform", "wheel") +
         jointXml("bend", "revolute", "wheel", "arm", kLimits) +
         jointXml("push", "prismatic", "arm", "slide", kLimits) +
         jointXml("follow", "revolute", "slide", "follower",
                  std::string(kLimits) + "<mimic joint=\"bend\" multiplier=\"2\"/>") +
         jointXml("idle", "revolute", "follower", "idler", kLimits) + jointXml("weld", "fixed", "idler", "plate") +
         jointXml("jam", "revolute", "plate", "jammed", R"(<limit lower="0.5" upper="0.5" effort="1" velocity="1"/>)") +
         jointXml("twist", "continuous", "jammed", "wrist") + jointXml("tilt", "revolute", "wrist", "tool", kLimits);
}

std::string everyJointSrdf()
{
  std::string srdf = R"(<virtual_joint name="free" type="floating" parent_frame="world" child_link="base"/>
    <passive_joint name="idle"/>)";
  const auto group = [&](const std::string& name, const Names& joints)
  {
    srdf += "<group name=\"" + name + "\">";
    for (const std::string& joint : joints)
      srdf += "<joint name=\"" + joint + "\"/>";
    srdf += "</group>";
  };
  group("all", {"free", "drive", "spin", "bend", "push", "follow", "idle", "weld", "jam", "twist", "tilt"});
  group("limited", {"bend", "push", "tilt"});
  group("one", {"push"});
  group("bases", {"spin", "drive", "free"});
  group("mobile", {"drive", "spin"});
  group("turning", {"twist", "spin"});
  group("turning_and_jammed", {"twist", "jam"});
  group("none", {"follow", "idle", "weld", "jam"});
  return srdf;
}

using Space = std::shared_ptr<GroupStateSpace>;

class GroupStateSpaceTest : public testing::Test
{
 protected:
  Space spaceOf(const std::string& group) const
  {
    auto space = std::make_shared<GroupStateSpace>(robot_, group);
    space->setup();
    return space;
  }

  std::size_t at(const std::string& variable) const
  {
    const int index = robot_->variableIndex(variable);
    if (index < 0)
      throw std::out_of_range(variable);
    return static_cast<std::size_t>(index);
  }

  Row randomRow(std::mt19937_64& generator) const
  {
    Row row(width_);
    robot_->randomState(generator, row.data());
    return row;
  }

  static ob::ScopedState<> stateOf(const Space& space, const Row& row)
  {
    ob::ScopedState<> state(space);
    space->copyFromRow(row.data(), state.get());
    return state;
  }

  /// The row of a state; NaN for variables that are not in the space.
  Row rowOf(const Space& space, const ob::State* state) const
  {
    Row row(width_, std::nan(""));
    space->copyToRow(state, row.data());
    return row;
  }

  /// The variables of the default projection.
  Names projectedVariables(const Space& space) const
  {
    Row row(width_);
    for (std::size_t i = 0; i < width_; ++i)
      row[i] = 0.01 * static_cast<double>(i + 1);
    const ob::ProjectionEvaluatorPtr projection = space->getDefaultProjection();
    Eigen::VectorXd projected(projection->getDimension());
    projection->project(stateOf(space, row).get(), projected);
    Names names;
    for (const double value : projected)
      names.push_back(robot_->variables().at(static_cast<std::size_t>(std::lround(100.0 * value) - 1)).name);
    return names;
  }

  std::shared_ptr<const RobotModel> robot_ = robotOf(everyJointUrdf(), everyJointSrdf());
  std::size_t width_ = robot_->variables().size();
};

TEST_F(GroupStateSpaceTest, SubspacesAreNamedAfterTheirJointsAndComeByType)
{
  const Space space = spaceOf("all");
  EXPECT_EQ(space->getName(), "all");
  EXPECT_EQ(space->robot(), robot_);
  EXPECT_EQ(&space->group(), &robot_->group("all"));
  EXPECT_TRUE(space->isLocked());
  Names names;
  std::vector<int> types;
  for (unsigned int i = 0; i < space->getSubspaceCount(); ++i)
  {
    names.push_back(space->getSubspace(i)->getName());
    types.push_back(space->getSubspace(i)->getType());
  }
  EXPECT_EQ(names, (Names{"all/joints", "spin", "twist", "drive", "free"}));
  EXPECT_EQ(types, (std::vector<int>{ob::STATE_SPACE_REAL_VECTOR, ob::STATE_SPACE_SO2, ob::STATE_SPACE_SO2,
                                     ob::STATE_SPACE_SE2, ob::STATE_SPACE_SE3}));
  const auto& joints = *space->as<ob::RealVectorStateSpace>(0);
  ASSERT_EQ(joints.getDimension(), 3U);
  EXPECT_EQ((Names{joints.getDimensionName(0), joints.getDimensionName(1), joints.getDimensionName(2)}),
            (Names{"bend", "push", "tilt"}));
}

TEST_F(GroupStateSpaceTest, BoundsAreTheLimitsAndForTranslationsTheRangeOfRandomStates)
{
  const Space space = spaceOf("all");
  const ob::RealVectorBounds& joints = space->as<ob::RealVectorStateSpace>(0)->getBounds();
  EXPECT_EQ(joints.low, (Row{-1, -1, -1}));
  EXPECT_EQ(joints.high, (Row{2, 2, 2}));
  EXPECT_EQ(space->as<ob::SE2StateSpace>(3)->getBounds().low, (Row{-1, -1}));
  EXPECT_EQ(space->as<ob::SE3StateSpace>(4)->getBounds().high, (Row{1, 1, 1}));
}

/// OMPL warns of new seeds.
void seedOmpl(std::uint_fast32_t seed)
{
  const ompl::msg::LogLevel level = ompl::msg::getLogLevel();
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  ompl::RNG::setSeed(seed);
  ompl::msg::setLogLevel(level);
}

/// A random state of joints with limits, as parts of their ranges.
Row randomParts(const Space& space, ob::StateSampler& sampler)
{
  ob::ScopedState<> state(space);
  sampler.sampleUniform(state.get());
  Row parts = state.reals();
  for (std::size_t i = 0; i < parts.size(); ++i)
    parts[i] = (parts[i] - space->ranges()[i].first) / (space->ranges()[i].second - space->ranges()[i].first);
  return parts;
}

TEST_F(GroupStateSpaceTest, RandomStatesOfJointsWithLimitsAreUniformAndIndependent)
{
  static constexpr std::size_t kDraws = 40'000;
  static constexpr std::size_t kBins = 8;
  const std::uint_fast32_t seed = std::random_device()();
  SCOPED_TRACE("seed " + std::to_string(seed));
  seedOmpl(seed);
  const Space space = spaceOf("limited");
  const ob::StateSamplerPtr sampler = space->allocStateSampler();
  std::vector<Row> draws;
  for (std::size_t i = 0; i < kDraws; ++i)
    draws.push_back(randomParts(space, *sampler));
  // Counts the states in each square of a grid over two values: two of a state, and one of a state and the next.
  const auto expect_even = [&](const auto& x_of, const auto& y_of)
  {
    std::array<std::size_t, kBins * kBins> counts{};
    for (std::size_t i = 1; i < kDraws; ++i)
    {
      const double x = x_of(i);
      const double y = y_of(i);
      ASSERT_TRUE(x >= 0.0 && x <= 1.0 && y >= 0.0 && y <= 1.0) << x << ' ' << y;
      const auto bin_of = [](double part) { return std::min(kBins - 1, static_cast<std::size_t>(part * kBins)); };
      ++counts[bin_of(x) * kBins + bin_of(y)];
    }
    const double expected = static_cast<double>(kDraws) / (kBins * kBins);
    for (const std::size_t count : counts)
      EXPECT_NEAR(static_cast<double>(count), expected, 6.0 * std::sqrt(expected));
  };
  for (std::size_t k = 0; k < 3; ++k)
  {
    expect_even([&](std::size_t i) { return draws[i][k]; }, [&](std::size_t i) { return draws[i][(k + 1) % 3]; });
    expect_even([&](std::size_t i) { return draws[i][k]; }, [&](std::size_t i) { return draws[i - 1][k]; });
  }
}

TEST_F(GroupStateSpaceTest, RandomStatesFollowTheSeedOfOmplAndDifferBetweenSamplers)
{
  const Space space = spaceOf("limited");
  const auto draw = [&]
  {
    const ob::StateSamplerPtr sampler = space->allocStateSampler();
    return randomParts(space, *sampler);
  };
  seedOmpl(7);
  const Row first = draw();
  EXPECT_NE(draw(), first);
  seedOmpl(7);
  EXPECT_EQ(draw(), first);
}

TEST_F(GroupStateSpaceTest, FixedMimicPassiveAndJammedJointsAreNotPlannedFor)
{
  const Space space = spaceOf("all");
  const Row row = rowOf(space, stateOf(space, robot_->defaultState()).get());
  Names left_out;
  for (std::size_t i = 0; i < width_; ++i)
    if (std::isnan(row[i]))
      left_out.push_back(robot_->variables()[i].name);
  EXPECT_EQ(left_out, (Names{"idle", "jam"}));
}

TEST_F(GroupStateSpaceTest, AGroupWithoutAJointToPlanForIsRefused)
{
  EXPECT_NE(errorOf([&] { spaceOf("none"); }).find("group 'none' has no joint to plan for"), std::string::npos);
  EXPECT_NE(errorOf([&] { spaceOf("nowhere"); }).find("'nowhere'"), std::string::npos);
}

TEST_F(GroupStateSpaceTest, TranslationsWithoutRoomAreRefused)
{
  RobotModelOptions options;
  options.unbounded_translation = 0.0;
  robot_ = RobotModel::fromXml("<robot name=\"test\">" + everyJointUrdf() + "</robot>",
                               "<robot name=\"test\">" + everyJointSrdf() + "</robot>", options);
  for (const char* group : {"all", "mobile"})
    EXPECT_NE(errorOf([&] { spaceOf(group); }).find("joint 'drive' cannot be planned for"), std::string::npos);
  EXPECT_EQ(errorOf([&] { spaceOf("turning"); }), "");
}

TEST_F(GroupStateSpaceTest, ABaseThatDrivesOnlyAlongItsHeadingIsRefused)
{
  robot_ = robotOf(everyJointUrdf(), everyJointSrdf() +
                                         "<joint_property joint_name='drive' property_name='motion_model' "
                                         "value='diff_drive'/>");
  EXPECT_EQ(
      "joint 'drive' of group 'mobile' cannot be planned for: it drives only along its heading (motion_model "
      "diff_drive in the SRDF), and planned motions would drive sideways",
      errorOf([&] { spaceOf("mobile"); }));
  EXPECT_EQ(errorOf([&] { spaceOf("turning"); }), "");
}

TEST_F(GroupStateSpaceTest, RowsSurviveTheConversionToStatesAndBack)
{
  const unsigned seed = 3;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 generator(seed);
  for (const Group& group : robot_->groups())
  {
    if (group.name == "none")
      continue;
    const Space space = spaceOf(group.name);
    for (int i = 0; i < 20; ++i)
    {
      const Row row = randomRow(generator);
      const Row others = randomRow(generator);
      const ob::ScopedState<> state = stateOf(space, row);
      EXPECT_TRUE(space->satisfiesBounds(state.get()));
      const Row values = rowOf(space, state.get());
      Row back = others;
      space->copyToRow(state.get(), back.data());
      for (std::size_t k = 0; k < width_; ++k)
        EXPECT_NEAR(back[k], std::isnan(values[k]) ? others[k] : row[k], 1e-15) << robot_->variables()[k].name;
    }
  }
}

TEST_F(GroupStateSpaceTest, EachValueHasThePlaceThatOmplGivesIt)
{
  const Space space = spaceOf("all");
  Row row = robot_->defaultState();
  const Names names = {"bend",    "push",        "tilt",         "spin",         "twist",       "drive/x",
                       "drive/y", "drive/theta", "free/trans_x", "free/trans_y", "free/trans_z"};
  for (std::size_t i = 0; i < names.size(); ++i)
    row[at(names[i])] = 0.05 * static_cast<double>(i + 1);
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(1.0, Eigen::Vector3d(1, 2, 3).normalized()));
  Eigen::Vector4d::Map(&row[at("free/rot_x")]) = turned.coeffs();
  ob::ScopedState<> state = stateOf(space, row);
  const auto& compound = *state->as<ob::CompoundState>();
  for (unsigned int i = 0; i < 3; ++i)
    EXPECT_EQ(compound.as<ob::RealVectorStateSpace::StateType>(0)->values[i], row[at(names[i])]);
  EXPECT_EQ(compound.as<ob::SO2StateSpace::StateType>(1)->value, row[at("spin")]);
  EXPECT_EQ(compound.as<ob::SO2StateSpace::StateType>(2)->value, row[at("twist")]);
  const auto& planar = *compound.as<ob::SE2StateSpace::StateType>(3);
  EXPECT_EQ((Row{planar.getX(), planar.getY(), planar.getYaw()}),
            (Row{row[at("drive/x")], row[at("drive/y")], row[at("drive/theta")]}));
  const auto& floating = *compound.as<ob::SE3StateSpace::StateType>(4);
  EXPECT_EQ((Row{floating.getX(), floating.getY(), floating.getZ()}),
            (Row{row[at("free/trans_x")], row[at("free/trans_y")], row[at("free/trans_z")]}));
  const auto& rotation = floating.rotation();
  EXPECT_LT(Eigen::Quaterniond(rotation.w, rotation.x, rotation.y, rotation.z).angularDistance(turned), 1e-15);
}

TEST_F(GroupStateSpaceTest, AnglesAreBroughtWithinATurn)
{
  const Space space = spaceOf("all");
  for (const char* name : {"spin", "twist", "drive/theta"})
    for (const auto& [angle, expected] : std::vector<std::pair<double, double>>{
             {M_PI, -M_PI}, {-M_PI, -M_PI}, {4.0, 4.0 - 2.0 * M_PI}, {-100.0, -100.0 + 32.0 * M_PI}, {3.0, 3.0}})
    {
      Row row = robot_->defaultState();
      row[at(name)] = angle;
      const ob::ScopedState<> state = stateOf(space, row);
      EXPECT_TRUE(space->satisfiesBounds(state.get())) << name << ' ' << angle;
      EXPECT_NEAR(rowOf(space, state.get())[at(name)], expected, 1e-12) << name;
    }
}

TEST_F(GroupStateSpaceTest, QuaternionsBecomeUnitOnes)
{
  const Space space = spaceOf("all");
  const Eigen::Vector4d turned(0.5, -0.5, 0.5, 0.5);
  for (const double length : {0.0, 1e-200, 1e-3, 1.0, 7.0, 1e200})
  {
    Row row = robot_->defaultState();
    Eigen::Vector4d::Map(&row[at("free/rot_x")]) = length * turned;
    const ob::ScopedState<> state = stateOf(space, row);
    EXPECT_TRUE(space->satisfiesBounds(state.get())) << length;
    const Row back = rowOf(space, state.get());
    const Eigen::Vector4d unit = Eigen::Vector4d::Map(&back[at("free/rot_x")]);
    EXPECT_LT((unit - (length == 0.0 ? Eigen::Vector4d::UnitW() : turned)).norm(), 1e-15) << length;
  }
}

TEST_F(GroupStateSpaceTest, StatesMoveAsTheRowsOfMotionsDo)
{
  const unsigned seed = 17;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 generator(seed);
  const Space space = spaceOf("all");
  const std::vector<bool> turns = [&]
  {
    std::vector<bool> wrapped(width_, false);
    for (const char* name : {"spin", "twist", "drive/theta"})
      wrapped[at(name)] = true;
    return wrapped;
  }();
  const std::size_t quaternion = at("free/rot_x");
  std::size_t across_pi = 0;
  for (int i = 0; i < 500; ++i)
  {
    const Row from = randomRow(generator);
    const Row to = randomRow(generator);
    across_pi += std::abs(to[at("spin")] - from[at("spin")]) > M_PI ? 1 : 0;
    const ob::ScopedState<> start = stateOf(space, from);
    const ob::ScopedState<> end = stateOf(space, to);
    ob::ScopedState<> between(space);
    for (const double fraction : {0.0, 1e-6, std::uniform_real_distribution<double>(0.0, 1.0)(generator), 0.5, 1.0})
    {
      SCOPED_TRACE("motion " + std::to_string(i) + " at " + std::to_string(fraction));
      space->interpolate(start.get(), end.get(), fraction, between.get());
      EXPECT_TRUE(space->satisfiesBounds(between.get()));
      const Row row = rowOf(space, between.get());
      Row expected(width_);
      interpolate(*robot_, from.data(), to.data(), fraction, expected.data());
      // A quaternion and its negative are the same rotation.
      const Eigen::Vector4d rotation = Eigen::Vector4d::Map(&row[quaternion]);
      Eigen::Map<Eigen::Vector4d> expected_rotation(&expected[quaternion]);
      if (rotation.dot(expected_rotation) < 0.0)
        expected_rotation = -expected_rotation;
      for (std::size_t k = 0; k < width_; ++k)
      {
        if (std::isnan(row[k]))
          continue;
        const double off = row[k] - expected[k];
        EXPECT_NEAR(turns[k] ? std::remainder(off, 2.0 * M_PI) : off, 0.0, 1e-9) << robot_->variables()[k].name;
      }
    }
  }
  EXPECT_GT(across_pi, 50U);
}

TEST_F(GroupStateSpaceTest, TheMiddleBetweenAnglesBesidePiIsWithinBounds)
{
  const Space space = spaceOf("all");
  Row row = robot_->defaultState();
  for (const char* name : {"spin", "drive/theta"})
    row[at(name)] = 3.0;
  const ob::ScopedState<> start = stateOf(space, row);
  for (const char* name : {"spin", "drive/theta"})
    row[at(name)] = -3.0;
  const ob::ScopedState<> end = stateOf(space, row);
  ob::ScopedState<> middle(space);
  space->interpolate(start.get(), end.get(), 0.5, middle.get());
  EXPECT_TRUE(space->satisfiesBounds(middle.get()));
  EXPECT_NEAR(std::abs(rowOf(space, middle.get())[at("spin")]), M_PI, 1e-12);
}

TEST_F(GroupStateSpaceTest, ARadianOrMetreCountsTheSameInEachJoint)
{
  const Space space = spaceOf("all");
  const Row row = robot_->defaultState();
  for (const char* name : {"bend", "push", "tilt", "spin", "twist", "drive/x", "free/trans_z"})
  {
    Row moved = row;
    moved[at(name)] += 0.25;
    EXPECT_NEAR(space->distance(stateOf(space, row).get(), stateOf(space, moved).get()), 0.25, 1e-12) << name;
  }
}

TEST_F(GroupStateSpaceTest, OmplFindsEachSpaceSane)
{
  for (const char* group : {"all", "limited", "one", "bases", "mobile", "turning", "turning_and_jammed"})
    EXPECT_NO_THROW(spaceOf(group)->sanityChecks()) << group;
}

TEST_F(GroupStateSpaceTest, TheDefaultProjectionIsOntoWhatMovesTheMost)
{
  EXPECT_EQ(projectedVariables(spaceOf("all")), (Names{"bend", "push", "tilt"}));
  EXPECT_EQ(projectedVariables(spaceOf("one")), (Names{"push"}));
  EXPECT_EQ(projectedVariables(spaceOf("bases")), (Names{"free/trans_x", "free/trans_y", "free/trans_z"}));
  EXPECT_EQ(projectedVariables(spaceOf("mobile")), (Names{"drive/x", "drive/y"}));
  EXPECT_EQ(projectedVariables(spaceOf("turning")), (Names{"spin"}));
  EXPECT_EQ(projectedVariables(spaceOf("turning_and_jammed")), (Names{"twist"}));
}

TEST_F(GroupStateSpaceTest, AtMostThreeJointsAreProjectedOntoUnlessNamed)
{
  robot_ = robotOf(boxLink("0") + boxLink("1") + boxLink("2") + boxLink("3") + boxLink("4") +
                       jointXml("a", "revolute", "0", "1", kLimits) + jointXml("b", "revolute", "1", "2", kLimits) +
                       jointXml("c", "revolute", "2", "3", kLimits) + jointXml("d", "revolute", "3", "4", kLimits),
                   R"(<group name="g"><chain base_link="0" tip_link="4"/></group>)");
  width_ = robot_->variables().size();
  const Space space = spaceOf("g");
  EXPECT_EQ(projectedVariables(space), (Names{"a", "b", "c"}));
  space->projectOnto({"d", "c", "b", "a"});
  EXPECT_EQ(projectedVariables(space), (Names{"d", "c", "b", "a"}));
}

TEST_F(GroupStateSpaceTest, CellsAreATwentiethOfTheRange)
{
  EXPECT_EQ(spaceOf("all")->getDefaultProjection()->getCellSizes(), (Row{0.15, 0.15, 0.15}));
  EXPECT_EQ(spaceOf("mobile")->getDefaultProjection()->getCellSizes(), (Row{0.1, 0.1}));
  EXPECT_EQ(spaceOf("turning")->getDefaultProjection()->getCellSizes(), (Row{M_PI / 10.0}));
  const ob::RealVectorBounds bounds = spaceOf("mobile")->getDefaultProjection()->getBounds();
  EXPECT_EQ(bounds.low, (Row{-1, -1}));
  EXPECT_EQ(bounds.high, (Row{1, 1}));
}

TEST_F(GroupStateSpaceTest, AProjectionOntoNamedJointsHoldsBeforeAndAfterSetup)
{
  const Names joints = {"tilt", "spin", "drive", "free"};
  const Names expected = {"tilt", "spin", "drive/x", "drive/y", "free/trans_x", "free/trans_y", "free/trans_z"};
  const auto before = std::make_shared<GroupStateSpace>(robot_, "all");
  before->projectOnto(joints);
  before->setup();
  EXPECT_EQ(projectedVariables(before), expected);
  const Space after = spaceOf("all");
  after->getDefaultProjection()->setCellSizes({1, 2, 3});
  after->projectOnto(joints);
  after->setup();
  EXPECT_EQ(projectedVariables(after), expected);
  EXPECT_EQ(after->getDefaultProjection()->getCellSizes().size(), expected.size());
}

TEST_F(GroupStateSpaceTest, AProjectionOntoJointsThatAreNotPlannedForIsRefused)
{
  const Space space = spaceOf("limited");
  for (const char* joint : {"follow", "spin", "weld", "nothing"})
    EXPECT_NE(errorOf(
                  [&] {
                    space->projectOnto({"tilt", joint});
                  })
                  .find("names joint '" + std::string(joint) + "'"),
              std::string::npos);
  EXPECT_NE(errorOf([&] { spaceOf("all")->projectOnto({"follow"}); }), "") << "the leader is in this group";
  EXPECT_NE(errorOf([&] { spaceOf("all")->projectOnto({"jam"}); }), "");
  EXPECT_NE(errorOf([&] { space->projectOnto({}); }), "");
  space->setup();
  EXPECT_EQ(projectedVariables(space), (Names{"bend", "push", "tilt"}));
}
}  // namespace
}  // namespace gpu_planning_scene::core
