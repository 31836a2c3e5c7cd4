// planning_scene_node: holds a planning scene and answers over ROS which robot states are free of collision.

#include <algorithm>
#include <iostream>
#include <thread>

#include <ros/ros.h>

#include "node/check_states_service.h"
#include "node/current_state.h"
#include "node/node_parameters.h"
#include "tools/open_checker.h"
#include "tools/scene_text.h"

namespace gpu_planning_scene
{
namespace
{
void serve(ros::NodeHandle& node, ros::NodeHandle& own)
{
  const BatchCheckerOptions options = checkerOptionsFromParameters(own);
  std::vector<std::string> warnings;
  const auto scene = sceneFromParameters(node, own, &warnings);
  for (const std::string& warning : warnings)
    ROS_WARN_STREAM(warning);
  const std::shared_ptr<StateChecker> checker = openChecker(scene, options);
  if (const std::string warning = checker->deviceWarning(); !warning.empty())
    ROS_WARN_STREAM(warning);
  for (const std::string& line : describeScene(*scene, checker->report(), checker->deviceName()))
    ROS_INFO_STREAM(line);

  CurrentState current(scene);
  const ros::Subscriber joint_states = node.subscribe<sensor_msgs::JointState>(
      "joint_states", 1,
      [&current](const sensor_msgs::JointState::ConstPtr& message)
      {
        try
        {
          current.update(*message);
        }
        catch (const std::exception& error)
        {
          ROS_WARN_STREAM_THROTTLE(10.0, "a message on joint_states is not used: " << error.what());
        }
      });
  const ros::ServiceServer check_states = own.advertiseService<CheckStates::Request, CheckStates::Response>(
      "check_states",
      [&current, scene, checker](CheckStates::Request& request, CheckStates::Response& response)
      {
        response = answerCheckStates(request, *scene, current.get(), *checker);
        return true;
      });
  ROS_INFO_STREAM("ready: " << own.resolveName("check_states"));

  // Requests are read and answered side by side; only the checks themselves queue up.
  ros::AsyncSpinner spinner(std::max(4U, std::thread::hardware_concurrency()));
  spinner.start();
  ros::waitForShutdown();
}

/// The handles outlive the error: with the last of them roscpp shuts down, and its log with it.
int run()
{
  ros::NodeHandle node;
  ros::NodeHandle own("~");
  try
  {
    serve(node, own);
    return 0;
  }
  catch (const std::exception& error)
  {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
}
}  // namespace
}  // namespace gpu_planning_scene

int main(int argc, char** argv)
{
  try
  {
    ros::init(argc, argv, "planning_scene_node");
    return gpu_planning_scene::run();
  }
  catch (const std::exception& error)
  {
    std::cerr << "planning_scene_node: " << error.what() << "\n";
    return 1;
  }
}
