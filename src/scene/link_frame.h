#pragma once

#include <string>

#include <Eigen/Geometry>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// A frame that moves with a link: that of the link, of an object that it carries, or a subframe of this object.
struct LinkFrame
{
  int link = -1;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in the link's frame
};

/// The frame of this name, looked up as PlanningScene::frame. Throws Error if the scene has no such frame, or if no
/// link carries it.
LinkFrame linkFrame(const PlanningScene& scene, const std::string& name);
}  // namespace gpu_planning_scene::core
