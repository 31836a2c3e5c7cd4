#pragma once

#include <functional>

#include <Eigen/Geometry>

#include "collision/gpu/problem/pose_source.h"
#include "collision/problem/collision_problem.h"

namespace gpu_planning_scene::core
{
/// Poses that the CPU computes on all cores and uploads to the GPU. They serve problems without a robot model, and
/// states that GpuKinematics cannot place, e.g. on a device whose double precision is not reliable.
class UploadedPoses : public PoseSource
{
 public:
  /// Writes the poses of all links in state `row`; ShapeInstance::link is the index of a link. Called from several
  /// threads.
  using LinkPoses = std::function<void(std::size_t row, Eigen::Isometry3d* link_poses)>;

  UploadedPoses(const CollisionProblem& problem, std::size_t link_count, const LinkPoses& link_poses)
    : problem_(problem), link_count_(link_count), link_poses_(link_poses)
  {
  }
  void begin(std::size_t begin, std::size_t count) override
  {
    begin_ = begin;
    count_ = count;
  }
  void place(TexelBuffer& poses) override;

 private:
  const CollisionProblem& problem_;
  std::size_t link_count_;
  const LinkPoses& link_poses_;
  std::size_t begin_ = 0;  // first state of the part
  std::size_t count_ = 0;
};
}  // namespace gpu_planning_scene::core
