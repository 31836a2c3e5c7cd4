#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core
{
/// FCL's manager of objects in a dynamic tree of boxes. MoveIt uses it to find the objects near a link. The boxes that
/// it gets here are tighter than FCL's own boxes of rotated objects. Not thread-safe.
class FclBroadPhase
{
 public:
  explicit FclBroadPhase(const std::vector<Eigen::AlignedBox3d>& boxes);
  ~FclBroadPhase();
  FclBroadPhase(const FclBroadPhase&) = delete;
  FclBroadPhase& operator=(const FclBroadPhase&) = delete;

  /// The indices of the boxes that overlap `bounds`; valid until the next call.
  const std::vector<std::uint32_t>& near(const Eigen::AlignedBox3d& bounds);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
