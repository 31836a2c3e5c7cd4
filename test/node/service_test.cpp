// What the node does with requests, joint states and the package parameter, without a ROS master.

#include <limits>

#include <gtest/gtest.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "model/model_testing.h"
#include "node/check_states_service.h"
#include "node/current_state.h"
#include "node/node_parameters.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene
{
namespace
{
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The slider robot and a wall from x = 0.9 to 1.1 m that the cart meets.
std::shared_ptr<const PlanningScene> sceneWithWall()
{
  PlanningScene scene(sliderRobot());
  WorldObject wall;
  wall.id = "wall";
  wall.pose.translation() = Eigen::Vector3d(1.0, 0.0, 0.0);
  wall.shapes.push_back({Box{Eigen::Vector3d(0.2, 1.0, 0.2)}, Eigen::Isometry3d::Identity()});
  scene.objects.push_back(wall);
  scene.revision = 5;
  return std::make_shared<const PlanningScene>(scene);
}

CheckStates::Request request(const std::vector<std::string>& names, const std::vector<double>& positions)
{
  CheckStates::Request result;
  result.joint_names = names;
  result.positions = positions;
  return result;
}

class Service : public testing::Test
{
 public:
  CheckStates::Response answer(const CheckStates::Request& asked)
  {
    return answerCheckStates(asked, *scene, state, checker);
  }

  void expectRefusal(const CheckStates::Request& asked, const std::string& reason)
  {
    const CheckStates::Response response = answer(asked);
    EXPECT_FALSE(response.success);
    EXPECT_NE(std::string::npos, response.message.find(reason)) << response.message;
    EXPECT_EQ(std::string::npos, response.message.find('\n')) << response.message;
    EXPECT_TRUE(response.valid.empty());
  }

  std::shared_ptr<const PlanningScene> scene = sceneWithWall();
  PartialState state{*scene->robot};
  CpuChecker checker{scene};
};

TEST_F(Service, answersEachStateInOrder)
{
  const CheckStates::Response response = answer(request({"turn", "slide"}, {0.5, 0.0, 0.5, 1.0, 1.0, 0.5}));
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_EQ("", response.message);
  EXPECT_EQ((std::vector<std::uint8_t>{1, 0, 1}), response.valid);
  ASSERT_EQ(3u, response.body_1.size());
  ASSERT_EQ(3u, response.body_2.size());
  EXPECT_EQ("", response.body_1[0] + response.body_2[0]);
  EXPECT_EQ("cartwall",
            std::min(response.body_1[1], response.body_2[1]) + std::max(response.body_1[1], response.body_2[1]));
  EXPECT_EQ(5u, response.scene_revision);
}

TEST_F(Service, otherVariablesTakeTheCurrentState)
{
  expectRefusal(request({"turn"}, {0.0}), "no value for slide");
  state = PartialState(*scene->robot, {1.0, 0.0});
  EXPECT_EQ((std::vector<std::uint8_t>{0}), answer(request({"turn"}, {0.5})).valid);
  state.known[0] = false;
  expectRefusal(request({"turn"}, {0.0}), "no value for slide");
}

TEST_F(Service, noStatesGetNoAnswers)
{
  const CheckStates::Response response = answer(request({"turn", "slide"}, {}));
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_TRUE(response.valid.empty());
}

TEST_F(Service, wrongRequestsAreRefusedWithTheReason)
{
  expectRefusal(request({}, {}), "joint_names is empty");
  expectRefusal(request({}, {1.0}), "joint_names is empty");
  expectRefusal(request({"turn", "slide"}, {0.0, 0.0, 0.0}), "3 positions are not rows of 2");
  expectRefusal(request({"turn", "slid"}, {0.0, 0.0}), "no variable 'slid'");
  expectRefusal(request({"turn", "flag"}, {0.0, 0.0}), "'flag' follows another");
  expectRefusal(request({"turn", "turn"}, {0.0, 0.0}), "'turn' is given twice");
  expectRefusal(request({"turn", "slide"}, {0.0, 0.0, kNan, 0.0}), "state 1: the position of 'turn'");
  expectRefusal(request({"turn", "slide"}, {0.0, kInfinity}), "state 0: the position of 'slide'");
  CheckStates::Request unknown_group = request({"turn", "slide"}, {0.0, 0.0});
  unknown_group.group = "sails";
  expectRefusal(unknown_group, "sails");
}

TEST_F(Service, contactsThatCannotBeGivenDoNotSpoilTheAnswer)
{
  CheckStates::Request with_contacts = request({"turn", "slide"}, {0.0, 1.0});
  with_contacts.max_contacts = 10;
  EXPECT_EQ((std::vector<std::uint8_t>{0}), answer(with_contacts).valid);
}

class FailingChecker : public StateChecker
{
 public:
  void setScene(std::shared_ptr<const PlanningScene>) override {}
  BatchResult check(const double*, std::size_t, const std::string&) override
  {
    throw std::runtime_error("device lost");
  }
  SceneReport report(const std::string&) override { return {}; }
  std::string deviceName() const override { return ""; }
};

TEST_F(Service, aFailureOfTheDeviceIsAnAnswer)
{
  FailingChecker failing;
  const auto response = answerCheckStates(request({"turn", "slide"}, {0.0, 0.0}), *scene, state, failing);
  EXPECT_FALSE(response.success);
  EXPECT_EQ("device lost", response.message);
}

sensor_msgs::JointState jointState(const std::vector<std::string>& names, const std::vector<double>& positions)
{
  sensor_msgs::JointState message;
  message.name = names;
  message.position = positions;
  return message;
}

TEST(JointStates, updateWhatTheyNameOfTheRobot)
{
  CurrentState current(sceneWithWall());
  EXPECT_EQ((std::vector<bool>{false, false}), current.get().known);
  current.update(jointState({"wheel", "turn", "flag", "bolt"}, {9.0, 0.5, 8.0, 7.0}));
  EXPECT_EQ((std::vector<bool>{false, true}), current.get().known);
  EXPECT_EQ(0.5, current.get().values[1]);
  current.update(jointState({"slide"}, {0.25}));
  EXPECT_EQ((std::vector<bool>{true, true}), current.get().known);
  EXPECT_EQ((std::vector<double>{0.25, 0.5}), current.get().values);
  current.update(jointState({"slide", "turn"}, {}));  // a driver that reports velocities alone
  EXPECT_EQ((std::vector<double>{0.25, 0.5}), current.get().values);
}

TEST(JointStates, aWrongMessageChangesNothing)
{
  CurrentState current(sceneWithWall());
  current.update(jointState({"slide", "turn"}, {0.25, 0.5}));
  EXPECT_THROW(current.update(jointState({"slide", "turn"}, {1.0, kNan})), Error);
  EXPECT_THROW(current.update(jointState({"slide", "turn"}, {1.0})), Error);
  EXPECT_EQ((std::vector<double>{0.25, 0.5}), current.get().values);
  current.update(jointState({"slide", "wheel"}, {1.0, kNan}));  // what is wrong is not this robot's
  EXPECT_EQ(1.0, current.get().values[0]);
}

TEST(PackagesParameter, isAMapOrAList)
{
  const std::map<std::string, std::string> expected = {{"arm", "/opt/arm"}, {"hand", "/opt/hand"}};
  XmlRpc::XmlRpcValue map;
  map["arm"] = "/opt/arm";
  map["hand"] = "/opt/hand";
  EXPECT_EQ(expected, packageFolders(map));
  XmlRpc::XmlRpcValue list;
  list[0] = "arm=/opt/arm";
  list[1] = "hand: /opt/hand";
  EXPECT_EQ(expected, packageFolders(list));
  XmlRpc::XmlRpcValue list_of_maps;
  list_of_maps[0]["arm"] = "/opt/arm";
  list_of_maps[1]["hand"] = "/opt/hand";
  EXPECT_EQ(expected, packageFolders(list_of_maps));
}

TEST(PackagesParameter, anythingElseIsRefused)
{
  XmlRpc::XmlRpcValue number(5);
  EXPECT_NE(std::string::npos, errorOf([&] { packageFolders(number); }).find("~packages"));
  XmlRpc::XmlRpcValue text("arm");
  EXPECT_NE(std::string::npos, errorOf([&] { packageFolders(text); }).find("'arm' is not NAME=DIR"));
  XmlRpc::XmlRpcValue map;
  map["arm"] = 5;
  EXPECT_NE(std::string::npos, errorOf([&] { packageFolders(map); }).find("'arm' is not a string"));
}
}  // namespace
}  // namespace gpu_planning_scene
