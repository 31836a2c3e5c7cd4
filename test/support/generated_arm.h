#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// A six-axis arm of about 1.1 m that the project makes itself, of any number of triangles: the growth of time with
/// triangles is measured with it, and it serves where no other robot is at hand. Its URDF, SRDF and meshes (binary STL)
/// lie in a temporary folder that goes with it.
class GeneratedArm
{
 public:
  /// `triangles`: of all links, about.
  explicit GeneratedArm(std::size_t triangles);
  ~GeneratedArm();
  GeneratedArm(const GeneratedArm&) = delete;
  GeneratedArm& operator=(const GeneratedArm&) = delete;

  std::shared_ptr<const RobotModel> load() const;

 private:
  std::string folder_;
};
}  // namespace gpu_planning_scene::core
