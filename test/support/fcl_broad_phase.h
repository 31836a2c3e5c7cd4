#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core
{
/// FCL's manager of objects in a dynamic tree of boxes, with which MoveIt finds the objects near a link. It is given
/// boxes that are tighter than FCL's own of turned objects. Not thread-safe.
class FclBroadPhase
{
 public:
  explicit FclBroadPhase(const std::vector<Eigen::AlignedBox3d>& boxes);
  ~FclBroadPhase();
  FclBroadPhase(const FclBroadPhase&) = delete;
  FclBroadPhase& operator=(const FclBroadPhase&) = delete;

  /// The numbers of the boxes that overlap `bounds`; valid until the next call.
  const std::vector<std::uint32_t>& near(const Eigen::AlignedBox3d& bounds);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
