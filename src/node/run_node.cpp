#include "node/run_node.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <malloc.h>
#include <sched.h>

#include <ros/poll_manager.h>
#include <ros/ros.h>

#include "node/serve.h"
#include "planners/planner_loader.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr char kUsage[] =
    "usage: planning_scene_node [NAME:=VALUE ...]\n"
    "Holds a planning scene that clients can change, and checks robot states for collision over ROS.\n"
    "It reads the robot from the parameters robot_description and robot_description_semantic. Its other\n"
    "settings are private parameters, for example _device:=cpu. planning_scene.launch sets them all: see\n"
    "roslaunch --ros-args gpu_planning_scene planning_scene.launch, and docs/node.md.\n";

volatile std::sig_atomic_t stop_requested = 0;

void requestStop(int)
{
  stop_requested = 1;
}

/// glibc gives threads different heaps, and memory freed in one heap does not serve the threads of the others. The node
/// has a thread for each waiting request, and destroys scenes and devices on other threads than it made them on. So
/// with several heaps the process would grow for hours. glibc makes the heaps when threads first allocate, so the limit
/// is set before roscpp starts its threads.
void useOneHeap()
{
  mallopt(M_ARENA_MAX, 1);
}

/// roscpp has one thread for all sockets. It wakes when another thread writes an answer. If it takes that thread's core
/// at this moment, it spins until the end of its time slice: the socket is ready, and only the other thread may write.
/// Of answers that follow each other, one in fifty took 3 to 4 ms instead of 0.2. Linux does not let a thread of the
/// policy SCHED_BATCH take the core of a running thread when it wakes.
void runPollThreadAsBatch()
{
  ros::PollManager::instance()->addPollThreadListener(
      []
      {
        static bool is_done = false;  // the listener is called before each poll, on the same thread
        if (std::exchange(is_done, true) || sched_getscheduler(0) != SCHED_OTHER)
          return;
        const sched_param no_priority{};
        if (sched_setscheduler(0, SCHED_BATCH, &no_priority) != 0)
          ROS_WARN("cannot run roscpp's poll thread as a batch thread: %s; some answers take 4 ms longer",
                   std::strerror(errno));
      });
}

/// The exit code for arguments that are not ROS's remappings and parameters; nothing without such arguments.
std::optional<int> answerArguments(int argc, char** argv)
{
  std::vector<std::string> arguments;
  ros::removeROSArgs(argc, argv, arguments);
  if (arguments.size() < 2)
    return std::nullopt;
  if (arguments[1] == "--help" || arguments[1] == "-h")
  {
    std::cout << kUsage;
    return 0;
  }
  std::cerr << "planning_scene_node: unknown argument '" << arguments[1]
            << "'; arguments are NAME:=VALUE, see --help\n";
  return 2;
}

/// The node handles are outside the try block: roscpp and its log shut down with the last handle, so an error must be
/// logged before.
int connectAndServe(const OpenDevice& open_device)
{
  // The constructor waits for the master. The signal handlers are set after it, so that a signal can end the wait.
  ros::NodeHandle node;
  std::signal(SIGINT, requestStop);
  std::signal(SIGTERM, requestStop);
  ros::NodeHandle own("~");
  runPollThreadAsBatch();
  try
  {
    serve(node, own, open_device, [] { return stop_requested != 0; });
    return 0;
  }
  catch (const std::exception& error)
  {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
}
}  // namespace

int runNode(int argc, char** argv, const OpenDevice& open_device)
{
  if (const std::optional<int> exit_code = answerArguments(argc, argv))
    return *exit_code;
  useOneHeap();
  // So that a log file has each line at once, and not only when four kilobytes have been written.
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  try
  {
    PlannerLoader::prepareEnvironment();
    // Without roscpp's own signal handler, which drops the requests that are being answered.
    ros::init(argc, argv, "planning_scene_node", ros::init_options::NoSigintHandler);
    return connectAndServe(open_device);
  }
  catch (const std::exception& error)
  {
    std::cerr << "planning_scene_node: " << error.what() << "\n";
    return 1;
  }
}
}  // namespace gpu_planning_scene::core
