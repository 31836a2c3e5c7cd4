#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
// Changes of a scene, as MoveIt's messages describe them, but without ROS. The names and meanings are those of
// moveit_msgs, with one difference: a change is made as a whole or not at all. (MoveIt applies the valid parts.)

enum class Operation
{
  Add,     ///< adds an object, or replaces the object of that id
  Remove,  ///< removes an object; without an id, removes all
  Append,  ///< adds shapes, subframes and touch links; works as Add if there is no such object
  Move     ///< gives new poses to an object of the world
};

/// The name of a frame and a time in nanoseconds; 0: the latest.
struct StampedFrame
{
  std::string name;
  std::int64_t stamp = 0;
};
inline bool operator<(const StampedFrame& a, const StampedFrame& b)
{
  return std::tie(a.name, a.stamp) < std::tie(b.name, b.stamp);
}

/// A change of one object. The object kOctomapId can only be added and removed. Its removal from a scene without an
/// octomap is not an error. A removal of all objects keeps it.
struct ObjectChange
{
  Operation operation = Operation::Add;
  std::string id;
  StampedFrame frame;  ///< see PlanningScene::frame
  /// Pose of the object in `frame`; no value: not set. Without a pose, a new object is placed at the origin of the
  /// frame. A new object with a single shape then takes the pose of this shape, and the shape moves to the object's
  /// origin. Move without a pose places the object at the origin of the frame; a single pose in shape_poses then
  /// becomes the pose of the object. Append leaves an object of the world where it is. For an attached object, Append
  /// makes a given pose the new pose of the object.
  std::optional<Eigen::Isometry3d> pose;
  std::vector<PlacedShape> shapes;             ///< in the object's frame: primitives, then meshes, then half-spaces
  std::vector<Eigen::Isometry3d> shape_poses;  ///< only for Move: none, or one per shape of the object, in that order
  std::map<std::string, Eigen::Isometry3d> subframes;  ///< in the object's frame
  ObjectType type;                                     ///< empty: a new object has none, other objects keep theirs
  /// Only for Remove. True: the allowed collision matrix keeps the object's entries. This is for objects that come and
  /// go, for example a point cloud. A change without an id, which removes all objects, then keeps their colours too.
  /// False, as in MoveIt: the entries are removed with the object. The octomap (see kOctomapId) always keeps its
  /// entries and its colour.
  bool keeps_allowed_collisions = false;
};

/// A change of the objects that links carry. Add without shapes attaches the world object of that id, which stays where
/// it is. Add with shapes replaces the object of that id, in the world or on a link. Remove returns the object to the
/// world at its current place. Without an id, it returns all objects of the link. Without an id and a link, it returns
/// all attached objects.
struct AttachedChange
{
  ObjectChange object;
  std::string link;
  std::vector<std::string> touch_links;
  /// Append keeps the old values if these are empty or 0. An object that returns to the world loses both.
  JointTrajectory detach_posture = {};
  double weight = 0.0;  ///< kilograms
};

/// A change of the robot state and of the attached objects.
struct StateChange
{
  std::map<std::string, double> variables;  ///< by name of the variable
  std::vector<AttachedChange> attached;     ///< in order, after the variables are set
  /// True: links keep the objects that they carry. False: `attached` replaces all attached objects, and must use Add
  /// only. An attached object that `attached` does not name is then removed, together with its entries in the allowed
  /// collision matrix, and there is a warning. Exception: if SceneChange::is_diff is true and `variables` is empty,
  /// `attached` adds to the attached objects.
  bool is_diff = true;
};

/// A full scene or a diff. The parts are applied in the order of the members, except that a full scene empties the
/// world before it applies the state. In a diff, an empty part changes nothing. In a full scene, an empty part takes
/// the value of a new scene. Exceptions: the variables of the state keep their values; if StateChange::is_diff is true,
/// links keep the objects that they carry.
struct SceneChange
{
  bool is_diff = false;
  std::string name;
  std::string robot_model_name;                           ///< empty, or the robot's name; any other name is an error
  std::map<std::string, Eigen::Isometry3d> fixed_frames;  ///< in the planning frame; they replace all fixed frames
  StateChange state;
  std::optional<AllowedCollisionMatrix> matrix;  ///< replaces the matrix; a full scene without it gets the robot's own
  std::map<std::string, double> link_padding;    ///< metres, by link
  std::map<std::string, double> link_scale;
  std::map<std::string, Color> colors;
  std::vector<ObjectChange> objects;  ///< applied in this order
  /// Rules for the meshes of links and objects, by name. Links and objects that are not named keep their rules, also in
  /// a full scene; new objects have SolidRule::Auto. Shapes that are appended to an object take its rule.
  std::map<std::string, SolidRule> solids;
};

/// Limits of a scene after a change; 0: no limit.
struct SceneLimits
{
  std::size_t objects = 100000;      ///< in the world and attached
  std::size_t shapes = 400000;       ///< of these objects
  std::size_t voxels = 200000;       ///< occupied leaves of the octomap
  std::size_t triangles = 20000000;  ///< of distinct meshes, including the meshes of the robot
  std::size_t triangles_of_mesh = 5000000;
  std::size_t frames = 100000;     ///< fixed frames and subframes
  std::size_t colors = 200000;     ///< of bodies, also of bodies that do not exist yet
  std::size_t name_length = 1024;  ///< bytes of each name
  std::size_t matrix_entries = 4000000;
};

/// Poses, in the planning frame, of frames that the scene does not know. The caller looks them up before the change.
using ExternalFrames = std::map<StampedFrame, Eigen::Isometry3d>;

/// The frames of `change` that neither the scene nor an earlier part of the change knows.
std::vector<StampedFrame> externalFrames(const PlanningScene& scene, const SceneChange& change);

/// The scene after a change.
struct ChangedScene
{
  PlanningScene scene;        ///< its current_state is `state`
  std::vector<double> state;  ///< one value per variable; empty while some values are unknown
  std::vector<std::string> warnings;
};

/// Returns the changed scene. Its revision is that of `scene`. `state`: the robot's state, empty while some values are
/// unknown. If `scene` is valid (validateScene), the result is valid too. Throws Error that names the object or
/// link and the remedy. Thread-safe.
ChangedScene applyChange(const PlanningScene& scene, const std::vector<double>& state, const SceneChange& change,
                         const SceneDefaults& defaults, const SceneLimits& limits, const ExternalFrames& frames);

/// The full scene that turns any other scene of the robot into `scene`.
SceneChange fullSceneOf(const PlanningScene& scene);

/// The change from one scene of a robot to another: applyChange(from, diffOf(from, to)) gives `to`. Two things may
/// differ: the order of the objects, and the paddings of the objects, which a change cannot name. The result is a full
/// scene if no diff leads to `to`.
SceneChange diffOf(const PlanningScene& from, const PlanningScene& to);
}  // namespace gpu_planning_scene::core
