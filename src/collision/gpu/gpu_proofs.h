#pragma once

#include "collision/filter/proofs/robot_proofs.h"
#include "collision/problem/collision_problem.h"
#include "gpu/buffer.h"

namespace gpu_planning_scene::core
{
/// The proofs about a robot in GPU memory: the balls of its covers (shaders/broad_phase/covers.glsl) and its joint
/// tables (shaders/broad_phase/joint_tables.glsl). Used on the context's thread.
class GpuProofs
{
 public:
  /// Uploads the proofs, which must be those of `problem`. If it throws, there are no proofs.
  void set(const RobotProofs& proofs, const CollisionProblem& problem);

  /// From now on there are no proofs.
  void clear() { exist_ = have_tables_ = false; }
  bool exist() const { return exist_; }
  bool haveTables() const { return have_tables_; }
  void bind() const;

 private:
  bool setTables(const RobotProofs& proofs, const CollisionProblem& problem);

  TexelBuffer covers_;
  TexelBuffer tables_;
  bool exist_ = false;
  bool have_tables_ = false;
};
}  // namespace gpu_planning_scene::core
