# Part of find_package(gpu_planning_scene): the libraries as targets too, gpu_planning_scene::gpu_planning_scene_planning,
# gpu_planning_scene::gpu_planning_scene_collision and those below it. They carry what they need, and no ROS.
find_package(Eigen3 REQUIRED)
if(TARGET gpu_planning_scene_collision)  # a workspace that builds all packages in one CMake run
  foreach(library model scene gpu collision planning)
    if(NOT TARGET gpu_planning_scene::gpu_planning_scene_${library})
      add_library(gpu_planning_scene::gpu_planning_scene_${library} ALIAS gpu_planning_scene_${library})
    endif()
  endforeach()
else()
  include("${gpu_planning_scene_DIR}/gpu_planning_scene-targets.cmake")
endif()
