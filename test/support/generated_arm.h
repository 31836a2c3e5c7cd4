#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// A six-axis arm of about 1.1 m with any number of triangles, which the project generates itself. It serves to measure
/// how time grows with triangles, and as the robot where no other is available. Its URDF, SRDF and meshes (binary STL)
/// lie in a temporary folder that the destructor removes.
class GeneratedArm
{
 public:
  /// `triangles`: the approximate number of triangles of all links together.
  explicit GeneratedArm(std::size_t triangles);
  ~GeneratedArm();
  GeneratedArm(const GeneratedArm&) = delete;
  GeneratedArm& operator=(const GeneratedArm&) = delete;

  std::shared_ptr<const RobotModel> load() const;

  /// The arm on a base that drives: an SRDF with a planar virtual joint.
  std::shared_ptr<const RobotModel> loadDriven() const;

 private:
  std::string folder_;
};
}  // namespace gpu_planning_scene::core
