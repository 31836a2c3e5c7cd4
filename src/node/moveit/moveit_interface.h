#pragma once

#include <memory>
#include <string>

#include "node/checks/check_services.h"
#include "node/endpoints/endpoints.h"
#include "node/kinematics/kinematics_services.h"
#include "node/parameters/node_parameters.h"
#include "node/scene/frame_lookup.h"
#include "node/scene/scene_services.h"

namespace gpu_planning_scene::core
{
/// The part of the node that speaks MoveIt's types. It follows the scene of a move_group (~monitor), or has the
/// services and topics of a move_group itself (~moveit_names), and answers ~check_state_validity. A build without
/// moveit_msgs has none of these.
class MoveItInterface
{
 public:
  /// The parts of the node that MoveIt's types reach. They must outlive the interface.
  struct Node
  {
    ros::NodeHandle& node;
    ros::NodeHandle& own;
    SceneStore& store;
    SceneServices& changes;
    const ClearOctomap& clear_octomap;
    CheckServices& checks;
    KinematicsServices& kinematics;
    const FrameLookup& lookup;
    Diagnostics& diagnostics;
    const ServiceOptions& options;
    Endpoints::Precondition require_scene;  ///< of the node without this interface
  };

  /// Throws Error for parameters that are wrong or that this build does not support.
  explicit MoveItInterface(const Node& node);
  ~MoveItInterface();

  /// Throws Unavailable if the node must not answer from its scene now. Thread-safe.
  void requireScene() const;
  /// The reason why the scene cannot be changed by the node's clients; empty if it can. Thread-safe.
  std::string changeFault() const;

  // As the functions of Endpoints.
  void close();
  void stop();
  bool refuseWaiting();

 private:
  struct Impl;
  const std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
