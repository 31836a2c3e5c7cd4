// Eight clients run for minutes. They check states, change the scene, send wrong requests, and start processes that are
// killed. The device fails now and then. No answer may be wrong, no reply may be lost, and the node's memory must not
// grow.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstring>
#include <random>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <spawn.h>
#include <sys/wait.h>

#include "node/messages/exact_numbers.h"
#include "node/node_client.h"
#include "node/persistent_call.h"
#include "soak/answer_judge.h"
#include "soak/latencies.h"
#include "soak/memory_record.h"
#include "soak/random_requests.h"

extern char** environ;

namespace gpu_planning_scene::core
{
namespace
{
using Clock = std::chrono::steady_clock;

class Soak : public RunningNode
{
 public:
  template <class Service>
  bool ask(const std::string& service, Service& request)
  {
    ++requests;
    if (callPersistently(name(service), request))
      return true;
    ++lost;
    std::printf("no reply from %s\n", service.c_str());
    return false;
  }

  void checkStates(std::size_t max_states, std::uint64_t seed)
  {
    std::mt19937_64 generator(seed);
    while (!done)
    {
      CheckStates check;
      check.request = stateRequest(randomStates(*robot, 1 + generator() % max_states, generator));
      if (generator() % 4 == 0)
        leaveOutFirstJoint(check.request);
      if (check.request.positions.size() < 200 && generator() % 8 == 0)
      {
        check.request.max_contacts = 3;
        check.request.clearance = true;
      }
      const std::uint64_t acknowledged = newest_change;
      const Clock::time_point start = Clock::now();
      if (!ask("check_states", check))
        continue;
      if (!check.response.success)
      {
        ++(check.response.status == gpu_planning_scene::AnswerStatus::BUSY ? busy : failed);
        continue;
      }
      latencies.add(std::chrono::duration<double>(Clock::now() - start).count());
      judge->add(check, acknowledged);
      ++answered;
      ros::WallDuration(0.005).sleep();
    }
  }

  void changeScene(std::uint64_t seed)
  {
    std::mt19937_64 generator(seed);
    std::uniform_real_distribution<double> place(-1.0, 1.0);
    while (!done)
    {
      const std::string id = "object " + std::to_string(seed) + "." + std::to_string(generator() % 8);
      CollisionObject object = boxObject(id, {place(generator), place(generator), place(generator)},
                                         0.05 + 0.1 * std::abs(place(generator)));
      PlanningSceneMessage change = diffScene();
      switch (generator() % 7)
      {
        case 0:
          object = objectOperation(id, CollisionObject::REMOVE);
          break;
        case 1:
          object.operation = CollisionObject::APPEND;
          break;
        case 2:
          change.link_padding.resize(1);
          change.link_padding[0].link_name = tip;
          change.link_padding[0].padding = 0.02 * std::abs(place(generator));
          break;
        case 3:
          change.robot_state.joint_state.name = {robot->variables()[0].name};
          change.robot_state.joint_state.position = {place(generator)};
          break;
        default:
          break;
      }
      addObject(change, object, tip, generator);
      ApplyPlanningScene apply_change;
      apply_change.request.scene = change;
      if (ask("apply_planning_scene", apply_change))
        ++(apply_change.response.success ? changes : refused);
      std::uint64_t known = newest_change;
      while (known < apply_change.response.scene_revision &&
             !newest_change.compare_exchange_weak(known, apply_change.response.scene_revision))
        ;
      ros::WallDuration(0.02).sleep();
    }
  }

  /// Sends requests that must all be refused and must not affect other clients.
  void askWrongly(std::uint64_t seed)
  {
    std::mt19937_64 generator(seed);
    while (!done)
    {
      CheckStates wrong;
      wrong.request = stateRequest(randomStates(*robot, 2, generator));
      switch (generator() % 4)
      {
        case 0:
          wrong.request.positions[0] = std::numeric_limits<double>::quiet_NaN();
          break;
        case 1:
          wrong.request.positions.pop_back();
          break;
        case 2:
          wrong.request.group = "no such group";
          break;
        default:
          wrong.request.joint_names[0] = "no such joint";
      }
      if (ask("check_states", wrong))
        taken += wrong.response.success ? 1 : 0;
      ros::WallDuration(0.02).sleep();
    }
  }

  /// Starts clients as separate processes and kills them while they wait for an answer.
  void killClients()
  {
    int number = 0;
    while (!done)
    {
      const std::string victim = "victim_" + std::to_string(++number);
      for (const char* key : {"urdf", "srdf", "packages"})
        if (XmlRpc::XmlRpcValue value; ros::param::get(std::string("~") + key, value))
          ros::param::set("/" + victim + "/" + key, value);
      const std::string node_name = "__name:=" + victim;
      std::vector<char*> arguments = {const_cast<char*>("soak"), const_cast<char*>("--victim"),
                                      const_cast<char*>(node_name.c_str()), nullptr};
      pid_t child = 0;
      ASSERT_EQ(0, posix_spawn(&child, "/proc/self/exe", nullptr, nullptr, arguments.data(), environ));
      ros::WallDuration(1.5).sleep();
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
      ++killed;
    }
  }

