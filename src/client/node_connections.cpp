#include "client/node_connections.h"

#include <ros/exceptions.h>
#include <ros/names.h>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
/// The full name. Throws Error.
std::string resolved(const std::string& node)
{
  try
  {
    return ros::names::resolve(node);
  }
  catch (const ros::InvalidNameException& fault)
  {
    throw Error("'" + node + "' cannot be the name of a node: " + fault.what());
  }
}
}  // namespace

NodeConnections::NodeConnections(const std::string& node, double timeout) : node_(resolved(node)), timeout_(timeout) {}

std::unique_ptr<ServiceConnection> NodeConnections::connected(const std::string& name, const std::string& md5sum,
                                                              const CallLimit& limit)
{
  for (;;)
  {
    std::unique_ptr<ServiceConnection> connection;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      Connections& idle = idle_[name];
      if (idle.empty())
        break;
      connection = std::move(idle.back());
      idle.pop_back();
    }
    if (connection->isOpen())
      return connection;
  }
  return std::make_unique<ServiceConnection>(ros::names::resolve(node_ + "/" + name), md5sum, limit);
}

void NodeConnections::giveBack(const std::string& name, std::unique_ptr<ServiceConnection> connection)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  idle_[name].push_back(std::move(connection));
}
}  // namespace gpu_planning_scene::core
