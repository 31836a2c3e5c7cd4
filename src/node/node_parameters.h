#pragma once

#include <memory>
#include <string>
#include <vector>

#include <ros/node_handle.h>

#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene
{
/// Each function throws Error, which names the parameter, for a value of the wrong type or out of range.

/// The scene of the parameters robot_description, robot_description_semantic (both searched for from the node's
/// namespace upwards and remappable), ~scene, ~packages, ~urdf_folder and ~unbounded_translation.
std::shared_ptr<const PlanningScene> sceneFromParameters(const ros::NodeHandle& node, const ros::NodeHandle& own,
                                                         std::vector<std::string>* warnings);

/// ~device, ~traversal, ~max_batch and ~tolerance.
BatchCheckerOptions checkerOptionsFromParameters(const ros::NodeHandle& own);

/// A value of ~packages: a map NAME: DIR, or a list of such maps or of "NAME=DIR" or "NAME: DIR".
std::map<std::string, std::string> packageFolders(const XmlRpc::XmlRpcValue& value);
}  // namespace gpu_planning_scene
