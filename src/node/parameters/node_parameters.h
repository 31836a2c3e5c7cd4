#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <ros/node_handle.h>

#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/point_cloud.h"
#include "service/check_server.h"

namespace gpu_planning_scene::core
{
// For a value of the wrong type or out of range, each function throws Error, which names the parameter.

/// Makes the scene from the parameters robot_description, robot_description_semantic (both are searched for from the
/// node's namespace upwards and can be remapped), robot_description_planning/joint_limits (with ~monitor, that of the
/// move_group), ~scene, ~packages, ~solids, ~urdf_folder, ~unbounded_translation and ~mesh/.
/// `defaults` gets the values of robot_description_planning/, which apply to links and objects that the scene file does
/// not name.
PlanningScene sceneFromParameters(const ros::NodeHandle& node, const ros::NodeHandle& own, SceneDefaults& defaults,
                                  std::vector<std::string>* warnings);

/// ~device, ~traversal, ~max_batch, ~device_only, ~device_timeout, ~device_losses and ~device_retry.
BatchCheckerOptions checkerOptionsFromParameters(const ros::NodeHandle& own);

/// The parameters ~limits/ of a scene.
SceneLimits sceneLimitsFromParameters(const ros::NodeHandle& own);

/// ~small_request, and the parameters ~limits/ of requests.
CheckServerOptions serverOptionsFromParameters(const ros::NodeHandle& own);

struct ServiceOptions
{
  double tf_timeout = 0.5;                   ///< seconds: ~tf_timeout
  double full_scene_period = 10.0;           ///< seconds: ~full_scene_period
  std::size_t max_motion_checks = 10000000;  ///< for the motions of one request: ~limits/motion_checks
  std::size_t max_inspected_states = 10000;  ///< of one request, for contacts and clearance: ~limits/inspected_states
  std::size_t max_contacts = 100000;         ///< in one response: ~limits/contacts
  std::size_t max_memory = 0;                ///< bytes; 0: 80 % of the machine's memory: ~limits/memory
  std::uint32_t message_size = 256U << 20;   ///< bytes: ~limits/message_size
  std::size_t max_waiting_changes = 100000;  ///< queued changes from topics: ~limits/waiting_changes
  double watch_rate = 20.0;                  ///< per second: ~watch/rate
  double marker_rate = 2.0;                  ///< per second: ~markers/rate
  double animation_rate = 10.0;              ///< per second; 0: none: ~markers/animation_rate
  std::size_t marker_triangles = 500000;     ///< ~markers/triangles
  std::string cloud_topic = "cloud";         ///< ~cloud/topic
  std::string cloud_id = "cloud";            ///< id of the clouds' object: ~cloud/id
  PointCloudOptions cloud;                   ///< ~cloud/voxel, ~cloud/robot_padding, ~cloud/range, ~limits/voxels
};
ServiceOptions serviceOptionsFromParameters(const ros::NodeHandle& own);

/// Reads ~packages: a map NAME: DIR, a text "NAME=DIR" or "NAME: DIR", or a list of these.
std::map<std::string, std::string> packageFolders(const XmlRpc::XmlRpcValue& value);
}  // namespace gpu_planning_scene::core
