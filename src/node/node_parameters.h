#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <ros/node_handle.h>

#include "collision/checkers/resilient_checker.h"
#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/point_cloud.h"
#include "service/check_server.h"

namespace gpu_planning_scene::core
{
/// Each function throws Error, which names the parameter, for a value of the wrong type or out of range.

/// The scene of the parameters robot_description, robot_description_semantic (both searched for from the node's
/// namespace upwards and remappable), ~scene, ~packages, ~urdf_folder, ~unbounded_translation and ~mesh/. `defaults`
/// become those of robot_description_planning/, which hold for what the scene file does not name.
PlanningScene sceneFromParameters(const ros::NodeHandle& node, const ros::NodeHandle& own, SceneDefaults& defaults,
                                  std::vector<std::string>* warnings);

/// ~device, ~traversal, ~max_batch and ~tolerance.
BatchCheckerOptions checkerOptionsFromParameters(const ros::NodeHandle& own);

/// ~limits/ of a scene.
SceneLimits sceneLimitsFromParameters(const ros::NodeHandle& own);

/// ~small_request, and ~limits/ of requests.
CheckServerOptions serverOptionsFromParameters(const ros::NodeHandle& own);

/// ~device_timeout and ~device_losses.
ResilientOptions resilienceFromParameters(const ros::NodeHandle& own);

struct ServiceOptions
{
  double tf_timeout = 0.5;                    ///< seconds: ~tf_timeout
  double full_scene_period = 10.0;            ///< seconds: ~full_scene_period
  std::size_t most_inspected_states = 10000;  ///< of one request, for contacts and clearance: ~limits/inspected_states
  std::size_t most_contacts = 100000;         ///< in one answer: ~limits/contacts
  std::size_t most_memory = 0;                ///< bytes, 0: 80 % of the machine's: ~limits/memory
  std::uint32_t message_size = 256U << 20;    ///< bytes: ~limits/message_size
  std::size_t most_waiting_changes = 100000;  ///< that came on topics: ~limits/waiting_changes
  double marker_rate = 2.0;                   ///< per second: ~markers/rate
  std::size_t marker_triangles = 500000;      ///< ~markers/triangles
  std::string cloud_topic = "cloud";          ///< ~cloud/topic
  std::string cloud_id = "cloud";             ///< of the object that clouds become: ~cloud/id
  PointCloudOptions cloud;                    ///< ~cloud/voxel, ~cloud/robot_padding, ~cloud/range, ~limits/voxels
};
ServiceOptions serviceOptionsFromParameters(const ros::NodeHandle& own);

/// A value of ~packages: a map NAME: DIR, or a list of such maps or of "NAME=DIR" or "NAME: DIR".
std::map<std::string, std::string> packageFolders(const XmlRpc::XmlRpcValue& value);
}  // namespace gpu_planning_scene::core
