# Part of find_package(gpu_planning_scene). Provides the libraries also as targets, named
# gpu_planning_scene::gpu_planning_scene_LIBRARY. The targets bring their own dependencies, without ROS. Users of
# gpu_planning_scene_client also need roscpp.
find_package(Eigen3 REQUIRED)
if(TARGET gpu_planning_scene_collision)  # in a workspace that builds all packages in one CMake run
  foreach(library model scene gpu collision planning client)
    if(TARGET gpu_planning_scene_${library} AND NOT TARGET gpu_planning_scene::gpu_planning_scene_${library})
      add_library(gpu_planning_scene::gpu_planning_scene_${library} ALIAS gpu_planning_scene_${library})
    endif()
  endforeach()
else()
  include("${gpu_planning_scene_DIR}/gpu_planning_scene-targets.cmake")
endif()
