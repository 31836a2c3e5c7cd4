// planning_scene_node: holds a planning scene that clients can change, and checks robot states for collision over ROS.

#include <csignal>
#include <iostream>

#include <ros/ros.h>

#include "collision/checkers/open_checker.h"
#include "node/planner_plugins.h"
#include "node/serve.h"

namespace gpu_planning_scene::core
{
namespace
{
volatile std::sig_atomic_t stop_requested = 0;

void requestStop(int)
{
  stop_requested = 1;
}

/// The node handles are outside the try block: roscpp and its log shut down with the last handle, so an error must be
/// logged before.
int run()
{
  // The constructor waits for the master. The signal handlers are set after it, so that a signal can end the wait.
  ros::NodeHandle node;
  std::signal(SIGINT, requestStop);
  std::signal(SIGTERM, requestStop);
  ros::NodeHandle own("~");
  try
  {
    serve(node, own, openChecker, [] { return stop_requested != 0; });
    return 0;
  }
  catch (const std::exception& error)
  {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core

int main(int argc, char** argv)
{
  try
  {
    gpu_planning_scene::core::PlannerPlugins::prepareEnvironment();
    // Without roscpp's own signal handler, which drops the requests that are being answered.
    ros::init(argc, argv, "planning_scene_node", ros::init_options::NoSigintHandler);
    return gpu_planning_scene::core::run();
  }
  catch (const std::exception& error)
  {
    std::cerr << "planning_scene_node: " << error.what() << "\n";
    return 1;
  }
}
