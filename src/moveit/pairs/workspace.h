#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "moveit/pairs/exact_pair.h"
#include "moveit/shapes/shape_instance.h"

namespace gpu_planning_scene::detector
{
/// Memory of one check, kept for the next check of the same thread. A check may run inside another one, because MoveIt
/// calls functions of its users (deciders, is_done) during a check; then each has its own.
class Workspace
{
 public:
  Workspace();
  ~Workspace();
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  struct Memory
  {
    std::vector<ShapeInstance> instances;     ///< of the robot
    std::vector<CollisionShapePtr> attached;  ///< shapes of attached objects
    std::vector<std::uint32_t> nodes;
    PairScratch pair;
  };
  Memory& operator*() { return *memory_; }
  Memory* operator->() { return memory_.get(); }

 private:
  std::unique_ptr<Memory> memory_;
};
}  // namespace gpu_planning_scene::detector
