#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "base/text/number_text.h"
#include "model/model_testing.h"
#include "model/robot_text.h"

namespace gpu_planning_scene::core
{
namespace
{
/// A chain with a joint of each kind. `inside`: elements of the prismatic joint "slide" beside its limits, -1 to 2.
std::string chainUrdf(const std::string& inside = "")
{
  std::string urdf;
  for (const char* link : {"base", "a", "b", "c", "d", "e"})
    urdf += boxLink(link);
  return urdf + jointXml("slide", "prismatic", "base", "a", kLimits + inside) +
         jointXml("elbow", "revolute", "a", "b", kLimits) + jointXml("turn", "continuous", "b", "c") +
         jointXml("copy", "prismatic", "c", "d", kLimits + std::string("<mimic joint=\"slide\"/>")) +
         jointXml("glued", "fixed", "d", "e");
}

std::string softLimits(const std::string& attributes)
{
  return "<safety_controller k_velocity=\"1\" " + attributes + "/>";
}

std::shared_ptr<const RobotModel> limited(const std::vector<JointLimits>& limits,
                                          std::vector<std::string>* warnings = nullptr, const std::string& srdf = "",
                                          const std::string& inside = "")
{
  RobotModelOptions options;
  options.joint_limits = limits;
  return RobotModel::fromXml("<robot name=\"test\">" + chainUrdf(inside) + "</robot>",
                             srdf.empty() ? srdf : "<robot name=\"test\">" + srdf + "</robot>", options, warnings);
}

const Variable& variableOf(const RobotModel& robot, const std::string& name)
{
  return robot.variables().at(static_cast<std::size_t>(robot.variableIndex(name)));
}

void expectLimits(const RobotModel& robot, const std::string& name, double lower, double upper,
                  const std::string& source)
{
  const Variable& variable = variableOf(robot, name);
  EXPECT_TRUE(variable.bounded);
  EXPECT_EQ(lower, variable.lower) << name;
  EXPECT_EQ(upper, variable.upper) << name;
  EXPECT_EQ(source, variable.limits_source) << name;
}

constexpr char kSoft[] = "the URDF's <safety_controller>";

TEST(SoftLimits, NarrowTheLimitsOfTheUrdf)
{
  expectLimits(*robotOf(chainUrdf(softLimits("soft_lower_limit=\"-0.5\" soft_upper_limit=\"1.5\""))), "slide", -0.5,
               1.5, kSoft);
  expectLimits(*robotOf(chainUrdf(softLimits("soft_lower_limit=\"-0.5\" soft_upper_limit=\"5\""))), "slide", -0.5, 2.0,
               kSoft);
}

TEST(SoftLimits, DoNotWidenTheLimitsOfTheUrdf)
{
  expectLimits(*robotOf(chainUrdf(softLimits("soft_lower_limit=\"-5\" soft_upper_limit=\"5\""))), "slide", -1.0, 2.0,
               "");
}

TEST(SoftLimits, AreZeroWhereTheyAreMissing)
{
  std::vector<std::string> warnings;
  expectLimits(*robotOf(chainUrdf(softLimits("soft_upper_limit=\"1.5\"")), "", &warnings), "slide", 0.0, 1.5, kSoft);
  EXPECT_TRUE(warnings.empty());
  expectLimits(*robotOf(chainUrdf(softLimits("")), "", &warnings), "slide", 0.0, 0.0, kSoft);
  ASSERT_EQ(1u, warnings.size());
  EXPECT_NE(std::string::npos, warnings[0].find("joint 'slide' cannot move: its <safety_controller> leaves only"));
}

TEST(SoftLimits, ThatLeaveNoPositionAreAnError)
{
  EXPECT_EQ(
      "test.urdf:7: joint 'slide': no position is within its <limit>, -1 to 2, and its <safety_controller>, 3 to 4 (a "
      "soft limit that is not given is 0)",
      errorOf([] { robotOf(chainUrdf(softLimits("soft_lower_limit=\"3\" soft_upper_limit=\"4\""))); }));
}

TEST(PositionLimits, ThatAreWiderThanThoseOfProofsMakeTheirPairsChecked)
{
  std::size_t disabled = 0;
  const auto warnings_of = [&](double upper, const std::string& reason, const std::string& comment)
  {
    RobotModelOptions options;
    JointLimits limits;
    limits.variable = "slide";
    limits.min_position = -1.0;
    limits.max_position = upper;
    options.joint_limits = {limits};
    options.srdf_name = "my.srdf";
    std::vector<std::string> warnings;
    const auto robot = RobotModel::fromXml(
        "<robot name='r'><link name='rail'/><link name='cart'/><joint name='slide' type='prismatic'>"
        "<parent link='rail'/><child link='cart'/><axis xyz='1 0 0'/>"
        "<limit lower='-2' upper='2' effort='1' velocity='1'/></joint></robot>",
        "<robot name='r'>" + comment + "<disable_collisions link1='rail' link2='cart' reason='" + reason +
            "'/></robot>",
        options, &warnings);
    disabled = robot->srdfCollisions().disabled.size();
    return warnings;
  };
  const std::vector<std::string> warnings = warnings_of(9.0, "Never", "");
  EXPECT_EQ(0u, disabled);
  ASSERT_EQ(1u, warnings.size());
  EXPECT_EQ(0u,
            warnings[0].find("my.srdf: 1 pairs of links that are disabled with the reason Never are checked, because "
                             "limits are wider than those for which"))
      << warnings[0];
  EXPECT_NE(std::string::npos, warnings[0].find(": slide (-1 to 9). ")) << warnings[0];
  EXPECT_TRUE(warnings_of(1.0, "Never", "").empty()) << "narrower";
  EXPECT_EQ(1u, disabled);
  EXPECT_TRUE(warnings_of(9.0, "Adjacent", "").empty()) << "not a proof";
  EXPECT_EQ(1u, disabled);
  EXPECT_TRUE(warnings_of(9.0, "Never", "<!-- Generated by generate_acm. The limits are: slide (-1 to 9). -->").empty())
      << "proven for them";
  EXPECT_EQ(1u, disabled);
  EXPECT_EQ(1u,
            warnings_of(10.0, "Never", "<!-- Generated by generate_acm. The limits are: slide (-1 to 9). -->").size())
      << "wider still";
  const std::string narrow = "<!-- Generated by generate_acm. The limits are: a (0 to 1), slide (-0.25 to 0.25). -->";
  EXPECT_EQ(1u, warnings_of(1.0, "Never", narrow).size()) << "within the URDF's, but wider than those of the proof";
  EXPECT_EQ(0u, disabled);
  EXPECT_TRUE(
      warnings_of(1.0, "Never", "<!-- Generated by generate_acm. The limits are: the slide (-0.25 to 0.25). -->")
          .empty())
      << "another joint";
  EXPECT_EQ(1u, warnings_of(9.0, "Never", "<!-- slide (-1 to 9) -->").size()) << "a comment of somebody else";
}

TEST(PositionLimits, ReplaceTheLimitsOfTheUrdfByNarrowerAndByWiderOnes)
{
  const auto robot = limited({{"slide", 0.25, 0.5, "limits.yaml"}, {"elbow", -3.0, 3.0, "limits.yaml"}});
  expectLimits(*robot, "slide", 0.25, 0.5, "limits.yaml");
  expectLimits(*robot, "elbow", -3.0, 3.0, "limits.yaml");
}

TEST(PositionLimits, ReplaceSoftLimitsToo)
{
  const std::string soft = softLimits("soft_lower_limit=\"-0.5\" soft_upper_limit=\"0.5\"");
  expectLimits(*limited({{"slide", -2.0, 2.0, "limits.yaml"}}, nullptr, "", soft), "slide", -2.0, 2.0, "limits.yaml");
  expectLimits(*limited({{"slide", {}, 0.25, "limits.yaml"}}, nullptr, "", soft), "slide", -0.5, 0.25,
               std::string(kSoft) + " and limits.yaml");
}

TEST(PositionLimits, OfOneSideKeepTheOtherSide)
{
  expectLimits(*limited({{"slide", 0.25, {}, "limits.yaml"}}), "slide", 0.25, 2.0, "limits.yaml");
  expectLimits(*limited({{"slide", {}, 0.25, "limits.yaml"}}), "slide", -1.0, 0.25, "limits.yaml");
}

TEST(PositionLimits, HoldForRandomStatesAndTheDefaultState)
{
  const auto robot = limited({{"slide", 0.25, 0.5, "limits.yaml"}});
  const auto slide = static_cast<std::size_t>(robot->variableIndex("slide"));
  EXPECT_EQ(0.375, robot->defaultState()[slide]);
  std::mt19937_64 generator(7);
  std::vector<double> state(robot->variables().size());
  double least = 1.0;
  double most = 0.0;
  for (int i = 0; i < 1000; ++i)
  {
    robot->randomState(generator, state.data());
    least = std::min(least, state[slide]);
    most = std::max(most, state[slide]);
  }
  EXPECT_GE(least, 0.25);
  EXPECT_LE(most, 0.5);
  EXPECT_LT(least, 0.26);
  EXPECT_GT(most, 0.49);
}

TEST(PositionLimits, LimitTranslationsOfAPlanarJointAndNotItsRotation)
{
  const std::string srdf = R"(<virtual_joint name="drive" type="planar" parent_frame="world" child_link="base"/>)";
  std::vector<std::string> warnings;
  const auto robot =
      limited({{"drive/x", 2.0, 3.0, "limits.yaml"}, {"drive/theta", -1.0, 1.0, "limits.yaml"}}, &warnings, srdf);
  expectLimits(*robot, "drive/x", 2.0, 3.0, "limits.yaml");
  EXPECT_FALSE(variableOf(*robot, "drive/y").bounded);
  EXPECT_FALSE(variableOf(*robot, "drive/theta").bounded);
  EXPECT_EQ(std::vector<std::string>{"limits.yaml: the position limits of 'drive/theta' are not used, because it is a "
                                     "rotation of a planar or floating joint"},
            warnings);
  EXPECT_EQ(
      "limits.yaml: 'drive/x' has only one position limit, and the URDF has none; give min_position and "
      "max_position",
      errorOf(
          [&] {
            limited({{"drive/x", 2.0, {}, "limits.yaml"}}, nullptr, srdf);
          }));
  EXPECT_EQ("limits.yaml: joint 'drive' has several variables; name them as 'drive/x' and so on",
            errorOf(
                [&] {
                  limited({{"drive", 2.0, 3.0, "limits.yaml"}}, nullptr, srdf);
                }));
}

TEST(PositionLimits, OfMoreThanTwoTurnsMayBeInDegrees)
{
  std::vector<std::string> warnings;
  limited({{"elbow", -150.0, 150.0, "limits.yaml"}, {"slide", -150.0, 150.0, "limits.yaml"}}, &warnings);
  ASSERT_EQ(1U, warnings.size());
  EXPECT_EQ("limits.yaml: a position limit of 'elbow' is -150 rad, more than two turns; -150 degrees are " +
                numberText(-150.0 * M_PI / 180.0) + " rad",
            warnings[0]);
  warnings.clear();
  limited({{"elbow", -4.0 * M_PI, 4.0 * M_PI, "limits.yaml"}}, &warnings);
  EXPECT_TRUE(warnings.empty());
}

TEST(PositionLimits, ThatCanHaveNoEffectGiveAWarning)
{
  std::vector<std::string> warnings;
  const auto robot = limited({{"turn", -1.0, 1.0, "l"},
                              {"copy", 0.0, 1.0, "l"},
                              {"glued", 0.0, 1.0, "l"},
                              {"elbo", 0.0, 1.0, "l"},
                              {"slid", 0.0, 1.0, "l"}},
                             &warnings);
  EXPECT_EQ((std::vector<std::string>{
                "l: the position limits of 'turn' are not used, because it is continuous; make it revolute in the URDF "
                "to limit it",
                "l: the position limits of 'copy' are not used, because it follows another joint, whose limits count",
                "l: the position limits of 'glued' are not used, because it is fixed",
                "l: position limits are not used, because the robot does not have the joint: elbo, slid"}),
            warnings);
  EXPECT_FALSE(variableOf(*robot, "turn").bounded);
  expectLimits(*robot, "slide", -1.0, 2.0, "");
}

TEST(PositionLimits, ThatNoPositionIsWithinAreAnError)
{
  EXPECT_EQ("l: 'slide' has the position limits 1 to 0.5; the first must not be above the second",
            errorOf(
                [] {
                  limited({{"slide", 1.0, 0.5, "l"}});
                }));
  EXPECT_EQ(
      "l: 'slide' has the position limits 3 to 2; the first must not be above the second (one of them is that of "
      "the URDF's <limit>)",
      errorOf(
          [] {
            limited({{"slide", 3.0, {}, "l"}});
          }));
  for (const double wrong : {std::nan(""), HUGE_VAL, -HUGE_VAL})
    EXPECT_EQ("l: 'slide' has a position limit that is not a finite number",
              errorOf(
                  [wrong] {
                    limited({{"slide", -1.0, wrong, "l"}});
                  }));
}

TEST(PositionLimits, AreDescribedWithTheirSources)
{
  const auto robot = limited({{"elbow", -0.25, 0.25, "limits.yaml"}}, nullptr, "",
                             softLimits("soft_lower_limit=\"-0.5\" soft_upper_limit=\"0.5\""));
  EXPECT_EQ((std::vector<std::string>{"limits from limits.yaml: elbow (-0.25 to 0.25)",
                                      "limits from the URDF's <safety_controller>: slide (-0.5 to 0.5)"}),
            describeLimitSources(*robot));
  EXPECT_TRUE(describeLimitSources(*limited({})).empty());
}
std::optional<double> velocityOf(const std::string& limit, const std::vector<JointLimits>& limits = {})
{
  RobotModelOptions options;
  options.joint_limits = limits;
  return variableOf(*RobotModel::fromXml("<robot name='test'>" + boxLink("base") + boxLink("a") +
                                             jointXml("turn", "continuous", "base", "a", limit) + "</robot>",
                                         "", options),
                    "turn")
      .max_velocity;
}

TEST(VelocityLimits, AreThoseOfTheUrdf)
{
  EXPECT_EQ(1.0, variableOf(*robotOf(chainUrdf()), "slide").max_velocity);
  EXPECT_EQ(2.5, velocityOf("<limit effort='1' velocity='2.5'/>"));
  EXPECT_FALSE(velocityOf(""));
  for (const char* none : {"0", "-1"})
    EXPECT_FALSE(velocityOf("<limit effort='1' velocity='" + std::string(none) + "'/>")) << none;
}

TEST(VelocityLimits, OfJointLimitsReplaceThoseOfTheUrdf)
{
  const std::string urdf = "<limit effort='1' velocity='2.5'/>";
  JointLimits limits{"turn"};
  EXPECT_EQ(2.5, velocityOf(urdf, {limits}));
  limits.max_velocity = 4.0;
  EXPECT_EQ(4.0, velocityOf(urdf, {limits})) << "also on a continuous joint";
  limits = {"turn"};
  limits.drops_velocity_limit = true;
  EXPECT_FALSE(velocityOf(urdf, {limits}));
}

TEST(VelocityLimits, MustBeFiniteAndAboveZero)
{
  for (const double wrong : {0.0, -1.0, std::nan(""), HUGE_VAL})
  {
    JointLimits velocity{"slide", {}, {}, "l"};
    velocity.max_velocity = wrong;
    EXPECT_EQ("l: 'slide' has the max_velocity " + numberText(wrong) +
                  "; it must be finite and above 0 (for no limit, set has_velocity_limits: false)",
              errorOf([&] { limited({velocity}); }));
    JointLimits acceleration{"slide", {}, {}, "l"};
    acceleration.max_acceleration = wrong;
    EXPECT_EQ("l: 'slide' has the max_acceleration " + numberText(wrong) +
                  "; it must be finite and above 0 (for no limit, set has_acceleration_limits: false)",
              errorOf([&] { limited({acceleration}); }));
  }
}

TEST(VelocityLimits, ThatCanHaveNoEffectGiveAWarning)
{
  std::vector<JointLimits> limits;
  for (const char* name : {"copy", "glued", "elbo", "turn"})
  {
    limits.push_back({name, {}, {}, "l"});
    limits.back().max_velocity = 2.0;
  }
  std::vector<std::string> warnings;
  limited(limits, &warnings);
  EXPECT_EQ((std::vector<std::string>{
                "l: the velocity limits of 'copy' are not used, because it follows another joint, whose limits count",
                "l: the velocity limits of 'glued' are not used, because it is fixed",
                "l: velocity limits are not used, because the robot does not have the joint: elbo"}),
            warnings);
}
}  // namespace
}  // namespace gpu_planning_scene::core
