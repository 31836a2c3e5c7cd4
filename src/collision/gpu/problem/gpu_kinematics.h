#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "collision/gpu/problem/copied_states.h"
#include "collision/gpu/problem/pose_source.h"
#include "collision/problem/collision_problem.h"
#include "gpu/program.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// Forward kinematics on the GPU by a shader that is generated for the robot. Used on the context's thread.
class GpuKinematics : public PoseSource
{
 public:
  GpuKinematics(const std::string& shader_folder, std::shared_ptr<const RobotModel> robot);

  const std::shared_ptr<const RobotModel>& robot() const { return robot_; }

  /// Compares the poses of all links in random states with those of the robot model. Returns one line that names the
  /// first link that is elsewhere, or an empty text. So a driver that compiles the robot's shader wrongly is found out.
  /// The poses are floats: smaller differences than about 1e-8 are not seen. Changes the instances and the states.
  std::string findFault();

  /// Sets the shape instances to place: the instances of `problem.robot`.
  void setInstances(const CollisionProblem& problem);

  /// Sets the states: row-major rows of the robot's variables, each in PlaceableStates.
  void setStates(const double* states);
  /// The same for states that a function copies.
  void setStates(CopyStates copy) { copy_ = std::move(copy); }
  void begin(std::size_t begin, std::size_t count) override;
  void place(TexelBuffer& poses) override;
  void placeOpenStates(TexelBuffer& poses, const BatchLists& lists) override;
  std::size_t maxStates() const override;
  std::size_t boundVariables() const override { return robot_->variables().size(); }

 private:
  void bind(TexelBuffer& poses, bool listed);

  std::shared_ptr<const RobotModel> robot_;
  Program program_;
  CopyStates copy_;
  std::size_t count_ = 0;  // states of the part
  // Two buffers, so that states are uploaded while the GPU works on the previous part.
  std::array<TexelBuffer, 2> uploads_;
  std::size_t next_upload_ = 0;
  TexelBuffer link_shapes_;
};
}  // namespace gpu_planning_scene::core
