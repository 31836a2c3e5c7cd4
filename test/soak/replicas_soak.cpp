// Eight clients check with a leader and its replicas. The scene changes ten times a second, and replicas are killed and
// started anew. No answer may be wrong, lost or mixed of two scenes.

#include <atomic>
#include <chrono>
#include <random>
#include <thread>

#include "gpu_planning_scene/client/sharded_checker.h"
#include "node/child_node.h"
#include "node/messages/exact_numbers.h"
#include "node/node_client.h"
#include "soak/answer_judge.h"
#include "soak/latencies.h"
#include "soak/random_requests.h"

namespace gpu_planning_scene::core
{
namespace
{
using Clock = std::chrono::steady_clock;

constexpr std::size_t kReplicas = 3;
constexpr int kClients = 8;
constexpr double kChangePeriod = 0.1;        // seconds
constexpr std::size_t kWaitingAnswers = 20;  // the clients wait while the judge has more
const std::vector<std::string> kNodes = {"/planning_scene", "/replica_0", "/replica_1", "/replica_2"};

class ReplicasSoak : public RunningNode
{
 public:
  static void SetUpTestSuite()
  {
    leader = std::make_unique<ChildNode>("planning_scene", std::vector<std::string>{"_device:=cpu"});
    RunningNode::SetUpTestSuite();
  }
  static void TearDownTestSuite()
  {
    RunningNode::TearDownTestSuite();
    leader.reset();
  }

  static std::unique_ptr<ChildNode> startReplica(std::size_t index)
  {
    return std::make_unique<ChildNode>("replica_" + std::to_string(index),
                                       std::vector<std::string>{"_device:=cpu", "_follow:=/planning_scene"});
  }

  CheckStates::Request randomRequest(std::size_t count, std::mt19937_64& generator) const
  {
    CheckStates::Request request = stateRequest(randomStates(*robot, count, generator));
    if (generator() % 4 == 0)
      leaveOutFirstJoint(request);
    return request;
  }

  void checkStates(std::size_t max_states, std::uint64_t seed)
  {
    std::mt19937_64 generator(seed);
    ShardedChecker checker(kNodes);
    while (!done)
    {
      CheckStates check;
      check.request = randomRequest(1 + generator() % max_states, generator);
      const std::uint64_t acknowledged = newest_change;
      const Clock::time_point start = Clock::now();
      check.response = checker.check(check.request);
      if (check.response.success)
      {
        judge->add(check, acknowledged);
        latencies.add(std::chrono::duration<double>(Clock::now() - start).count());
      }
      else
      {
        ++lost;
        std::printf("no answer: %s\n", check.response.message.c_str());
      }
      // The judge, the nodes and other programs share the processors.
      while (!done && judge->waiting() > kWaitingAnswers)
        ros::WallDuration(0.02).sleep();
    }
  }

  void changeScene(std::uint64_t seed)
  {
    std::mt19937_64 generator(seed);
    std::uniform_real_distribution<double> place(-0.8, 0.8);
    for (Clock::time_point next = Clock::now(); !done;
         next += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(kChangePeriod)))
    {
      std::this_thread::sleep_until(next);
      const std::string id = "object " + std::to_string(generator() % 8);
      CollisionObject object = boxObject(id, {place(generator), place(generator), place(generator)},
                                         0.05 + 0.1 * std::abs(place(generator)));
      object.pose.orientation.x = place(generator);
      object.pose.orientation.w = 1.0;
      PlanningSceneMessage change = diffScene();
      if (generator() % 5 == 0)
        object = objectOperation(id, CollisionObject::REMOVE);
      if (generator() % 5 == 0)
      {
        change.robot_state.joint_state.name = {robot->variables()[0].name};
        change.robot_state.joint_state.position = {place(generator)};
      }
      addObject(change, object, tip, generator);
      ApplyPlanningScene call;
      call.request.scene = change;
      if (!callPersistently(name("apply_planning_scene"), call))
        ++lost;
      ++requested_changes;
      if (!call.response.success)
        continue;
      ++changes;
      newest_change = call.response.scene_revision;
    }
  }

  void killReplicas(std::uint64_t seed)
  {
    std::mt19937_64 generator(seed);
    while (!done)
    {
      ros::WallDuration(2.0 + 0.001 * static_cast<double>(generator() % 2000)).sleep();
      const std::size_t victim = generator() % kReplicas;
      replicas[victim].reset();
      ros::WallDuration(0.5).sleep();
      replicas[victim] = startReplica(victim);
      ++killed;
    }
  }

  static std::unique_ptr<ChildNode> leader;
  std::vector<std::unique_ptr<ChildNode>> replicas;
  std::atomic<bool> done{false};
  std::atomic<int> lost{0}, requested_changes{0}, changes{0}, killed{0};
  std::atomic<std::uint64_t> newest_change{0};
  std::unique_ptr<AnswerJudge> judge;
  Latencies latencies;
};
std::unique_ptr<ChildNode> ReplicasSoak::leader;

TEST_F(ReplicasSoak, NoAnswerIsWrongLostOrMixed)
{
  const double seconds = ros::param::param<double>("~seconds", 60.0);
  SceneHistory history(robot);
  for (int i = 0; i < 100 && !history.listens(); ++i)
    ros::WallDuration(0.1).sleep();
  ros::WallDuration(0.5).sleep();
  history.start(scene(2 * kForFollowers - 1));
  judge = std::make_unique<AnswerJudge>(history, static_cast<std::size_t>(ros::param::param("~oracle_samples", 100)));
  for (std::size_t i = 0; i < kReplicas; ++i)
    replicas.push_back(startReplica(i));

  std::vector<std::thread> threads;
  for (int i = 0; i < kClients; ++i)
    threads.emplace_back([this, i] { checkStates(i < kClients / 2 ? 100 : 16000, static_cast<std::uint64_t>(i)); });
  threads.emplace_back([this] { changeScene(100); });
  threads.emplace_back([this] { killReplicas(200); });
  ros::WallDuration(seconds).sleep();
  done = true;
  for (std::thread& thread : threads)
    thread.join();
  judge->finish();

  std::printf("%g s: %d of %d requested changes were possible, %d replicas killed\n", seconds, changes.load(),
              requested_changes.load(), killed.load());
  latencies.print();
  judge->expectNoWrongAnswer();
  EXPECT_EQ(0, history.gaps());
  EXPECT_EQ(0, lost);
  EXPECT_GT(judge->answers, 30u);
  EXPECT_GT(requested_changes, static_cast<int>(9.0 * seconds));
  EXPECT_GT(changes, static_cast<int>(3.0 * seconds));
  EXPECT_GT(killed, 1);
}
}  // namespace
}  // namespace gpu_planning_scene::core
