#include "node/moveit/moveit_options.h"

#include <ros/names.h>

#include "gpu_planning_scene/error.h"
#include "node/parameters/parameter_values.h"

namespace gpu_planning_scene::core
{
MoveItOptions moveItOptionsFromParameters(const ros::NodeHandle& node, const ros::NodeHandle& own)
{
  MoveItOptions options;
  options.names = flagParameter(own, "moveit_names", options.names);
  FollowOptions& monitor = options.monitor;
  const std::string name = textParameter(own, "monitor", "");
  monitor.period = positiveParameter(own, "monitor_period", monitor.period);
  monitor.timeout = positiveParameter(own, "monitor_timeout", monitor.timeout);
  const std::string service = textParameter(own, "monitor_service", "");
  if (name.empty())
    return options;
  monitor.node = node.resolveName(name);
  monitor.topic = monitor.node + "/monitored_planning_scene";
  // A move_group has its services beside its own name, and its topic below it.
  monitor.service = service.empty()
                        ? ros::names::append(ros::names::parentNamespace(monitor.node), "get_planning_scene")
                        : node.resolveName(service);
  if (options.names)
    throw Error("parameters ~monitor and ~moveit_names exclude each other: the move_group that ~monitor names has " +
                std::string("MoveIt's names already; unset one of the two"));
  if (!textParameter(own, "scene", "").empty())
    throw Error("parameters ~monitor and ~scene exclude each other: the scene of " + monitor.node +
                " replaces the scene file; unset one of the two");
  return options;
}
}  // namespace gpu_planning_scene::core
