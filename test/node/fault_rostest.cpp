// A node whose device is lost still answers, and its diagnostics report that the CPU has taken over.

#include <mutex>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <rosgraph_msgs/Log.h>

#include "node/child_node.h"
#include "node/node_client.h"
#include "support/software_device.h"

namespace gpu_planning_scene::core
{
namespace
{
using diagnostic_msgs::DiagnosticStatus;

class Fault : public RunningNode
{
};

TEST_F(Fault, DiagnosticsReportThatTheCpuHasTakenOver)
{
  if (const std::string why = whyNoSoftwareDevice(); !why.empty())
    GTEST_SKIP() << why;
  // The node loses its device in one of several hundred calls. With device_losses 1 the CPU takes over at the first
  // loss.
  const ChildNode node("faulty_node", {"_device:=software", "_device_only:=true", "_device_losses:=1"},
                       GPS_FAULTY_NODE);
  std::mutex mutex;
  DiagnosticStatus latest;
  ros::NodeHandle handle;
  const ros::Subscriber subscriber =
      handle.subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10,
                                                         [&](const diagnostic_msgs::DiagnosticArray::ConstPtr& message)
                                                         {
                                                           const std::lock_guard<std::mutex> lock(mutex);
                                                           if (message->status.at(0).name == "faulty_node: checks")
                                                             latest = message->status.at(0);
                                                         });
  std::string warning;
  const ros::Subscriber log = handle.subscribe<rosgraph_msgs::Log>(
      "/rosout", 100,
      [&](const rosgraph_msgs::Log::ConstPtr& message)
      {
        const std::lock_guard<std::mutex> lock(mutex);
        if (message->name == "/faulty_node" && message->level == rosgraph_msgs::Log::WARN)
          warning = message->msg;
      });
  const auto level = [&]
  {
    const std::lock_guard<std::mutex> lock(mutex);
    return latest.level;
  };
  for (int i = 0; i < 100000 && level() == DiagnosticStatus::OK; ++i)
  {
    CheckStates call;
    call.request = stateRequest(free_state);
    ASSERT_TRUE(callPersistently(node.service("check_states"), call));
    ASSERT_TRUE(call.response.success) << call.response.message;
    ASSERT_EQ(1, call.response.valid.at(0));
  }
  EXPECT_EQ(DiagnosticStatus::WARN, level());
  ros::Duration(1.0).sleep();  // for the log
  const std::lock_guard<std::mutex> lock(mutex);
  EXPECT_EQ(0u, latest.message.find("the device failed and the CPU is used: ")) << latest.message;
  EXPECT_EQ(latest.message + "; the answers stay the same", warning);
}
}  // namespace
}  // namespace gpu_planning_scene::core
