// What clients see of a node that has too much to do, and of one that is ended while it works.

#include <atomic>
#include <mutex>
#include <thread>

#include "node/child_node.h"
#include "node/node_client.h"

namespace gpu_planning_scene
{
namespace
{
class Load : public RunningNode
{
 public:
  static CheckStates requestOf(std::size_t states)
  {
    CheckStates call;
    std::vector<double> many;
    for (std::size_t i = 0; i < states; ++i)
      many.insert(many.end(), free_state.begin(), free_state.end());
    call.request = stateRequest(many);
    return call;
  }

  /// Calls `ask` on so many threads at once, with the number of the thread.
  template <class Ask>
  static void together(int threads, Ask ask)
  {
    std::vector<std::thread> clients;
    clients.reserve(static_cast<std::size_t>(threads));
    for (int i = 0; i < threads; ++i)
      clients.emplace_back(ask, i);
    for (std::thread& client : clients)
      client.join();
  }
};

TEST_F(Load, whatIsTooMuchIsToldBusyAtOnceAndTheRestIsAnswered)
{
  const ChildNode node("hurried_node", {"_device:=cpu", "_limits/waiting_requests:=1", "_small_request:=1"});
  std::atomic<int> right{0}, busy{0}, other{0};
  together(12,
           [&](int)
           {
             CheckStates call = requestOf(200000);
             if (!callPersistently(node.service("check_states"), call))
               ++other;
             else if (call.response.success)
               ++(call.response.valid.size() == 200000 ? right : other);
             else
               ++(call.response.message.rfind("busy: ", 0) == 0 ? busy : other);
           });
  EXPECT_EQ(0, other) << "calls with neither an answer nor \"busy\"";
  EXPECT_GE(right, 1);
  EXPECT_GE(busy, 1);

  CheckStates after = requestOf(1);
  ASSERT_TRUE(callPersistently(node.service("check_states"), after));
  EXPECT_TRUE(after.response.success) << after.response.message;
}

TEST_F(Load, aNodeThatIsEndedAnswersAllThatItHasTaken)
{
  ChildNode node("ended_node", {"_device:=cpu", "_small_request:=1"});
  std::atomic<int> right{0}, told{0}, other{0};
  std::atomic<int> asked{0};
  std::thread ending(
      [&]
      {
        while (asked < 8)
          ros::WallDuration(0.01).sleep();
        ros::WallDuration(0.3).sleep();  // that is long enough for all to have come
        node.interrupt();
      });
  together(8,
           [&](int)
           {
             CheckStates warm = requestOf(1);
             callPersistently(node.service("check_states"), warm);
             CheckStates call = requestOf(300000);
             ++asked;
             if (!callPersistently(node.service("check_states"), call))
               ++other;
             else if (call.response.success)
               ++(call.response.valid.size() == 300000 ? right : other);
             else
               ++(call.response.message.find("shutting down") != std::string::npos ? told : other);
           });
  ending.join();
  EXPECT_EQ(0, other) << "requests that were taken and got no reply, or a wrong one";
  EXPECT_EQ(8, right + told);
  EXPECT_EQ(0, node.wait(20.0)) << "its exit code";
}
}  // namespace
}  // namespace gpu_planning_scene
