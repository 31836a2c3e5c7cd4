#include <cmath>
#include <map>

#include <gtest/gtest.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include "model/model_testing.h"
#include "model/real_robots.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::uint64_t kSeed = 11;

// A second implementation of forward kinematics, directly on urdfdom's tree.
class NaiveKinematics
{
 public:
  NaiveKinematics(const std::string& urdf, const RobotModel& robot) : model_(urdf::parseURDF(urdf)), robot_(robot) {}

  std::map<std::string, Eigen::Isometry3d> linkPoses(const double* state) const
  {
    std::map<std::string, Eigen::Isometry3d> poses;
    addLink(*model_->getRoot(), Eigen::Isometry3d::Identity(), state, poses);
    return poses;
  }

 private:
  void addLink(const urdf::Link& link, const Eigen::Isometry3d& pose, const double* state,
               std::map<std::string, Eigen::Isometry3d>& poses) const
  {
    poses[link.name] = pose;
    for (const auto& child : link.child_links)
    {
      const urdf::Joint& joint = *child->parent_joint;
      const urdf::Pose& origin = joint.parent_to_joint_origin_transform;
      const urdf::Rotation& q = origin.rotation;
      const Eigen::Isometry3d placed = pose *
                                       Eigen::Translation3d(origin.position.x, origin.position.y, origin.position.z) *
                                       Eigen::Quaterniond(q.w, q.x, q.y, q.z);
      addLink(*child, placed * motion(joint, state), state, poses);
    }
  }

  double value(const std::string& variable, const double* state) const
  {
    const int index = robot_.variableIndex(variable);
    EXPECT_GE(index, 0) << variable;
    return state[index];
  }

  double position(const urdf::Joint& joint, const double* state) const
  {
    return joint.mimic ? joint.mimic->multiplier * position(*model_->getJoint(joint.mimic->joint_name), state) +
                             joint.mimic->offset
                       : value(joint.name, state);
  }

  Eigen::Isometry3d motion(const urdf::Joint& joint, const double* state) const
  {
    Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
    const Eigen::Vector3d axis = Eigen::Vector3d(joint.axis.x, joint.axis.y, joint.axis.z).stableNormalized();
    switch (joint.type)
    {
      case urdf::Joint::REVOLUTE:
      case urdf::Joint::CONTINUOUS:
        return result * Eigen::AngleAxisd(position(joint, state), axis);
      case urdf::Joint::PRISMATIC:
        return result * Eigen::Translation3d(position(joint, state) * axis);
      case urdf::Joint::PLANAR:  // the normal of the tests' planar joints is z
        return result * Eigen::Translation3d(value(joint.name + "/x", state), value(joint.name + "/y", state), 0.0) *
               Eigen::AngleAxisd(value(joint.name + "/theta", state), Eigen::Vector3d::UnitZ());
      case urdf::Joint::FLOATING:
      {
        const Eigen::Translation3d translation(value(joint.name + "/trans_x", state),
                                               value(joint.name + "/trans_y", state),
                                               value(joint.name + "/trans_z", state));
        return result * translation *
               Eigen::Quaterniond(value(joint.name + "/rot_w", state), value(joint.name + "/rot_x", state),
                                  value(joint.name + "/rot_y", state), value(joint.name + "/rot_z", state))
                   .normalized();
      }
      default:
        return result;
    }
  }

  urdf::ModelInterfaceSharedPtr model_;
  const RobotModel& robot_;
};

void expectSamePoses(const std::string& urdf, const RobotModel& robot, int states)
{
  SCOPED_TRACE(robot.name() + ", seed " + std::to_string(kSeed));
  const NaiveKinematics naive(urdf, robot);
  std::mt19937_64 generator(kSeed);
  std::vector<double> state(robot.variables().size());
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  for (int i = 0; i < states; ++i)
  {
    robot.randomState(generator, state.data());
    robot.linkPoses(state.data(), poses.data());
    const auto expected = naive.linkPoses(state.data());
    ASSERT_EQ(expected.size(), robot.links().size());
    for (std::size_t link = 0; link < poses.size(); ++link)
    {
      // 1e-12 covers the rounding of tens of joints in metres. A wrong formula causes a much larger error.
      ASSERT_TRUE(poses[link].matrix().isApprox(expected.at(robot.links()[link].name).matrix(), 1e-12))
          << robot.links()[link].name;
      ASSERT_EQ(poses[link].matrix().row(3), Eigen::RowVector4d(0, 0, 0, 1));
    }
    std::vector<Eigen::Isometry3d> one_by_one(robot.links().size());
    std::vector<std::uint8_t> known(robot.links().size(), 0);
    for (std::size_t link = poses.size(); link-- > 0;)
    {
      robot.computeLinkPose(state.data(), static_cast<int>(link), one_by_one.data(), known.data());
      ASSERT_EQ(one_by_one[link].matrix(), poses[link].matrix()) << robot.links()[link].name;
    }
  }
}

TEST(Kinematics, AgreesWithANaiveImplementationOnRealRobots)
{
  const std::vector<RealRobot> robots = realRobots();
  if (robots.empty())
    GTEST_SKIP() << "no robot in " << GPS_DART_DATA_DIR << " or " << GPS_SHARED_DIR;
  for (RealRobot robot : robots)
  {
    robot.srdf.clear();  // its virtual joint is not in the URDF
    expectSamePoses(robot.urdfText(), *robot.load(), 100);
  }
}

