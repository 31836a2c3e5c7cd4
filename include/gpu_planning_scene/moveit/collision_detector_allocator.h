#pragma once

#include <string>

#include <moveit/collision_detection/collision_detector_allocator.h>

namespace gpu_planning_scene::detector
{
/// Makes MoveIt's collision environments that answer with the exact tests of this package. The detector's name is
/// gpu_planning_scene. Example:
///
///     scene->setActiveCollisionDetector(CollisionDetectorAllocator::create(), true);
class CollisionDetectorAllocator : public collision_detection::CollisionDetectorAllocator
{
 public:
  static collision_detection::CollisionDetectorAllocatorPtr create();

  const std::string& getName() const override;
  collision_detection::CollisionEnvPtr allocateEnv(const collision_detection::WorldPtr& world,
                                                   const moveit::core::RobotModelConstPtr& robot) const override;
  /// Throws std::invalid_argument if another detector made `original`.
  collision_detection::CollisionEnvPtr allocateEnv(const collision_detection::CollisionEnvConstPtr& original,
                                                   const collision_detection::WorldPtr& world) const override;
  collision_detection::CollisionEnvPtr allocateEnv(const moveit::core::RobotModelConstPtr& robot) const override;
};
}  // namespace gpu_planning_scene::detector
