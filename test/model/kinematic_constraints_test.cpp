// Constraints on links: their numbers by independent computations with Eigen, their derivatives by finite differences,
// and the errors of wrong constraints.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "gpu_planning_scene/kinematic_constraints.h"
#include "model/all_joints_robot.h"
#include "model/inverse_kinematics/constraint_rows.h"
#include "model/inverse_kinematics/constraint_values.h"
#include "model/model_testing.h"
#include "scene/frame.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Parameterization = OrientationConstraint::Parameterization;

constexpr std::uint64_t kConstraintSeed = 41;

class Constraints : public testing::Test
{
 protected:
  double random(double lower, double upper) { return std::uniform_real_distribution<double>(lower, upper)(generator_); }
  Vector3d randomVector(double size) { return {random(-size, size), random(-size, size), random(-size, size)}; }
  Matrix3d randomRotation() { return AngleAxisd(random(-3.0, 3.0), randomVector(1.0).normalized()).toRotationMatrix(); }
  std::vector<double> randomState()
  {
    std::vector<double> state(robot_->variables().size());
    robot_->randomState(generator_, state.data());
    for (const char* joint : {"bend", "slide"})  // away from the limits, so that differences stay within them
      state[static_cast<std::size_t>(robot_->variableIndex(joint))] *= 0.9;
    return state;
  }
  int link(const std::string& name) const { return robot_->linkIndex(name); }

  std::mt19937_64 generator_{kConstraintSeed};
  const std::shared_ptr<const RobotModel> robot_ = allJointsRobot();
  const testing::ScopedTrace trace_{__FILE__, __LINE__, "seed " + std::to_string(kConstraintSeed)};
};

/// Euler angles of R = Rx(a) Ry(b) Rz(c), where b is not near a right angle.
Vector3d xyzAngles(const Matrix3d& rotation)
{
  const double b = std::asin(std::clamp(rotation(0, 2), -1.0, 1.0));
  return {std::atan2(-rotation(1, 2) / std::cos(b), rotation(2, 2) / std::cos(b)), b,
          std::atan2(-rotation(0, 1) / std::cos(b), rotation(0, 0) / std::cos(b))};
}

Matrix3d fromXyzAngles(const Vector3d& angles)
{
  return (AngleAxisd(angles.x(), Vector3d::UnitX()) * AngleAxisd(angles.y(), Vector3d::UnitY()) *
          AngleAxisd(angles.z(), Vector3d::UnitZ()))
      .toRotationMatrix();
}

/// The numbers of one constraint in a state, computed from plain forward kinematics.
Eigen::Vector3d numbersOf(const KinematicConstraints& constraints, const RobotModel& robot,
                          const std::vector<double>& state)
{
  if (!constraints.positions.empty())
  {
    const PositionConstraint& position = constraints.positions.front();
    return position.pose.inverse() * (linkPose(robot, position.link, state.data()) * position.point);
  }
  const OrientationConstraint& orientation = constraints.orientations.front();
  const Matrix3d rotation =
      orientation.wanted.inverse() * linkPose(robot, orientation.link, state.data()).linear() * orientation.frame;
  if (orientation.parameterization == Parameterization::XyzEulerAngles)
    return xyzAngles(rotation);
  const AngleAxisd turn{Eigen::Quaterniond(rotation)};
  return orientation.axes.inverse() * orientation.wanted * (turn.angle() * turn.axis());
}

/// Compares the rows with central differences. All three numbers must be outside their tolerances.
void expectDerivatives(const KinematicConstraints& constraints, const std::shared_ptr<const RobotModel>& robot,
                       const std::vector<double>& state)
{
  constexpr double kStep = 1e-6;
  const KinematicChains chains(robot, robot->group("all"), constraints.links());
  KinematicChains::Workspace workspace;
  chains.computePoses(state.data(), workspace);
  ConstraintRows rows(constraints, chains);
  ASSERT_FALSE(rows.compute(workspace, 1.0));
  ASSERT_EQ(rows.derivatives().rows(), 3);
  const DegreesOfFreedom& freedoms = chains.degreesOfFreedom();
  for (std::size_t i = 0; i < freedoms.size(); ++i)
  {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(freedoms.size()));
    std::vector<double> before = state;
    std::vector<double> after = state;
    step[static_cast<Eigen::Index>(i)] = kStep;
    advance(freedoms, step, after.data());
    advance(freedoms, -step, before.data());
    const Vector3d difference =
        (numbersOf(constraints, *robot, after) - numbersOf(constraints, *robot, before)) / (2.0 * kStep);
    const Vector3d derivative = rows.derivatives().col(static_cast<Eigen::Index>(i));
    EXPECT_LT((difference - derivative).norm(), 1e-7 * std::max(1.0, derivative.norm()))
        << "degree of freedom " << i << ": " << derivative.transpose() << " instead of " << difference.transpose();
  }
}

