// Run by rostest beside a planning_scene_node. Over ROS the node answers as the library does, also to several clients
// at once, and survives wrong requests. The parameters of this test's own node name the files that the node was started
// with.

#include <atomic>
#include <limits>
#include <thread>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include "collision/checkers/open_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "node/messages/messages.h"
#include "node/persistent_call.h"
#include "tools/run_program.h"

namespace gpu_planning_scene::core
{
namespace
{
const char* const kService = "/planning_scene/check_states";

std::string parameter(const std::string& name)
{
  return ros::param::param<std::string>("~" + name, "");
}

class Node : public testing::Test
{
 public:
  static void SetUpTestSuite()
  {
    robot = RobotModel::fromFiles(parameter("urdf"), parameter("srdf"), {});
    const std::string scene_file = parameter("scene");
    scene = std::make_shared<const PlanningScene>(scene_file.empty() ? PlanningScene(robot)
                                                                     : loadSceneFile(scene_file, robot, {}));
    ASSERT_TRUE(ros::service::waitForService(kService, ros::Duration(60.0)));
  }
  static void TearDownTestSuite()
  {
    scene.reset();
    robot.reset();
  }

  static std::vector<double> randomStates(std::size_t count, std::uint64_t seed)
  {
    std::mt19937_64 generator(seed);
    std::vector<double> states(count * robot->variables().size());
    for (std::size_t i = 0; i < count; ++i)
      robot->randomState(generator, states.data() + i * robot->variables().size());
    return states;
  }

  /// A request with all variables in the robot's order.
  static CheckStates request(const std::vector<double>& states)
  {
    CheckStates call;
    for (const Variable& variable : robot->variables())
      call.request.joint_names.push_back(variable.name);
    call.request.positions = states;
    return call;
  }

  /// Expects that the node answers with a refusal.
  static void expectRefusal(CheckStates call, const std::string& reason,
                            std::uint8_t status = AnswerStatus::INVALID_REQUEST)
  {
    ASSERT_TRUE(callPersistently(kService, call)) << "no answer, expected: " << reason;
    EXPECT_FALSE(call.response.success);
    EXPECT_EQ(status, call.response.status);
    EXPECT_NE(std::string::npos, call.response.message.find(reason)) << call.response.message;
    EXPECT_TRUE(call.response.valid.empty());
  }

  static std::shared_ptr<const RobotModel> robot;
  static std::shared_ptr<const PlanningScene> scene;
};
std::shared_ptr<const RobotModel> Node::robot;
std::shared_ptr<const PlanningScene> Node::scene;

TEST_F(Node, AnswersFourClientsAtOnceAsTheLibraryDoes)
{
  BatchCheckerOptions options;
  options.device = parameter("device");
  const auto checker = openChecker(scene, options, [](const std::string&) {});
  constexpr int kClients = 4;
  constexpr int kRounds = 5;
  std::atomic<int> failures{0};
  std::atomic<int> valid{0};
  std::atomic<int> states{0};
  const auto client = [&](int number)
  {
    for (int round = 0; round < kRounds; ++round)
    {
      const std::size_t count = 1 + 400 * static_cast<std::size_t>(round) + 7 * static_cast<std::size_t>(number);
      const std::vector<double> batch =
          randomStates(count, 100 * static_cast<std::uint64_t>(number) + static_cast<std::uint64_t>(round));
      CheckStates call = request(batch);
      const BatchResult expected = checker->check(batch.data(), count);
      if (!callPersistently(kService, call) || !call.response.success || call.response.valid != expected.valid)
        ++failures;
      for (std::size_t i = 0; i < call.response.valid.size(); ++i)
      {
        const bool free = call.response.valid[i] != 0;
        if (free != call.response.body_1.at(i).empty() || free != call.response.body_2.at(i).empty())
          ++failures;
        valid += free ? 1 : 0;
        ++states;
      }
    }
  };
  std::vector<std::thread> threads;
  threads.reserve(kClients);
  for (int i = 0; i < kClients; ++i)
    threads.emplace_back(client, i);
  for (std::thread& thread : threads)
    thread.join();
  EXPECT_EQ(0, failures);
  EXPECT_GT(10 * valid, states) << "hardly any state is valid: the comparison says little";
  EXPECT_LT(10 * valid, 9 * states) << "hardly any state collides: the comparison says little";
}

TEST_F(Node, RefusesWrongRequestsAndLivesOn)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> states = randomStates(2, 1);
  CheckStates wrong = request(states);
  wrong.request.group = "no such group";
  expectRefusal(wrong, "no such group");
  wrong = request(states);
  wrong.request.joint_names[0] = "no such joint";
  expectRefusal(wrong, "no such joint");
  wrong = request(states);
  wrong.request.positions.pop_back();
  expectRefusal(wrong, "positions are not rows");
  wrong = request(states);
  wrong.request.positions[0] = nan;
  expectRefusal(wrong, "not a finite number");
  expectRefusal(CheckStates(), "no value for", AnswerStatus::UNAVAILABLE);

