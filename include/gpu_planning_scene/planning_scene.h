#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/allowed_collision_matrix.h"
#include "gpu_planning_scene/robot_model.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene
{
struct WorldObject
{
  std::string id;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in the planning frame
  std::vector<PlacedShape> shapes;                         ///< in the object's frame
  double padding = 0.0;                                    ///< metres, at least 0: see PlanningScene::link_padding
};

/// An object that a link carries. It moves with the link, collides with the world, padded as its link is, with links
/// other than its own and its touch links, and with what other links carry.
struct AttachedObject
{
  WorldObject object;  ///< its pose is in the link's frame; its own padding counts where it is in the world
  int link = -1;
  std::vector<int> touch_links;  ///< link indices; its own link need not be among them
};

/// Where a scene's allowed-collision matrix comes from.
enum class MatrixSource
{
  Srdf,
  AdjacentLinks,  ///< there is no SRDF
  SceneFile
};

/// A robot, the objects around it, which pairs may touch, and the current state. A value: checkers take it as an
/// immutable snapshot (`std::shared_ptr<const PlanningScene>`).
/// A *body* is a link, an object or an attached object; body indices count the links first, then the objects, then the
/// attached objects.
struct PlanningScene
{
  explicit PlanningScene(std::shared_ptr<const RobotModel> robot_model);

  std::shared_ptr<const RobotModel> robot;
  std::vector<WorldObject> objects;
  std::vector<AttachedObject> attached;
  /// Metres, at least 0, one per link; empty: all 0. A link and an object collide where their distance is at most the
  /// sum of their paddings. Pairs of links are not padded.
  std::vector<double> link_padding;
  AllowedCollisionMatrix allowed_collisions;
  MatrixSource matrix_source;  ///< for reports
  /// One value per variable of the robot, empty until one was set or received.
  std::vector<double> current_state;
  std::uint64_t revision = 0;

  const std::string& bodyName(int body) const;

  /// Makes a world object one that `link` carries, where it is in `state` (one value per variable). Throws Error and
  /// changes nothing: unknown object or link, an object with a half-space.
  void attach(const std::string& object, const std::string& link, const std::vector<std::string>& touch_links,
              const double* state);
  /// Puts an attached object back into the world, where it is in `state`. Throws Error and changes nothing: it is
  /// unknown.
  void detach(const std::string& object, const double* state);
};

/// A scene file in MoveIt's PlanningScene field names: the layout of MoveIt's own YAML (poses with x, y, z, w keys;
/// entry_values with `enabled`) and the compact one (arrays, `type: box`, bare rows). Everything is checked before
/// anything is kept. Throws Error with file and line. Joints that the robot lacks, and what is not modelled, give
/// warnings. Object poses are in `planningFrame()`; a header.frame_id may name it, a link, or a frame of
/// fixed_frame_transforms. `meshes`: who reads the mesh files that it names.
PlanningScene loadSceneFile(const std::string& path, std::shared_ptr<const RobotModel> robot,
                            const PackageResolver& packages, std::vector<std::string>* warnings = nullptr,
                            const MeshAccess& meshes = {});
}  // namespace gpu_planning_scene
