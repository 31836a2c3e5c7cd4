#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/allowed_collision_matrix.h"
#include "gpu_planning_scene/robot_model.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// The type of an object in a database of known objects, as in object_recognition_msgs/ObjectType. It changes no
/// verdict.
struct ObjectType
{
  std::string key;
  std::string db;

  bool isEmpty() const { return key.empty() && db.empty(); }
};
inline bool operator==(const ObjectType& a, const ObjectType& b)
{
  return a.key == b.key && a.db == b.db;
}

/// A joint trajectory as in trajectory_msgs/JointTrajectory. Times are in nanoseconds.
struct JointTrajectory
{
  struct Point
  {
    std::vector<double> positions;
    std::vector<double> velocities;
    std::vector<double> accelerations;
    std::vector<double> effort;
    std::int64_t time_from_start = 0;
  };
  std::string frame_id;
  std::int64_t stamp = 0;
  std::vector<std::string> joint_names;
  std::vector<Point> points;
};
bool operator==(const JointTrajectory& a, const JointTrajectory& b);

/// An object of the world.
struct WorldObject
{
  std::string id;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();   ///< in the planning frame
  std::vector<PlacedShape> shapes;                          ///< in the object's frame
  double padding = 0.0;                                     ///< metres, at least 0: see PlanningScene::link_padding
  std::map<std::string, Eigen::Isometry3d> subframes = {};  ///< named poses in the object's frame: see frame()
  ObjectType type = {};
};

/// An object that a link carries. It moves with the link and has the link's padding and scale. It is checked against
/// the world, against all links except its own and its touch links, and against the objects that other links carry.
struct AttachedObject
{
  WorldObject object;  ///< its pose is in the link's frame; its `padding` counts only after detach()
  int link = -1;
  std::vector<int> touch_links = {};    ///< link indices; the carrying link need not be listed
  double padding = 0.0;                 ///< metres, at least 0, added to the link's padding
  double weight = 0.0;                  ///< kilograms; it changes no verdict
  JointTrajectory detach_posture = {};  ///< releases the object; it changes no verdict
  /// The object's shapes at the scale of its link, see PlanningScene::scaleAttached; null: the shapes of `object`,
  /// unscaled.
  std::shared_ptr<const std::vector<PlacedShape>> scaled_shapes = nullptr;

  /// The shapes that are checked, in the object's frame.
  const std::vector<PlacedShape>& shapes() const { return scaled_shapes ? *scaled_shapes : object.shapes; }
};

struct Color  ///< each component from 0 to 1
{
  float r = 0.0F;
  float g = 0.0F;
  float b = 0.0F;
  float a = 1.0F;
};
inline bool operator==(const Color& a, const Color& b)
{
  return a.r == b.r && a.g == b.g && a.b == b.b && a.a == b.a;
}

/// Source of the allowed collision matrix of a scene.
enum class MatrixSource
{
  Srdf,
  AdjacentLinks,  ///< there is no SRDF
  SceneFile       ///< from a scene file or a message
};

/// Initial values of a scene, and paddings of new objects.
struct SceneDefaults
{
  std::vector<double> link_padding;  ///< metres, one per link; empty: all 0
  std::vector<double> link_scale;    ///< one per link; empty: all 1
  double object_padding = 0.0;       ///< metres, of each new world object
  double attached_padding = 0.0;     ///< metres: see AttachedObject::padding
};

/// A robot, the objects around it, the allowed collision matrix, and the current state. It is a value: checkers and
/// threads share it as an immutable snapshot (`std::shared_ptr<const PlanningScene>`).
/// A *body* is a link, a world object or an attached object. Body indices count the links first, then the world
/// objects, then the attached objects.
struct PlanningScene
{
  /// Throws Error if a link scale of `defaults` is not valid.
  explicit PlanningScene(std::shared_ptr<const RobotModel> robot_model, const SceneDefaults& defaults = {});

