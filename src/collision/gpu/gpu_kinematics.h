#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "collision/gpu/pose_source.h"
#include "collision/problem/collision_problem.h"
#include "gpu/program.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// Forward kinematics on the GPU, by a shader that is made for the robot. Used on the context's thread.
class GpuKinematics : public PoseSource
{
 public:
  GpuKinematics(const std::string& shader_folder, std::shared_ptr<const RobotModel> robot);

  const std::shared_ptr<const RobotModel>& robot() const { return robot_; }

  /// The shapes to place: those of `problem.robot`.
  void setInstances(const CollisionProblem& problem);

  /// Whether the shader's sines are right for all angles of a state.
  bool canPlace(const double* state) const;

  /// The batch that `write` is about: row-major, rows of the robot's variables, which canPlace.
  void setStates(const double* states) { states_ = states; }
  void write(std::size_t begin, std::size_t count, TexelBuffer& poses) override;

 private:
  std::shared_ptr<const RobotModel> robot_;
  Program program_;
  std::vector<double> largest_;  // amount of each variable
  const double* states_ = nullptr;
  // Two, so that states go up while the GPU works on those before.
  std::array<TexelBuffer, 2> uploads_;
  std::size_t next_upload_ = 0;
  TexelBuffer link_shapes_;
};
}  // namespace gpu_planning_scene::core