  CheckStates right = request(states);
  ASSERT_TRUE(callPersistently(kService, right));
  EXPECT_TRUE(right.response.success) << right.response.message;
  EXPECT_EQ(2u, right.response.valid.size());
}

TEST_F(Node, TakesVariablesThatARequestLeavesOutFromJointStates)
{
  CheckStates partial;
  partial.request.joint_names = {robot->variables()[0].name};
  partial.request.positions = {0.0};
  ASSERT_TRUE(scene->current_state.empty()) << "the test needs a scene without a robot_state";
  expectRefusal(partial, "no value for", AnswerStatus::UNAVAILABLE);

  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<sensor_msgs::JointState>("/joint_states", 1, true);
  sensor_msgs::JointState message;
  for (const Variable& variable : robot->variables())
  {
    message.name.push_back(variable.name);
    message.position.push_back(0.5 * (variable.lower + variable.upper));
  }
  publisher.publish(message);
  for (int i = 0; i < 100 && !partial.response.success; ++i)
  {
    ros::Duration(0.1).sleep();
    ASSERT_TRUE(callPersistently(kService, partial));
  }
  EXPECT_TRUE(partial.response.success) << partial.response.message;
  std::vector<double> state = message.position;
  state[0] = 0.0;
  EXPECT_EQ(CpuChecker(scene).check(state.data(), 1).valid, partial.response.valid);
}

/// Expects that a node with these arguments ends with exit code 1 and one line that gives the reason.
void expectNoStart(std::vector<std::string> arguments, const std::string& reason)
{
  // Private parameters outlive their node, so each node gets a different name.
  static int number = 0;
  const std::string urdf = parameter("urdf");
  arguments.push_back("__name:=broken_" + std::to_string(++number));
  arguments.push_back("_urdf_folder:=" + urdf.substr(0, urdf.rfind('/')));
  const ProgramOutput output = runProgram(GPS_NODE, arguments);
  EXPECT_EQ(1, output.exit_code);
  const auto lines = linesOf(output.err);
  ASSERT_EQ(1u, lines.size()) << output.err;
  EXPECT_NE(std::string::npos, lines[0].find("FATAL")) << lines[0];
  EXPECT_NE(std::string::npos, lines[0].find(reason)) << lines[0];
}

TEST_F(Node, DoesNotStartOnWhatItCannotUse)
{
  ros::param::set("/broken_description", "<robot name=");
  ros::param::set("/number_description", 5.5);
  expectNoStart({"robot_description:=broken_description"}, "parameter /broken_description:1: malformed XML");
  expectNoStart({"robot_description:=broken_description", "_urdf_source:=/cell/robot.urdf"},
                "/cell/robot.urdf:1: malformed XML");
  expectNoStart({"robot_description:=number_description"}, "number_description is not a string");
  expectNoStart({"robot_description:=missing_description"}, "missing_description is not set");
  expectNoStart({"_scene:=/no/such/scene.yaml"}, "/no/such/scene.yaml");
  expectNoStart({"_scene:=scene.yaml"}, "neither an absolute path");
  expectNoStart({"_device:=no such renderer"}, "no such renderer");
  expectNoStart({"_traversal:=depth_first"}, "depth_first");
  expectNoStart({"_max_batch:=0"}, "max_batch is not an integer");
  expectNoStart({"_packages:=5"}, "~packages");
}

TEST_F(Node, AnswersArgumentsThatAreNotOfRosWithoutStarting)
{
  const ProgramOutput help = runProgram(GPS_NODE, {"__name:=helped", "--help"});
  EXPECT_EQ(0, help.exit_code);
  EXPECT_NE(std::string::npos, help.out.find("usage: planning_scene_node [NAME:=VALUE ...]")) << help.out;
  EXPECT_EQ("", help.err);
  const ProgramOutput wrong = runProgram(GPS_NODE, {"arm.urdf", "_device:=cpu"});
  EXPECT_EQ(2, wrong.exit_code);
  EXPECT_EQ(1u, linesOf(wrong.err).size()) << wrong.err;
  EXPECT_NE(std::string::npos, wrong.err.find("unknown argument 'arm.urdf'")) << wrong.err;
}

TEST_F(Node, EndsAtASignalWhileItWaitsForTheMaster)
{
  for (const char* signal : {"--signal=INT", "--signal=TERM"})
  {
    const ProgramOutput output = runProgram(
        "/usr/bin/env", {"ROS_MASTER_URI=http://localhost:1", "timeout", signal, "--kill-after=10", "1", GPS_NODE});
    EXPECT_EQ(124, output.exit_code) << signal << ": 137 if it had to be killed";
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core

int main(int argc, char** argv)
{
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "node_rostest");
  ros::AsyncSpinner spinner(1);
  spinner.start();
  return RUN_ALL_TESTS();
}
