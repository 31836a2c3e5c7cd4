#include "node/shutdown_call.h"

#include <string>

#include <ros/console.h>
#include <ros/xmlrpc_manager.h>

namespace gpu_planning_scene::core
{
namespace
{
constexpr const char* kMethod = "shutdown";  // of the ROS slave API
}  // namespace

ShutdownCall::ShutdownCall() : came_(std::make_shared<std::atomic<bool>>(false))
{
  const ros::XMLRPCManagerPtr& manager = ros::XMLRPCManager::instance();
  manager->unbind(kMethod);
  manager->bind(kMethod,
                [came = came_](XmlRpc::XmlRpcValue& parameters, XmlRpc::XmlRpcValue& result)
                {
                  const bool has_reason = parameters.getType() == XmlRpc::XmlRpcValue::TypeArray &&
                                          parameters.size() > 1 &&
                                          parameters[1].getType() == XmlRpc::XmlRpcValue::TypeString;
                  ROS_WARN_STREAM("shutdown requested: " << (has_reason ? static_cast<std::string&>(parameters[1])
                                                                        : "no reason given"));
                  *came = true;
                  result = ros::xmlrpc::responseInt(1, "", 0);
                });
}

ShutdownCall::~ShutdownCall()
{
  ros::XMLRPCManager::instance()->unbind(kMethod);
}
}  // namespace gpu_planning_scene::core
