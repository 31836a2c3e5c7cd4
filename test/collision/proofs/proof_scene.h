#pragma once

#include <memory>

#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
/// The slider robot, with a padded pole and a carried ball, among one object of each kind.
inline std::shared_ptr<PlanningScene> proofScene(const std::shared_ptr<const RobotModel>& robot)
{
  auto scene = std::make_shared<PlanningScene>(robot);
  const auto add = [&scene](const std::string& id, const Shape& shape, const Eigen::Isometry3d& pose) {
    scene->objects.push_back({id, pose, {{shape, Eigen::Isometry3d::Identity()}}, 0.0});
  };
  const Eigen::Isometry3d tilted(Eigen::AngleAxisd(0.6, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()));
  add("box", Box{{0.2, 0.3, 0.1}}, Eigen::Translation3d(0.5, 0.3, 0.4) * tilted);
  add("ball", Sphere{0.15}, Eigen::Isometry3d(Eigen::Translation3d(-0.5, 0.2, 0.5)));
  add("can", Cylinder{0.1, 0.3}, Eigen::Translation3d(0.1, -0.3, 0.5) * tilted);
  add("cone", Cone{0.1, 0.3}, Eigen::Translation3d(-0.8, -0.2, 0.5) * tilted);
  add("stone", tessellate(Sphere{0.1}).mesh, Eigen::Isometry3d(Eigen::Translation3d(0.9, -0.1, 0.6)));
  add("floor", HalfSpace{Eigen::Vector3d::UnitZ(), -0.4}, Eigen::Isometry3d::Identity());
  scene->link_padding.assign(robot->links().size(), 0.01);
  scene->attached.push_back({{"load",
                              Eigen::Isometry3d(Eigen::Translation3d(0.3, 0.0, 0.0)),
                              {{Sphere{0.08}, Eigen::Isometry3d::Identity()}},
                              0.0},
                             robot->linkIndex("pole")});
  return scene;
}
}  // namespace gpu_planning_scene::core
