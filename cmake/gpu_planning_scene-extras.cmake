# Part of find_package(gpu_planning_scene): the libraries as targets too, gpu_planning_scene::gpu_planning_scene_collision
# and those below it. They carry what they need, and no ROS.
find_package(Eigen3 REQUIRED)
include("${gpu_planning_scene_DIR}/gpu_planning_scene-targets.cmake")