TEST_F(Constraints, RowsOfPositionsAreDerivatives)
{
  for (int i = 0; i < 40; ++i)
  {
    PositionConstraint position;
    position.link = link(i % 2 == 0 ? "end" : "middle");
    position.point = randomVector(1.0);
    position.pose.linear() = randomRotation();
    position.pose.translation() = position.pose.linear() * Vector3d(20.0, -30.0, 40.0);  // out of reach on each axis
    if (i % 4 < 2)
      position.region = Box{{0.1, 0.2, 0.3}};
    KinematicConstraints constraints;
    constraints.positions = {position};
    expectDerivatives(constraints, robot_, randomState());
  }
}

TEST_F(Constraints, RowsOfOrientationsAreDerivatives)
{
  constexpr double kNearlySingular = 0.1;
  int compared = 0;
  while (compared < 40)
  {
    OrientationConstraint orientation;
    orientation.link = link(compared % 2 == 0 ? "end" : "middle");
    orientation.frame = randomRotation();
    orientation.wanted = randomRotation();
    orientation.axes = randomRotation();
    orientation.tolerance.setConstant(1e-6);
    orientation.parameterization =
        compared % 4 < 2 ? Parameterization::XyzEulerAngles : Parameterization::RotationVector;
    KinematicConstraints constraints;
    constraints.orientations = {orientation};
    const std::vector<double> state = randomState();
    const Vector3d numbers = numbersOf(constraints, *robot_, state);
    const bool is_euler = orientation.parameterization == Parameterization::XyzEulerAngles;
    // The Euler angles jump where the second one is a right angle, and all numbers jump at half a turn.
    if ((is_euler && std::cos(numbers.y()) < kNearlySingular) || numbers.norm() > M_PI - kNearlySingular)
      continue;
    expectDerivatives(constraints, robot_, state);
    ++compared;
  }
}

TEST_F(Constraints, EulerAnglesAreThoseOfTurnsAboutXThenYThenZ)
{
  const auto angles_of = [&](const Matrix3d& rotation)
  {
    OrientationConstraint constraint;
    constraint.link = 0;
    constraint.wanted = randomRotation();
    constraint.frame = randomRotation();
    constraint.tolerance.setConstant(0.1);
    Isometry3d pose = Isometry3d::Identity();
    pose.linear() = constraint.wanted * rotation * constraint.frame.transpose();
    return orientationValues(constraint, pose).angles;
  };
  for (int i = 0; i < 1000; ++i)
  {
    const Vector3d expected(random(-M_PI, M_PI), random(-1.5, 1.5), random(-M_PI, M_PI));
    EXPECT_LT((angles_of(fromXyzAngles(expected)) - expected).norm(), 1e-10) << expected.transpose();
  }
  // Where the second angle is a right angle, several angles describe the same rotation.
  for (int i = 0; i < 1000; ++i)
  {
    const Vector3d singular(random(-M_PI, M_PI), i % 2 == 0 ? M_PI_2 : -M_PI_2, random(-M_PI, M_PI));
    const Matrix3d rotation = fromXyzAngles(singular);
    EXPECT_LT((fromXyzAngles(angles_of(rotation)) - rotation).norm(), 1e-7) << singular.transpose();
  }
}

TEST_F(Constraints, AToleranceOfPiLeavesAnAngleFree)
{
  OrientationConstraint upright;
  upright.link = link("root");
  upright.wanted = randomRotation();
  upright.tolerance = {0.1, 0.1, M_PI};
  KinematicConstraints constraints;
  constraints.orientations = {upright};
  std::vector<Isometry3d> poses(robot_->links().size(), Isometry3d::Identity());
  const auto violation = [&](const Vector3d& angles)
  {
    poses[static_cast<std::size_t>(upright.link)].linear() = upright.wanted * fromXyzAngles(angles);
    return violationOf(constraints, poses.data(), nullptr).orientation;
  };
  for (int i = 0; i < 100; ++i)
  {
    const double turn = random(-M_PI, M_PI);
    EXPECT_EQ(violation({0.09, -0.09, turn}), 0.0);
    EXPECT_NEAR(violation({0.4, 0.0, turn}), 0.3, 1e-9);
    EXPECT_NEAR(violation({0.05, -0.25, turn}), 0.15, 1e-9);
  }
}

