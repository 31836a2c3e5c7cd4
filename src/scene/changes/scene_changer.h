#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "gpu_planning_scene/scene_change.h"
#include "scene/changes/scene_count.h"
#include "scene/changes/scene_items.h"
#include "scene/missing_link.h"

namespace gpu_planning_scene::core
{
/// Adds the shapes and subframes. Sets the type if the change has one.
void appendShapes(const ObjectChange& change, WorldObject& object);

/// Applies one change to a copy of a scene. Each kind of part has a file of its own.
class SceneChanger
{
 public:
  /// Looks up a frame that the scene does not know, and returns its pose in the planning frame. Throws Error if the
  /// frame is unknown here too.
  using Lookup = std::function<Eigen::Isometry3d(const StampedFrame&)>;

  SceneChanger(const PlanningScene& scene, const std::vector<double>& state, const SceneDefaults& defaults,
               const SceneLimits& limits, Lookup lookup);

  ChangedScene make(const SceneChange& change);

 private:
  // change_settings.cpp
  void changeNames(const SceneChange& change);
  void changeFixedFrames(const SceneChange& change);
  void changeMatrix(const SceneChange& change);
  void warnOfMatrixReset(const SceneChange& change, const AllowedCollisionMatrix& before);
  void changePadding(const SceneChange& change);
  void warnOfReset(const char* what, const std::vector<double>& before, const std::vector<double>& after,
                   const std::map<std::string, double>& named);
  void changeScale(const SceneChange& change);
  void changeColors(const SceneChange& change);

  // change_solids.cpp
  void changeSolids(const SceneChange& change);

  // change_state.cpp
  void changeState(const StateChange& change, bool is_full_scene);
  void setVariables(const std::map<std::string, double>& variables);
  void removeReplacedAttached(const StateChange& change);

  // change_attached.cpp
  void changeAttached(const AttachedChange& change);
  void requireLoad(const AttachedChange& change) const;
  void attach(const AttachedChange& change);
  AttachedObject fromWorld(const AttachedChange& change, int link);
  AttachedObject fromShapes(const AttachedChange& change, int link);
  void appendToAttached(AttachedObject& attached, const AttachedChange& change);
  void detach(const AttachedChange& change);
  void detachToWorld(const std::string& id);
  Eigen::Isometry3d poseInLink(const Eigen::Isometry3d& pose, const StampedFrame& frame, int link);

  /// Warns if the matrix has entries of the object and of the link that carries it, and does not allow them to touch:
  /// this pair is never checked.
  void warnOfForbiddenCarrier(const AttachedObject& attached);

  // change_objects.cpp
  /// `keeps_settings`: colours and entries of the matrix.
  void warnOfLostObjects(const SceneChange& change);
  void clearWorld(bool keeps_octomap, bool keeps_settings);
  void changeObject(const ObjectChange& change);
  void addObject(const ObjectChange& change);
  void appendToObject(WorldObject& object, const ObjectChange& change);
  void moveObject(const ObjectChange& change);
  void removeObject(const ObjectChange& change);

  // scene_changer.cpp
  void requireNewId(const std::string& id) const;
  int linkIndex(const std::string& name, const std::string& where) const
  {
    return requireLink(*result_.scene.robot, name, where);
  }
  /// Throws Error if a pose, name or shape of the change cannot be used.
  void require(const ObjectChange& change);
  void requirePose(const Eigen::Isometry3d& pose, const std::string& where) const;
  /// Removes the colour and the allowed collisions of a removed object. A matrix stays as it is if the change will
  /// replace it.
  void forget(const std::string& id);
  /// Warns if earlier changes allow the new object to touch other bodies, because these pairs are not checked.
  void warnOfAllowedCollisions(const std::string& id);
  /// The object that an Add describes. Its pose is in the frame of the change.
  WorldObject newObject(const ObjectChange& change) const;
  /// Transforms a pose in `frame` to the planning frame.
  Eigen::Isometry3d placed(const Eigen::Isometry3d& pose, const StampedFrame& frame);
  const std::string& linkName(int link) const
  {
    return result_.scene.robot->links()[static_cast<std::size_t>(link)].name;
  }
  bool isPlanningFrame(const std::string& name) const;
  const double* knownState() const { return result_.state.empty() ? nullptr : result_.state.data(); }

  ChangedScene result_;
  SceneItems<WorldObject> objects_;
  SceneItems<AttachedObject> attached_;
  SceneCount count_;
  const SceneDefaults& defaults_;
  Lookup lookup_;
  bool has_new_matrix_ = false;          // this change sets the matrix
  bool keeps_matrix_ = false;            // the matrix of the scene is the one that the change will leave
  std::set<std::string> attached_here_;  // ids of objects that this change attached
  std::set<const Mesh*> valid_meshes_;   // meshes of this change that were found valid
};
}  // namespace gpu_planning_scene::core
