#pragma once

#include <map>
#include <string>

#include <ros/ros.h>

namespace gpu_planning_scene::core
{
/// Calls over a connection of this thread's that stays open. ros::service::call connects anew each time, and roscpp
/// (1.15) then loses about one of 3000 calls without an answer while others connect too: an event of a closed
/// connection is taken for one of the new connection that has got its socket's number.
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
