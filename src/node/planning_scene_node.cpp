// planning_scene_node: holds a planning scene that clients can change, and checks robot states for collision over ROS.

#include "collision/batch/batch_device.h"
#include "node/run_node.h"

int main(int argc, char** argv)
{
  return gpu_planning_scene::core::runNode(argc, argv, gpu_planning_scene::core::openGpuDevice);
}
