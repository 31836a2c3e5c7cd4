#include "gpu_planning_scene/error.h"
#include "node/moveit/moveit_interface.h"
#include "node/moveit/moveit_options.h"

// The interface in a build without moveit_msgs.
namespace gpu_planning_scene::core
{
struct MoveItInterface::Impl
{
};

MoveItInterface::MoveItInterface(const Node& node)
{
  const MoveItOptions options = moveItOptionsFromParameters(node.node, node.own);
  if (options.names || !options.monitor.node.empty())
    throw Error("parameter " + std::string(options.names ? "~moveit_names" : "~monitor") +
                " is set, but this build does not have MoveIt's messages: build the package where CMake finds "
                "moveit_msgs, or unset the parameter");
}

MoveItInterface::~MoveItInterface() = default;

void MoveItInterface::requireScene() const {}

std::string MoveItInterface::changeFault() const
{
  return "";
}

void MoveItInterface::close() {}

void MoveItInterface::stop() {}

bool MoveItInterface::refuseWaiting()
{
  return false;
}
}  // namespace gpu_planning_scene::core