TEST_F(Constraints, AnAngleWithAToleranceOfPiHasNoRow)
{
  OrientationConstraint orientation;
  orientation.link = link("end");
  orientation.tolerance = {1e-6, 1e-6, M_PI};
  KinematicConstraints constraints;
  constraints.orientations = {orientation};
  const KinematicChains chains(robot_, robot_->group("all"), constraints.links());
  for (int i = 0; i < 20; ++i)
  {
    KinematicChains::Workspace workspace;
    chains.computePoses(randomState().data(), workspace);
    ConstraintRows rows(constraints, chains);
    EXPECT_FALSE(rows.compute(workspace, 0.1));
    EXPECT_EQ(rows.derivatives().rows(), 2);
  }
}

TEST_F(Constraints, ARegionReachesToItsSurface)
{
  PositionConstraint position;
  position.link = link("root");
  position.pose.linear() = randomRotation();
  position.pose.translation() = randomVector(1.0);
  const auto violation = [&](const std::variant<Sphere, Box>& region, const Vector3d& local)
  {
    position.region = region;
    KinematicConstraints constraints;
    constraints.positions = {position};
    std::vector<Isometry3d> poses(robot_->links().size(), Isometry3d::Identity());
    poses[static_cast<std::size_t>(position.link)].translation() = position.pose * local;
    return violationOf(constraints, poses.data(), nullptr).position;
  };
  const Box box{{0.2, 0.4, 0.6}};
  EXPECT_EQ(violation(box, {0.099, -0.199, 0.299}), 0.0);
  EXPECT_NEAR(violation(box, {0.4, 0.0, 0.0}), 0.3, 1e-12);
  EXPECT_NEAR(violation(box, {-0.4, 0.6, 0.0}), 0.5, 1e-12);
  EXPECT_EQ(violation(Sphere{0.3}, {0.0, 0.299, 0.0}), 0.0);
  EXPECT_NEAR(violation(Sphere{0.3}, {0.0, 0.4, -0.3}), 0.2, 1e-12);
}

TEST_F(Constraints, APoseAllowsItsTolerancesAndNoMore)
{
  constexpr double kLength = 0.01;
  constexpr double kAngle = 0.2;
  Isometry3d frame = Isometry3d::Identity();
  frame.translation() = randomVector(1.0);
  frame.linear() = randomRotation();
  Isometry3d wanted = Isometry3d::Identity();
  wanted.translation() = randomVector(1.0);
  wanted.linear() = randomRotation();
  const auto constraints = KinematicConstraints::pose(link("end"), frame, wanted, kLength, kAngle);
  std::vector<Isometry3d> poses(robot_->links().size(), Isometry3d::Identity());
  for (int i = 0; i < 1000; ++i)
  {
    const double distance = random(0.0, 2.0 * kLength);
    const double angle = random(0.0, 2.0 * kAngle);
    Isometry3d reached = wanted;
    reached.translation() += distance * randomVector(1.0).normalized();
    reached.linear() = wanted.linear() * AngleAxisd(angle, randomVector(1.0).normalized());
    poses[static_cast<std::size_t>(link("end"))] = reached * frame.inverse();
    const ConstraintViolation violation = violationOf(constraints, poses.data(), nullptr);
    EXPECT_NEAR(violation.position, std::max(0.0, distance - kLength), 1e-12);
    // The angle is limited by three numbers, so some angles below the tolerance are not allowed.
    EXPECT_TRUE(violation.orientation > 0.0 || angle <= kAngle) << angle;
    EXPECT_TRUE(violation.orientation == 0.0 || angle > kAngle / std::sqrt(3.0)) << angle;
  }
  EXPECT_TRUE(KinematicConstraints::pose(link("end"), frame, wanted, kLength, M_PI).orientations.empty());
}

TEST_F(Constraints, TheEndsOfARangeBelongToIt)
{
  const auto excess = [](const JointConstraint& range, double value)
  {
    KinematicConstraints constraints;
    constraints.joints = {range};
    return violationOf(constraints, nullptr, &value).joint;
  };
  for (int i = 0; i < 1000; ++i)
  {
    JointConstraint range{0, random(-2.5, 0.0), random(0.0, 2.5)};
    for (const bool is_turn : {false, true})
    {
      range.is_turn = is_turn;
      EXPECT_EQ(excess(range, range.lower), 0.0) << range.lower;
      EXPECT_EQ(excess(range, range.upper), 0.0) << range.upper;
      EXPECT_NEAR(excess(range, range.upper + 0.125), 0.125, 1e-12);
    }
    EXPECT_LT(excess(range, range.upper + 4.0 * M_PI), 1e-12);
    EXPECT_NEAR(excess(range, range.lower - 2.0 * M_PI - 0.125), 0.125, 1e-12);
    range.is_turn = false;
    EXPECT_NEAR(excess(range, range.upper + 4.0 * M_PI), 4.0 * M_PI, 1e-12);
  }
}

