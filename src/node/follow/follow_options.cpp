#include "node/follow/follow_options.h"

#include "node/parameters/parameter_values.h"

namespace gpu_planning_scene::core
{
FollowOptions followOptionsFromParameters(const ros::NodeHandle& node, const ros::NodeHandle& own)
{
  FollowOptions options;
  options.period = positiveParameter(own, "follow_period", options.period);
  options.timeout = positiveParameter(own, "follow_timeout", options.timeout);
  const std::string name = textParameter(own, "follow", "");
  if (name.empty())
    return options;
  options.node = node.resolveName(name);
  options.topic = options.node + "/monitored_planning_scene_diffs";
  options.service = options.node + "/get_planning_scene";
  if (options.node == own.getNamespace())
    throw Error("parameter ~follow is " + name + ", the node itself; give the name of another node");
  const std::string others = "; the scene of " + options.node + " is the only one; unset one of the two";
  if (!textParameter(own, "scene", "").empty())
    throw Error("parameters ~follow and ~scene exclude each other" + others);
  if (!textParameter(own, "monitor", "").empty())
    throw Error("parameters ~follow and ~monitor exclude each other" + others);
  if (flagParameter(own, "moveit_names", false))
    throw Error("parameters ~follow and ~moveit_names exclude each other: the clients of a move_group change its " +
                std::string("scene; unset one of the two"));
  return options;
}
}  // namespace gpu_planning_scene::core
