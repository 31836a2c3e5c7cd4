#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <ros/serialization.h>
#include <ros/service_traits.h>

#include "client/service_connection.h"

namespace gpu_planning_scene::core
{
/// The connections to the services of a node. They stay open: see docs/node.md. Thread-safe: calls at the same time
/// have connections of their own.
class NodeConnections
{
 public:
  /// `timeout`: seconds for a call, with the connection if one is made for it. Throws Error for a wrong name.
  NodeConnections(const std::string& node, double timeout);

  const std::string& node() const { return node_; }

  /// Calls the service of this name in the node's namespace. Throws NoAnswer, and Cancelled.
  template <class Service>
  typename Service::Response call(const std::string& name, const typename Service::Request& request,
                                  const std::function<bool()>& is_cancelled)
  {
    const CallLimit limit(timeout_, is_cancelled);
    std::unique_ptr<ServiceConnection> connection = connected(name, ros::service_traits::md5sum<Service>(), limit);
    std::vector<std::uint8_t> answer = connection->call(ros::serialization::serializeMessage(request), limit);
    typename Service::Response response;
    try
    {
      ros::serialization::IStream stream(answer.data(), static_cast<std::uint32_t>(answer.size()));
      ros::serialization::deserialize(stream, response);
    }
    catch (const ros::serialization::StreamOverrunException& fault)
    {
      throw NoAnswer(std::string("the answer ends early: ") + fault.what());
    }
    giveBack(name, std::move(connection));
    return response;
  }

 private:
  using Connections = std::vector<std::unique_ptr<ServiceConnection>>;

  /// An idle connection, or a new one.
  std::unique_ptr<ServiceConnection> connected(const std::string& name, const std::string& md5sum,
                                               const CallLimit& limit);
  void giveBack(const std::string& name, std::unique_ptr<ServiceConnection> connection);

  const std::string node_;
  const double timeout_;
  std::mutex mutex_;  // guards the member below
  std::map<std::string, Connections> idle_;
};
}  // namespace gpu_planning_scene::core