TEST(Kinematics, AgreesWithANaiveImplementationForEveryJointType)
{
  const std::string origin = R"(<origin xyz="0.1 -0.2 0.3" rpy="0.4 -0.5 0.6"/>)";
  const std::string axis = R"(<axis xyz="1 -2 0.5"/>)";
  std::string urdf;
  for (const char* link : {"l0", "l1", "l2", "l3", "l4", "l5", "l6", "l7", "l8", "l9"})
    urdf += boxLink(link);
  urdf += jointXml("floating", "floating", "l0", "l1", origin);
  urdf += jointXml("planar", "planar", "l1", "l2", origin + R"(<axis xyz="0 0 1"/>)");
  urdf += jointXml("revolute", "revolute", "l2", "l3", origin + axis + kLimits);
  urdf += jointXml("continuous", "continuous", "l3", "l4", origin + axis);
  urdf += jointXml("prismatic", "prismatic", "l4", "l5", origin + axis + kLimits);
  urdf += jointXml("fixed", "fixed", "l5", "l6", origin);
  urdf += jointXml("mimic", "prismatic", "l6", "l7",
                   origin + axis + kLimits + R"(<mimic joint="continuous" multiplier="-0.7" offset="0.2"/>)");
  urdf += jointXml("a_mimic_of_a_mimic", "revolute", "l7", "l8",
                   origin + axis + kLimits + R"(<mimic joint="mimic" multiplier="3" offset="-0.1"/>)");
  urdf += jointXml("short_axis", "continuous", "l7", "l9", R"(<axis xyz="0 1e-200 0"/>)");
  expectSamePoses("<robot name=\"test\">" + urdf + "</robot>", *robotOf(urdf), 200);
}

TEST(Kinematics, OriginsTurnAboutFixedAxesRollFirst)
{
  const auto robot = robotOf(boxLink("a") + boxLink("b") +
                             jointXml("j", "fixed", "a", "b", R"(<origin xyz="1 2 3" rpy="0.4 -0.5 0.6"/>)"));
  std::vector<Eigen::Isometry3d> poses(2);
  robot->linkPoses(nullptr, poses.data());
  const Eigen::Isometry3d expected = Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitZ()) *
                                     Eigen::AngleAxisd(-0.5, Eigen::Vector3d::UnitY()) *
                                     Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX());
  EXPECT_TRUE(poses[1].isApprox(expected, 1e-15));
}

TEST(Kinematics, AStateIsReadWithoutScalingOfItsQuaternion)
{
  const auto robot = robotOf(boxLink("a") + boxLink("b") + jointXml("j", "floating", "a", "b"));
  std::vector<Eigen::Isometry3d> poses(2);
  // The quaternion is twice as long as the unit quaternion of a rotation by 90 degrees about z.
  const double half = std::sqrt(0.5);
  const std::vector<double> state = {1, 2, 3, 0, 0, 2 * half, 2 * half};
  robot->linkPoses(state.data(), poses.data());
  EXPECT_TRUE((poses[1] * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(1, 3, 3), 1e-15));

  const std::vector<double> zero_length = {1, 2, 3, 0, 0, 0, 0};
  robot->linkPoses(zero_length.data(), poses.data());
  EXPECT_EQ(poses[1].linear(), Eigen::Matrix3d::Identity());
  EXPECT_EQ(poses[1].translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(Kinematics, APlanarJointMovesInThePlaneOfItsNormal)
{
  std::mt19937_64 generator(kSeed);
  for (const Eigen::Vector3d& normal : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0, 0, 1),
                                        Eigen::Vector3d(0.36, 0.48, -0.8)})
  {
    const Eigen::Matrix3d directions = planarDirections(normal);
    EXPECT_TRUE(directions.isUnitary(1e-15));
    EXPECT_NEAR(directions.determinant(), 1.0, 1e-15);
    EXPECT_EQ(directions.col(2), normal);

    std::ostringstream axis;
    axis << "<axis xyz=\"" << normal.transpose() << "\"/>";
    const auto robot = robotOf(boxLink("a") + boxLink("b") + jointXml("j", "planar", "a", "b", axis.str()));
    std::vector<double> state(3);
    std::vector<Eigen::Isometry3d> poses(2);
    robot->randomState(generator, state.data());
    robot->linkPoses(state.data(), poses.data());
    const Eigen::Vector3d moved = poses[1].translation();
    EXPECT_NEAR(moved.dot(normal), 0.0, 1e-15);
    EXPECT_NEAR(moved.dot(directions.col(0)), state[0], 1e-15);
    EXPECT_NEAR(moved.dot(directions.col(1)), state[1], 1e-15);
    EXPECT_TRUE(poses[1].linear().isApprox(Eigen::AngleAxisd(state[2], normal).toRotationMatrix(), 1e-14));
  }
  EXPECT_EQ(planarDirections(Eigen::Vector3d::UnitZ()), Eigen::Matrix3d::Identity());
}
}  // namespace
}  // namespace gpu_planning_scene::core
