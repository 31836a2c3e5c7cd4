#include "node/run_node.h"

#include <csignal>
#include <cstdio>
#include <iostream>

#include <malloc.h>

#include <ros/ros.h>

#include "node/serve.h"
#include "planners/planner_loader.h"

namespace gpu_planning_scene::core
{
namespace
{
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
