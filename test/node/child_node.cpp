#include "node/child_node.h"

#include <csignal>
#include <stdexcept>

#include <ros/ros.h>
#include <spawn.h>
#include <sys/wait.h>

extern char** environ;

namespace gpu_planning_scene
{
ChildNode::ChildNode(const std::string& node_name, std::vector<std::string> arguments) : name_(node_name)
{
  const auto urdf = ros::param::param<std::string>("~urdf", "");
  arguments.insert(arguments.begin(), GPS_NODE);
  arguments.push_back("__name:=" + name_);
  arguments.push_back("_urdf_folder:=" + urdf.substr(0, urdf.rfind('/')));
  std::vector<char*> words;
  for (std::string& argument : arguments)
    words.push_back(argument.data());
  words.push_back(nullptr);
  if (posix_spawn(&process_, GPS_NODE, nullptr, nullptr, words.data(), environ) != 0)
    throw std::runtime_error(std::string(GPS_NODE) + " cannot be started");
  if (!ros::service::waitForService(service("check_states"), ros::Duration(60.0)))
    throw std::runtime_error(name_ + " does not come up");
}

ChildNode::~ChildNode()
{
  if (process_ == 0)
    return;
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

void ChildNode::interrupt() const
{
  kill(process_, SIGINT);
}

int ChildNode::wait(double seconds)
{
  for (const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds); ros::WallTime::now() < end;)
  {
    int status = 0;
    if (waitpid(process_, &status, WNOHANG) == process_)
    {
      process_ = 0;
      return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    ros::WallDuration(0.02).sleep();
  }
  return -1;
}
}  // namespace gpu_planning_scene