TEST_F(Constraints, TheViolationIsDescribedInWords)
{
  EXPECT_EQ((ConstraintViolation{0.25, 0.1, 0.0}).text(),
            "0.25 m from the wanted position and 0.1 rad from the wanted orientation");
  EXPECT_EQ((ConstraintViolation{0.0, 0.0, 0.5}).text(), "0.5 from a wanted joint value");
  EXPECT_EQ(ConstraintViolation().text(), "");
}

/// The error of the constraints; `change` makes them wrong.
template <class Change>
std::string faultAfter(const RobotModel& robot, const Change& change)
{
  KinematicConstraints constraints;
  constraints.positions = {{robot.linkIndex("end"), Vector3d::Zero(), Isometry3d::Identity(), Sphere{0.1}}};
  constraints.orientations = {{robot.linkIndex("end"), Matrix3d::Identity(), Matrix3d::Identity(),
                               Vector3d::Constant(0.1), Parameterization::XyzEulerAngles}};
  constraints.joints = {{robot.variableIndex("bend"), -1.0, 1.0}};
  EXPECT_EQ(errorOf([&] { constraints.validate(robot, "goal 0"); }), "");
  change(constraints);
  return errorOf([&] { constraints.validate(robot, "goal 0"); });
}

TEST_F(Constraints, EachWrongPartHasItsError)
{
  using All = KinematicConstraints;
  const auto fault = [&](const auto& change) { return faultAfter(*robot_, change); };
  const double nan = std::nan("");
  EXPECT_EQ(fault([](All& c) { c.positions[0].link = 7; }), "goal 0 names link 7, which the robot does not have");
  EXPECT_EQ(fault([](All& c) { c.orientations[0].link = -1; }), "goal 0 names link -1, which the robot does not have");
  EXPECT_EQ(fault([&](All& c) { c.positions[0].point.x() = nan; }),
            "goal 0: the position of link 'end' has an offset that is not finite");
  EXPECT_EQ(fault([](All& c) { c.positions[0].region = Sphere{1e-10}; }),
            "goal 0: the position of link 'end': the radius is 1e-10; it must be at least 1e-09");
  EXPECT_EQ(fault(
                [](All& c) {
                  c.positions[0].region = Box{{1.0, 0.0, 1.0}};
                }),
            "goal 0: the position of link 'end': a size of the box is 0; it must be at least 1e-09");
  EXPECT_EQ(fault([&](All& c) { c.orientations[0].tolerance.z() = nan; }),
            "goal 0: the orientation of link 'end': a tolerance is nan; it must be at least 5e-10");
  EXPECT_EQ(fault([](All& c) { c.orientations[0].wanted *= 2.0; }).rfind("goal 0: the orientation of link 'end'", 0),
            0u);
  EXPECT_EQ(fault([&](All& c) { c.positions[0].pose.translation().x() = nan; })
                .rfind("goal 0: the position of link 'end'", 0),
            0u);
  EXPECT_EQ(fault([](All& c) { c.joints[0].variable = 99; }),
            "goal 0 names variable 99, which the robot does not have");
  EXPECT_EQ(fault([](All& c) { c.joints[0].lower = 2.0; }),
            "goal 0: the range of joint 'bend', 2 to 1, is not a range");
  EXPECT_EQ(fault(
                [](All& c) {
                  c.joints[0] = {c.joints[0].variable, 2.5, 3.0};
                }),
            "goal 0: the range of joint 'bend', 2.5 to 3, is outside the joint's limits, -2 to 2");
  EXPECT_EQ(fault(
                [](All& c) {
                  c.joints.push_back({c.joints[0].variable, 1.5, 1.8});
                }),
            "goal 0: two ranges of joint 'bend' contradict each other");
  EXPECT_EQ(fault([&](All& c) { c.joints[0].variable = robot_->variableIndex("fly/rot_w"); }),
            "goal 0: the range of joint 'fly/rot_w', -1 to 1, is that of a quaternion's component; constrain the "
            "orientation of link 'end' instead");
}
}  // namespace
}  // namespace gpu_planning_scene::core
