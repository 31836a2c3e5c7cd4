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
// What MoveIt's messages ask for, without ROS. Names and meanings are those of moveit_msgs, but that a change is made
// wholly or not at all (MoveIt makes the parts that it can).

enum class Operation
{
  Add,     ///< or replace
  Remove,  ///< without an id: all
  Append,  ///< shapes, subframes and touch links; where there is no such object as Add
  Move     ///< of objects of the world
};

/// The name of a frame, and when it is asked for: nanoseconds, 0 for the latest.
struct FrameAt
{
  std::string name;
  std::int64_t stamp = 0;
};
inline bool operator<(const FrameAt& a, const FrameAt& b)
{
  return std::tie(a.name, a.stamp) < std::tie(b.name, b.stamp);
}

struct ObjectChange
{
  Operation operation = Operation::Add;
  std::string id;
  FrameAt frame;  ///< see PlanningScene::frame
  /// Of the object, in `frame`; no value: it was not set. An object that is added is then where the frame is, or, if it
  /// has one shape alone, where that is, and the shape at its origin; one that is appended to stays where it is.
  std::optional<Eigen::Isometry3d> pose;
  std::vector<PlacedShape> shapes;             ///< in the object's frame: primitives, then meshes, then half-spaces
  std::vector<Eigen::Isometry3d> shape_poses;  ///< Move alone: none, or one per shape of the object, in that order
  std::map<std::string, Eigen::Isometry3d> subframes;  ///< in the object's frame
  /// Remove alone. True: the allowed-collision matrix keeps the object's entries, for an object that comes and goes,
  /// such as a point cloud. False, as in MoveIt: the entries are removed with the object.
  bool keeps_allowed_collisions = false;
};

/// What a link carries. Add without shapes takes the world's object of that id, where it is; with shapes it replaces
/// objects of that id, wherever they are. Remove puts it back into the world, where it is; without an id all that the
/// link carries, and without a link all that is carried.
struct AttachedChange
{
  ObjectChange object;
  std::string link;
  std::vector<std::string> touch_links;
};

struct StateChange
{
  std::map<std::string, double> variables;  ///< by name
  std::vector<AttachedChange> attached;     ///< in order, after the variables are set
  /// True: objects that links carry stay. False: `attached` replaces them, in a full scene always, in a difference
  /// where `variables` are given. Objects that are replaced by none are gone, with a warning and without their entries
  /// in the allowed-collision matrix.
  bool is_diff = true;
};

/// Parts are applied in the order in which they stand here. In a difference, what is empty stays as it is; in a full
/// scene it goes back to what a new scene has, but for the state's variables.
struct SceneChange
{
  bool is_diff = false;
  std::string name;
  std::string robot_model_name;                           ///< empty, or the robot's; another's is an error
  std::map<std::string, Eigen::Isometry3d> fixed_frames;  ///< in the planning frame; replace all
  StateChange state;
  std::optional<AllowedCollisionMatrix> matrix;  ///< replaces all; full scene without: the robot's own
  std::map<std::string, double> link_padding;    ///< by link
  std::map<std::string, double> link_scale;
  std::map<std::string, Color> colors;
  std::vector<ObjectChange> objects;  ///< in order
};

/// What a change may lead to; 0: no bound.
struct SceneLimits
{
  std::size_t objects = 100000;      ///< of the world, and carried
  std::size_t shapes = 400000;       ///< of those
  std::size_t triangles = 20000000;  ///< of distinct meshes, the robot's too
  std::size_t triangles_of_mesh = 5000000;
  std::size_t frames = 100000;     ///< fixed ones and subframes
  std::size_t colors = 200000;     ///< of bodies, also of those that are not there yet
  std::size_t name_length = 1024;  ///< bytes of each name
  std::size_t matrix_entries = 4000000;
};

/// Poses in the planning frame of frames that the scene does not know, looked up beforehand by the caller.
using ExternalFrames = std::map<FrameAt, Eigen::Isometry3d>;

/// The frames that `change` names and that neither the scene nor earlier parts of the change know.
std::vector<FrameAt> externalFrames(const PlanningScene& scene, const SceneChange& change);

struct Change
{
  PlanningScene scene;        ///< its current_state is `state`
  std::vector<double> state;  ///< one value per variable; empty where not all are known yet
  std::vector<std::string> warnings;
};

/// The scene that the change leads to; the revision stays. `state`: the robot's, empty where not all of it is known
/// yet. `scene` is valid (validateScene), and so is what comes out. Throws Error that names the object or link and says
/// what to do.
Change applyChange(const PlanningScene& scene, const std::vector<double>& state, const SceneChange& change,
                   const SceneDefaults& defaults, const SceneLimits& limits, const ExternalFrames& frames);

/// The full scene that leads to this one from any other of the robot.
SceneChange fullSceneOf(const PlanningScene& scene);

/// What leads from one scene of a robot to another: applyChange(from, diffOf(from, to)) gives `to`, but for the order
/// of objects and for paddings of objects, which a change cannot name. It is a full scene where no difference leads
/// there.
SceneChange diffOf(const PlanningScene& from, const PlanningScene& to);
}  // namespace gpu_planning_scene::core
