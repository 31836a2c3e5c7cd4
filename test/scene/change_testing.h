#pragma once

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gpu_planning_scene/scene_change.h"
#include "model/model_testing.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
Eigen::Isometry3d poseAt(double x, double y, double z, double angle_about_z = 0.0);

PlacedShape boxAt(double size, const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity());
PlacedShape triangleAt(const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity());

/// A change of one object with its operation and id. A test sets the other fields.
ObjectChange objectChange(Operation operation, const std::string& id, std::vector<PlacedShape> shapes = {});
AttachedChange attachedChange(Operation operation, const std::string& id, const std::string& link,
                              std::vector<PlacedShape> shapes = {});

/// Expects that two scenes are equal up to rounding and the order of objects. Fields that no SceneChange can set are
/// not compared.
void expectSameScene(const PlanningScene& expected, const PlanningScene& found, double tolerance = 0.0);

/// Changes a scene of the slider robot (slider_robot.h) step by step.
class SceneChanges : public testing::Test
{
 protected:
  void apply(const SceneChange& change);
  /// Applies a difference that contains only this object or attached object.
  void change(const ObjectChange& object);
  void change(const AttachedChange& attached);
  /// Expects that the change is refused with a message of one line that contains `fragment`, and that nothing changes.
  void refused(const std::string& fragment, const SceneChange& change);
  void refused(const std::string& fragment, const ObjectChange& object);
  void refused(const std::string& fragment, const AttachedChange& attached);

  const WorldObject& object(const std::string& id) const;
  const AttachedObject& carried(const std::string& id) const;
  bool warned(const std::string& fragment) const;
  int link(const std::string& name) const { return scene_.robot->linkIndex(name); }

  PlanningScene scene_{sliderRobot()};
  std::vector<double> state_ = {0.5, M_PI_2};  // slide, turn
  std::vector<std::string> warnings_;          // of the last change
  SceneDefaults defaults_;
  SceneLimits limits_;
  ExternalFrames frames_;
};
}  // namespace gpu_planning_scene::core
