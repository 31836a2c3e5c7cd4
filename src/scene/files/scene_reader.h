#pragma once

#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/mesh_reader.h"
#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/resources.h"
#include "scene/files/yaml_value.h"

namespace gpu_planning_scene::core
{
// Readers of the parts of a scene file. Each function throws Error with file and line.

/// The inputs and the intermediate results of reading one scene file.
struct SceneReader
{
  const RobotModel& robot;
  const PackageResolver& packages;
  std::string folder;                  ///< start of relative mesh paths
  std::vector<std::string>* warnings;  ///< may be null
  const SceneDefaults& defaults;
  std::vector<double> state = {};  ///< the file's robot state; empty if it has none
  bool leaves_out_base = false;    ///< the state has no value of the virtual joint
  bool has_link_frames = false;    ///< an object is placed relative to a link and the planning frame
  std::map<std::string, Eigen::Isometry3d> fixed_frames = {};  ///< poses in the planning frame
  MeshAccess meshes = {};
  MeshCache mesh_files = MeshCache();
  std::vector<std::shared_ptr<const Mesh>> inline_meshes = {};

  void warn(const std::string& line) const;
};

/// [x, y, z], or a map with x, y and z.
Eigen::Vector3d readVector(const YamlValue& value);
/// A map with `position` and `orientation` (x, y, z, w; it is normalised), both optional.
Eigen::Isometry3d readPose(const YamlValue& value);
/// The same with the keys `translation` and `rotation`.
Eigen::Isometry3d readTransform(const YamlValue& value);

/// Whether a pose has only zeros. ROS writes them for a pose that was never set.
bool isUnsetPose(const YamlValue& value);

/// Reads an entry of the scene's `fixed_frame_transforms` and adds it to `reader.fixed_frames`.
void readFixedFrame(const YamlValue& value, SceneReader& reader);
/// The pose in the planning frame of the frame that `header` names. Without a header or a name: the planning frame.
Eigen::Isometry3d readFrame(const YamlValue* header, SceneReader& reader);

/// Reads `robot_state`. Values that the file does not give have their defaults. Empty if the file gives no value at
/// all.
std::vector<double> readRobotState(const YamlValue& value, SceneReader& reader);

/// Returns false and leaves `matrix` unchanged if the value holds no entries.
bool readMatrix(const YamlValue& value, const SceneReader& reader, AllowedCollisionMatrix& matrix);

/// Adds the pairs of `allowed_collisions` to the matrix of `scene`. A pair with "*" sets the default of the other body.
/// `scene` must already have its objects: a name that is neither a link nor an object gets a warning.
void addAllowedCollisions(const YamlValue& value, const SceneReader& reader, PlanningScene& scene);

/// The primitives, meshes and planes of a collision object, in its frame. A plane becomes the half-space behind it.
std::vector<PlacedShape> readShapes(const YamlValue& object, SceneReader& reader);

/// Reads the objects of the world and the attached objects (`robot_state.attached_collision_objects`). An id must not
/// occur twice and must not be the name of a link.
void readObjects(const YamlValue& scene, SceneReader& reader, PlanningScene& result);

/// Reads `world.octomap`, and the scene's `octomap`, and adds the octomap to the world of `result`.
void readOctomap(const YamlValue& scene, SceneReader& reader, PlanningScene& result);

/// A joint trajectory in the layout of trajectory_msgs/JointTrajectory. Times can also be numbers of seconds.
JointTrajectory readTrajectory(const YamlValue& value, const SceneReader& reader);

/// `link_padding` and `link_scale`: one value per link of the robot. Empty if each padding is 0, or each scale is 1.
std::vector<double> readLinkPadding(const YamlValue& scene, const SceneReader& reader);
std::vector<double> readLinkScale(const YamlValue& scene, const SceneReader& reader);

/// auto, surface or filled.
SolidRule readSolidRule(const YamlValue& value);

/// `link_solid`: rules by link.
std::map<std::string, SolidRule> readLinkSolids(const YamlValue& scene, const SceneReader& reader);

/// `object_colors`.
std::map<std::string, Color> readColors(const YamlValue& scene, const SceneReader& reader);
}  // namespace gpu_planning_scene::core
