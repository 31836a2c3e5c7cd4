#pragma once

#include <map>
#include <string>

#include <ros/ros.h>

namespace gpu_planning_scene::core
{
/// Calls a service over a connection of this thread that stays open. ros::service::call connects for each call. While
/// other clients connect too, roscpp (1.15) then loses about one of 3000 calls: it takes an event of a closed
/// connection for an event of the new connection, which has got the same socket number.
template <class Service>
bool callPersistently(const std::string& service, Service& call)
{
  thread_local std::map<std::string, ros::ServiceClient> clients;
  ros::ServiceClient& client = clients[service];
  if (!client.isValid())
    client = ros::NodeHandle().serviceClient<Service>(service, true);
  return client.call(call);
}
}  // namespace gpu_planning_scene::core
