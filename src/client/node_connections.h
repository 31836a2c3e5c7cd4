#pragma once

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <ros/service_client.h>

#include "client/call_watch.h"

namespace gpu_planning_scene::core
{
/// The connections to the services of a node. They stay open: see docs/node.md. Thread-safe: calls at the same time
/// have connections of their own.
class NodeConnections
{
 public:
  NodeConnections(std::string node, CallWatch& watch) : node_(std::move(node)), watch_(watch) {}

  const std::string& node() const { return node_; }

  /// Calls the service of this name in the node's namespace. Returns false if the node does not answer.
  template <class Service>
  bool call(const std::string& name, const typename Service::Request& request, typename Service::Response& response)
  {
    ros::ServiceClient client = take(name);
    if (!client.isValid())
      client = ros::NodeHandle().serviceClient<Service>(node_ + "/" + name, true);
    if (!client.isValid())
      return false;
    typename Service::Request sent = request;
    bool was_answered = false;
    {
      const CallWatch::Guard guard(watch_, client);
      was_answered = client.call(sent, response);
    }
    if (was_answered)
      giveBack(name, client);
    return was_answered;
  }

 private:
  ros::ServiceClient take(const std::string& name)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<ros::ServiceClient>& idle = idle_[name];
    if (idle.empty())
      return {};
    const ros::ServiceClient client = idle.back();
    idle.pop_back();
    return client;
  }

  void giveBack(const std::string& name, const ros::ServiceClient& client)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    idle_[name].push_back(client);
  }

  const std::string node_;
  CallWatch& watch_;
  std::mutex mutex_;  // guards the member below
  std::map<std::string, std::vector<ros::ServiceClient>> idle_;
};
}  // namespace gpu_planning_scene::core
