#include "gpu_planning_scene/moveit/collision_detector_allocator.h"

#include <memory>
#include <stdexcept>

#include "moveit/collision_env.h"

namespace gpu_planning_scene::detector
{
using collision_detection::CollisionEnvPtr;

collision_detection::CollisionDetectorAllocatorPtr CollisionDetectorAllocator::create()
{
  return std::make_shared<CollisionDetectorAllocator>();
}

const std::string& CollisionDetectorAllocator::getName() const
{
  static const std::string name = "gpu_planning_scene";
  return name;
}

CollisionEnvPtr CollisionDetectorAllocator::allocateEnv(const collision_detection::WorldPtr& world,
                                                        const moveit::core::RobotModelConstPtr& robot) const
{
  return std::make_shared<CollisionEnv>(robot, world);
}

CollisionEnvPtr CollisionDetectorAllocator::allocateEnv(const collision_detection::CollisionEnvConstPtr& original,
                                                        const collision_detection::WorldPtr& world) const
{
  const auto* ours = dynamic_cast<const CollisionEnv*>(original.get());
  if (!ours)
    throw std::invalid_argument("gpu_planning_scene copies only its own collision environments");
  return std::make_shared<CollisionEnv>(*ours, world);
}

CollisionEnvPtr CollisionDetectorAllocator::allocateEnv(const moveit::core::RobotModelConstPtr& robot) const
{
  return std::make_shared<CollisionEnv>(robot);
}
}  // namespace gpu_planning_scene::detector
