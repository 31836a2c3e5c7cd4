#pragma once

#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/mesh_reader.h"
#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/resources.h"
#include "scene/yaml_value.h"

namespace gpu_planning_scene::core
{
// The parts of a scene file. Each function throws Error with file and line.

/// What reading one scene file needs and keeps.
struct SceneReader
{
  const RobotModel& robot;
  const PackageResolver& packages;
  std::string folder;                  ///< what relative mesh paths are relative to
  std::vector<std::string>* warnings;  ///< may be null
  const SceneDefaults& defaults;
  std::vector<double> state = {};                              ///< the file's robot state; empty if it has none
  std::map<std::string, Eigen::Isometry3d> fixed_frames = {};  ///< their poses in the planning frame
  MeshAccess meshes = {};
  MeshCache mesh_files = MeshCache();
  std::vector<std::shared_ptr<const Mesh>> inline_meshes = {};

  void warn(const std::string& line) const;
};

/// [x, y, z], or a map with x, y and z.
Eigen::Vector3d readVector(const YamlValue& value);
/// A position and an orientation under these names, both optional. The orientation (x, y, z, w) is normalised.
Eigen::Isometry3d readPose(const YamlValue& value, const char* position_key = "position",
                           const char* orientation_key = "orientation");

/// A map of the scene's `fixed_frame_transforms`, added to `reader.fixed_frames`.
void readFixedFrame(const YamlValue& value, SceneReader& reader);
/// The pose in the planning frame of the frame that `header` (may be null) names.
Eigen::Isometry3d readFrame(const YamlValue* header, const SceneReader& reader);

/// `robot_state`, complete: what the file does not give has its default. Empty where no joint is given.
std::vector<double> readRobotState(const YamlValue& value, const SceneReader& reader);

/// False, and `matrix` unchanged, where the value holds no entries.
bool readMatrix(const YamlValue& value, const SceneReader& reader, AllowedCollisionMatrix& matrix);

/// The primitives, meshes and planes of a collision object, in its frame. A plane is the half-space behind it.
std::vector<PlacedShape> readShapes(const YamlValue& object, SceneReader& reader);

/// The objects of the world, and those that links carry (`robot_state.attached_collision_objects`). Every id is new
/// and no link's.
void readObjects(const YamlValue& scene, SceneReader& reader, PlanningScene& result);

/// `link_padding` and `link_scale`: one value per link of the robot; empty if all are zero, or one.
std::vector<double> readLinkPadding(const YamlValue& scene, const SceneReader& reader);
std::vector<double> readLinkScale(const YamlValue& scene, const SceneReader& reader);

/// `object_colors`.
std::map<std::string, Color> readColors(const YamlValue& scene, const SceneReader& reader);

/// Octomaps: fails where there is one.
void refuseUnsupported(const YamlValue& scene);
}  // namespace gpu_planning_scene::core
