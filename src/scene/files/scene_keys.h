#pragma once

#include <string>
#include <vector>

#include "scene/files/yaml_value.h"

namespace gpu_planning_scene::core
{
/// The maps of a scene file, with the names of MoveIt's messages.
enum class SceneMap
{
  Scene,
  World,
  Object,
  ObjectType,
  Primitive,
  Mesh,
  Triangle,
  Plane,
  OctomapWithPose,
  Octomap,
  RobotState,
  JointState,
  MultiDofJointState,
  AttachedObject,
  Trajectory,
  TrajectoryPoint,
  Time,
  FixedFrame,
  Matrix,
  MatrixRow,
  LinkPadding,
  LinkScale,
  LinkSolid,
  ObjectColor,
  Color,
  Header,
  Pose,
  Transform,
  Vector,
  Quaternion
};

/// Checks the keys of a map. All fields of MoveIt's messages are known keys, so files that MoveIt prints pass. Throws
/// Error, with the line of the key, for an unknown key whose loss may change the world:
/// - it is near to a known key of the map, for example `poses` to `pose`
/// - it is a key of another map, for example `collision_objects` outside of `world`
/// - it is another format's word for a pose, a size or a file, for example `xyz` in an object
/// - it is about sizes, distances or pairs that are not checked, for example `default_robot_padding` or `scaling`
/// - its value has objects, shapes or joint values, for example `obstacles: [{id: a, primitives: [...]}]`
/// - it is in a pose or a similar small map, which has no room for further keys
/// Any other unknown key gets a line in `warnings` (may be null).
void checkKeys(const YamlValue& map, SceneMap kind, std::vector<std::string>* warnings);

/// Throws Error for the first unknown key that is near to a known key of the map.
void refuseMisspeltKeys(const YamlValue& map, SceneMap kind);

/// Whether a map has a value for at least one of its known keys.
bool hasKnownKey(const YamlValue& map, SceneMap kind);

/// The first key of a map that is unknown; empty if there is none.
std::string unknownKey(const YamlValue& map, SceneMap kind);

/// The name of the frame in a header, with its line; null without a header, without a name, and for an empty name.
/// Checks the keys of the header.
const YamlValue* frameOf(const YamlValue* header);
}  // namespace gpu_planning_scene::core
