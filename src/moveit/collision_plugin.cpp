#include <moveit/collision_detection/collision_plugin.h>
#include <pluginlib/class_list_macros.hpp>

#include "gpu_planning_scene/moveit/collision_detector_allocator.h"

// The detector for MoveIt's plugin loader: see moveit_plugins.xml.
namespace gpu_planning_scene::detector
{
class CollisionPlugin : public collision_detection::CollisionPlugin
{
 public:
  bool initialize(const planning_scene::PlanningScenePtr& scene, bool exclusive) const override
  {
    scene->setActiveCollisionDetector(CollisionDetectorAllocator::create(), exclusive);
    return true;
  }
};
}  // namespace gpu_planning_scene::detector

PLUGINLIB_EXPORT_CLASS(gpu_planning_scene::detector::CollisionPlugin, collision_detection::CollisionPlugin)
