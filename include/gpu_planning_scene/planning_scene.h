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
struct WorldObject
{
  std::string id;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();   ///< in the planning frame
  std::vector<PlacedShape> shapes;                          ///< in the object's frame
  double padding = 0.0;                                     ///< metres, at least 0: see PlanningScene::link_padding
  std::map<std::string, Eigen::Isometry3d> subframes = {};  ///< named poses in the object's frame: see frame()
};

/// An object that a link carries. It moves with the link, collides with the world, padded and scaled as its link is,
/// with links other than its own and its touch links, and with what other links carry.
struct AttachedObject
{
  WorldObject object;  ///< its pose is in the link's frame; its own padding counts where it is in the world
  int link = -1;
  std::vector<int> touch_links = {};  ///< link indices; its own link need not be among them
  double padding = 0.0;               ///< metres, at least 0, added to its link's
  /// The object's shapes with its link's scale, see PlanningScene::scaleCarried; null: as they are in `object`.
  std::shared_ptr<const std::vector<PlacedShape>> scaled_shapes = nullptr;

  /// What collides, in the object's frame.
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

/// Where a scene's allowed-collision matrix comes from.
enum class MatrixSource
{
  Srdf,
  AdjacentLinks,  ///< there is no SRDF
  SceneFile       ///< or a message
};

/// What a scene starts with, and what new objects get.
struct SceneDefaults
{
  std::vector<double> link_padding;  ///< metres, one per link, or none: all 0
  std::vector<double> link_scale;    ///< one per link, or none: all 1
  double object_padding = 0.0;       ///< metres
  double attached_padding = 0.0;     ///< metres: see AttachedObject::padding
};

/// A robot, the objects around it, which pairs may touch, and the current state. A value: checkers take it as an
/// immutable snapshot (`std::shared_ptr<const PlanningScene>`).
/// A *body* is a link, an object or an attached object; body indices count the links first, then the objects, then the
/// attached objects.
struct PlanningScene
{
  explicit PlanningScene(std::shared_ptr<const RobotModel> robot_model, const SceneDefaults& defaults = {});

  std::string name = {};
  std::shared_ptr<const RobotModel> robot;  ///< scaled: see setLinkScale
  std::vector<WorldObject> objects;
  std::vector<AttachedObject> attached;
  /// Metres, at least 0, one per link; empty: all 0. A link and an object collide where their distance is at most the
  /// sum of their paddings; what a link carries has its link's and its own. Pairs of links are not padded.
  std::vector<double> link_padding;
  AllowedCollisionMatrix allowed_collisions;
  MatrixSource matrix_source;  ///< for reports
  /// One value per variable of the robot, empty until one was set or received.
  std::vector<double> current_state;
  std::map<std::string, Eigen::Isometry3d> fixed_frames = {};  ///< poses in the planning frame, by name
  std::map<std::string, Color> colors = {};                    ///< by object or link; they change no answer
  std::uint64_t revision = 0;

  const std::string& bodyName(int body) const;

  /// Makes a world object one that `link` carries, where it is in `state` (one value per variable). Throws Error and
  /// changes nothing: unknown object or link, an object with a half-space.
  void attach(const std::string& object, const std::string& link, const std::vector<std::string>& touch_links,
              const double* state);
  /// Puts an attached object back into the world, where it is in `state`. Throws Error and changes nothing: it is
  /// unknown.
  void detach(const std::string& object, const double* state);

  /// Scales the shapes of links, and with them those of what they carry: see RobotModel::scaled, which replaces
  /// `robot`. Throws Error and changes nothing.
  void setLinkScale(const std::vector<double>& factors);
  /// Gives a carried object the scale of its link. Needed before one that was not made by attach() is added.
  void scaleCarried(AttachedObject& carried) const;

  /// The pose in the planning frame of the frame of that name: the planning frame's (or none), a link's, an object's or
  /// attached object's, a subframe's (OBJECT/SUBFRAME) or a fixed frame's, in this order; a leading slash may be there
  /// or not. No value: the scene has no such frame. Throws Error where a link's pose is needed and `state` is null or
  /// not finite.
  std::optional<Eigen::Isometry3d> frame(const std::string& frame_name, const double* state) const;
};

/// A scene file. One whose name ends in .scene has the layout of RViz's MotionPlanning plugin: objects, their colours
/// and subframes. All others are YAML in MoveIt's PlanningScene field names: the layout of MoveIt's own YAML (poses
/// with x, y, z, w keys; entry_values with `enabled`) and the compact one (arrays, `type: box`, bare rows). Everything
/// is checked before anything is kept. Throws Error with file and line. Joints that the robot lacks, and what is not
/// modelled, give warnings. Object poses are in `planningFrame()`; a header.frame_id may name it, a link, or a frame of
/// fixed_frame_transforms. `meshes`: who reads the mesh files that it names. `defaults`: padding and scale of what the
/// file does not name.
PlanningScene loadSceneFile(const std::string& path, std::shared_ptr<const RobotModel> robot,
                            const PackageResolver& packages, std::vector<std::string>* warnings = nullptr,
                            const MeshAccess& meshes = {}, const SceneDefaults& defaults = {});
}  // namespace gpu_planning_scene::core
