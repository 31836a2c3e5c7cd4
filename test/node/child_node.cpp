#include "node/child_node.h"

#include <csignal>
#include <stdexcept>

#include <ros/network.h>
#include <ros/ros.h>
#include <ros/xmlrpc_manager.h>
#include <spawn.h>
#include <sys/wait.h>

extern char** environ;

namespace gpu_planning_scene::core
{
ChildNode::ChildNode(const std::string& node_name, std::vector<std::string> arguments, const std::string& program)
  : name_(node_name)
{
  const auto urdf = ros::param::param<std::string>("~urdf", "");
  arguments.insert(arguments.begin(), program);
  arguments.push_back("__name:=" + name_);
  arguments.push_back("_urdf_folder:=" + urdf.substr(0, urdf.rfind('/')));
  std::vector<char*> words;
  for (std::string& argument : arguments)
    words.push_back(argument.data());
  words.push_back(nullptr);
  if (posix_spawn(&process_, program.c_str(), nullptr, nullptr, words.data(), environ) != 0)
    throw std::runtime_error(program + " cannot be started");
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

void ChildNode::freeze() const
{
  kill(process_, SIGSTOP);
}

void ChildNode::askToShutDown() const
{
  XmlRpc::XmlRpcValue request, response, uri;
  request[0] = ros::this_node::getName();
  request[1] = "/" + name_;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::master::execute("lookupNode", request, response, uri, false) ||
      !ros::network::splitURI(static_cast<std::string&>(uri), host, port))
    throw std::runtime_error(name_ + " is not known to the master");
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port));
  request[1] = "a test";
  if (!client.execute("shutdown", request, response))
    throw std::runtime_error(name_ + " does not hear");
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
}  // namespace gpu_planning_scene::core
