// planning_scene_node: holds a planning scene, which clients change, and answers over ROS which robot states are free
// of collision.

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

/// The handles outlive the error: with the last of them roscpp shuts down, and its log with it.
int run()
{
  // Waits for the master, deaf to what is asked of it: until then signals end the process as they end any other.
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
    // Not roscpp's own handler: it would drop the requests that are being answered.
    gpu_planning_scene::core::PlannerPlugins::prepareEnvironment();
    ros::init(argc, argv, "planning_scene_node", ros::init_options::NoSigintHandler);
    return gpu_planning_scene::core::run();
  }
  catch (const std::exception& error)
  {
    std::cerr << "planning_scene_node: " << error.what() << "\n";
    return 1;
  }
}
