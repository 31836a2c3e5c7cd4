#include <moveit/collision_detection/test_collision_common_panda.h>
#include <moveit/collision_detection/test_collision_common_pr2.h>

#include "gpu_planning_scene/moveit/collision_detector_allocator.h"
#include "moveit/moveit_resources.h"

// MoveIt's own suites for collision detectors, with this package's detector. MoveIt runs each of them with its own FCL
// and Bullet detectors; scripts/moveit_suite prints all results side by side.
using gpu_planning_scene::detector::CollisionDetectorAllocator;

INSTANTIATE_TYPED_TEST_SUITE_P(GpuPlanningScene, CollisionDetectorPandaTest, CollisionDetectorAllocator);
REGISTER_TYPED_TEST_SUITE_P(DistanceCheckPandaTest, DistanceSingle);
INSTANTIATE_TYPED_TEST_SUITE_P(GpuPlanningScene, DistanceCheckPandaTest, CollisionDetectorAllocator);
REGISTER_TYPED_TEST_SUITE_P(DistanceFullPandaTest, DistancePoints);
INSTANTIATE_TYPED_TEST_SUITE_P(GpuPlanningScene, DistanceFullPandaTest, CollisionDetectorAllocator);
INSTANTIATE_TYPED_TEST_SUITE_P(GpuPlanningScene, CollisionDetectorTest, CollisionDetectorAllocator);

int main(int argc, char** argv)
{
  gpu_planning_scene::useMoveItResources();
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
