#pragma once

#include <functional>
#include <map>
#include <string>

#include <geometry_msgs/PoseStamped.h>
#include <Eigen/Geometry>

#include "gpu_planning_scene/kinematic_constraints.h"
#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/scene_change.h"
#include "node/messages/requested_states.h"
#include "scene/link_frame.h"

namespace gpu_planning_scene::core
{
/// Tolerances of a pose that a request wants, in metres and radians.
struct PoseTolerances
{
  double position = 1e-6;
  double orientation = 1e-6;  ///< pi or more: any orientation
};

/// The tolerances of a request; 0 means the default. Throws Error, which names the field, for a number below 1e-9 or
/// one that is not finite.
PoseTolerances requestedTolerances(const RequestField<double>& position, const RequestField<double>& orientation,
                                   const PoseTolerances& defaults = {});

/// The frame whose pose a request wants. An empty name means the last link of the group's chain. Throws the errors of
/// tipOf and linkFrame.
LinkFrame requestedFrame(const PlanningScene& scene, const std::string& group, const std::string& name);

/// Reads the poses of one request. A frame is looked up once, so all poses in a moving frame belong to the same
/// instant. Not thread-safe.
class PoseReader
{
 public:
  using Lookup = std::function<Eigen::Isometry3d(const StampedFrame&)>;

  /// `state`: where frames that move with the robot are; null if it is not known. `lookup`: finds frames that the scene
  /// does not have. The arguments must outlive this object.
  PoseReader(const PlanningScene& scene, const double* state, const Lookup& lookup)
    : scene_(scene), state_(state), lookup_(lookup)
  {
  }

  /// The pose of a frame in the planning frame. Throws Error if it is not found.
  const Eigen::Isometry3d& frame(const StampedFrame& name);

  /// The pose of a message in the planning frame. Throws Error as constraints() does.
  Eigen::Isometry3d pose(const geometry_msgs::PoseStamped& message, const std::string& where);

  /// `moved` has the pose of the message, up to the tolerances. Throws Error that begins with `where` if the frame of
  /// the message is not found, if a number is not finite, or if an orientation is wanted and the quaternion is not of
  /// length 1.
  KinematicConstraints constraints(const LinkFrame& moved, const geometry_msgs::PoseStamped& message,
                                   const PoseTolerances& tolerances, const std::string& where);

 private:
  Eigen::Isometry3d pose(const geometry_msgs::PoseStamped& message, bool with_orientation, const std::string& where);

  const PlanningScene& scene_;
  const double* state_;
  const Lookup& lookup_;
  std::map<StampedFrame, Eigen::Isometry3d> frames_;
};
}  // namespace gpu_planning_scene::core
