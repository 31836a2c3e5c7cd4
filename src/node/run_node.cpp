#include "node/run_node.h"

#include <csignal>
#include <cstdio>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <malloc.h>

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