  std::string name = {};
  std::shared_ptr<const RobotModel> robot;  ///< with scaled links: see setLinkScale
  std::vector<WorldObject> objects;
  std::vector<AttachedObject> attached;
  /// Metres, at least 0, one per link; empty: all 0. A link and a world object collide if their distance is at most the
  /// sum of their paddings. The padding of an attached object is its own plus that of its link. A pair in which both
  /// bodies are links or attached objects has no padding.
  std::vector<double> link_padding;
  AllowedCollisionMatrix allowed_collisions;
  MatrixSource matrix_source;  ///< for reports
  /// One value per variable of the robot; empty until a state is set or received.
  std::vector<double> current_state;
  /// True: nobody has set the virtual joint, so current_state has its default value. A service may take the robot's
  /// pose from elsewhere, such as tf.
  bool base_is_default = false;
  std::map<std::string, Eigen::Isometry3d> fixed_frames = {};  ///< poses in the planning frame, by name
  std::map<std::string, Color> colors = {};                    ///< by object or link; they do not affect any check
  std::uint64_t revision = 0;

  /// The object of the world, or the attached object, with this id; null if there is none. Valid until the scene
  /// changes.
  const WorldObject* findObject(const std::string& id) const;
  const AttachedObject* findAttached(const std::string& id) const;

  /// Name of the body with this index.
  const std::string& bodyName(int body) const;

  /// Attaches a world object to `link`. The object stays where it is in `state` (one value per variable). Throws Error
  /// and changes nothing if the object or a link is unknown, if the object has a half-space, or if the link's pose in
  /// `state` is unknown or not finite.
  void attach(const std::string& object, const std::string& link, const std::vector<std::string>& touch_links,
              const double* state);
  /// Returns an attached object to the world, at its place in `state`. Throws Error and changes nothing if no link
  /// carries the object, or if the link's pose in `state` is unknown or not finite.
  void detach(const std::string& object, const double* state);

  /// Scales the shapes of the links and of the objects that they carry. `factors`: one per link; empty: all 1. Replaces
  /// `robot` by RobotModel::scaled. Throws Error as that function does, and then changes nothing.
  void setLinkScale(const std::vector<double>& factors);
  /// Scales the shapes of an attached object as its link is scaled. Call it for an AttachedObject that attach() did not
  /// make, before you add it to `attached`. Throws Error if a scaled shape is not valid.
  void scaleAttached(AttachedObject& object) const;

  /// Pose of a frame in the planning frame. The name is looked up in this order: the planning frame (also as an empty
  /// name), links, objects and attached objects, subframes (OBJECT/SUBFRAME), fixed frames. A leading slash is
  /// optional. No value: the scene has no frame of this name. Throws Error if the pose of a link is needed and `state`
  /// is null or not finite.
  std::optional<Eigen::Isometry3d> frame(const std::string& frame_name, const double* state) const;
};

/// Loads a scene file. A file whose name ends in .scene has the text format of RViz's MotionPlanning plugin: objects,
/// their colours and subframes. Every other file is YAML with the field names of MoveIt's PlanningScene, in MoveIt's
/// own layout (poses with x, y, z, w keys; entry_values with `enabled`) or in a compact layout (`type: box`, poses as
/// arrays, rows of the matrix without `enabled`). A list `allowed_collisions` of pairs of names adds to the allowed
/// collision matrix. Object poses are in `planningFrame()`; header.frame_id can name this frame, a link, or a frame of
/// fixed_frame_transforms. `octomap` can name a .bt or .ot file. `meshes`: how to read the mesh files of the scene.
/// `defaults`: padding and scale of the bodies that the file does not name. `warnings` (may be null) receives a line
/// for each joint that the robot does not have and for each entry that is not modelled. Throws Error with file and
/// line.
PlanningScene loadSceneFile(const std::string& path, std::shared_ptr<const RobotModel> robot,
                            const PackageResolver& packages, std::vector<std::string>* warnings = nullptr,
                            const MeshAccess& meshes = {}, const SceneDefaults& defaults = {});

/// The same for the text of a scene file. `name`: takes the place of the path in messages; a name that ends in .scene
/// means the text format of RViz's plugin. `folder`: start of the relative paths of mesh files.
PlanningScene loadSceneText(const std::string& text, const std::string& name, const std::string& folder,
                            std::shared_ptr<const RobotModel> robot, const PackageResolver& packages,
                            std::vector<std::string>* warnings = nullptr, const MeshAccess& meshes = {},
                            const SceneDefaults& defaults = {});
}  // namespace gpu_planning_scene::core