  /// Whether enough has happened for the test to mean something.
  bool hasHappenedEnough()
  {
    const std::lock_guard<std::mutex> lock(mutex);
    return answered > 30 && changes > 50 && killed > 5 && losses > 0.0;
  }

  std::atomic<bool> done{false};
  std::atomic<int> requests{0}, answered{0}, lost{0}, busy{0}, failed{0}, changes{0}, refused{0}, taken{0}, killed{0};
  std::atomic<std::uint64_t> newest_change{0};  ///< revision of the newest acknowledged change
  std::unique_ptr<AnswerJudge> judge;
  std::mutex mutex;
  Latencies latencies;
  MemoryRecord memory;
  double losses = 0.0;
};

TEST_F(Soak, NoAnswerIsWrongNoReplyIsLostAndMemoryIsFlat)
{
  const double seconds = ros::param::param<double>("~seconds", 60.0);
  SceneHistory history(robot);
  for (int i = 0; i < 100 && !history.listens(); ++i)
    ros::WallDuration(0.1).sleep();
  ros::WallDuration(0.5).sleep();
  history.start(scene(2 * kForFollowers - 1));
  judge = std::make_unique<AnswerJudge>(history, static_cast<std::size_t>(ros::param::param("~oracle_samples", 100)));
  ros::NodeHandle node;
  const ros::Subscriber diagnostics =
      node.subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10,
                                                       [this](const diagnostic_msgs::DiagnosticArray::ConstPtr& message)
                                                       {
                                                         const std::lock_guard<std::mutex> lock(mutex);
                                                         for (const auto& value : message->status.at(0).values)
                                                         {
                                                           if (value.key == "memory")
                                                             memory.add(std::stod(value.value));
                                                           if (value.key == "device_losses")
                                                             losses = std::stod(value.value);
                                                         }
                                                       });

  std::vector<std::thread> clients;
  for (std::uint64_t i = 0; i < 3; ++i)
    clients.emplace_back([this, i] { checkStates(64, 100 + i); });
  clients.emplace_back([this] { checkStates(3000, 200); });
  clients.emplace_back([this] { changeScene(1); });
  clients.emplace_back([this] { changeScene(2); });
  clients.emplace_back([this] { askWrongly(300); });
  clients.emplace_back([this] { killClients(); });
  ros::WallDuration(seconds).sleep();
  // A slow machine, with sanitizers and llvmpipe, gets more time. The test's time limit allows it.
  for (double more = 0.0; more < 2.0 * seconds + 100.0 && !hasHappenedEnough(); more += 0.5)
    ros::WallDuration(0.5).sleep();
  done = true;
  for (std::thread& client : clients)
    client.join();
  judge->finish();

  const std::lock_guard<std::mutex> lock(mutex);
  std::printf("%g s: %d requests, %d changes, %d refused, %d busy, %d clients killed, %g devices lost\n", seconds,
              requests.load(), changes.load(), refused.load(), busy.load(), killed.load(), losses);
  latencies.print();
  memory.expectFlat(seconds);
  judge->expectNoWrongAnswer();
  EXPECT_EQ(0, history.gaps());
  EXPECT_EQ(0, lost) << "requests without a reply";
  EXPECT_EQ(0, failed) << "right requests that were refused, and not for want of time";
  EXPECT_EQ(0, taken) << "wrong requests that were not refused";
  EXPECT_GT(judge->answers, 30u);
  EXPECT_GT(changes, 50);
  EXPECT_GT(killed, 5);
  EXPECT_GT(losses, 0.0) << "the test is to lose devices";
}

/// Sends requests until the process is killed.
int runVictim()
{
  RunningNode::SetUpTestSuite();
  std::mt19937_64 generator(1);
  const std::vector<double> states = randomStates(*RunningNode::robot, 20000, generator);
  for (;;)
  {
    CheckStates check;
    check.request = RunningNode::stateRequest(states);
    ros::service::call(RunningNode::name("check_states"), check);
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core

int main(int argc, char** argv)
{
  testing::InitGoogleTest(&argc, argv);
  const bool victim = argc > 1 && std::strcmp(argv[1], "--victim") == 0;
  ros::init(argc, argv, "soak");
  ros::AsyncSpinner spinner(2);
  spinner.start();
  return victim ? gpu_planning_scene::core::runVictim() : RUN_ALL_TESTS();
}
