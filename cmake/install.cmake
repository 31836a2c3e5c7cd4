# Installs the files that are needed at run time and to build against the package.
set(libraries gpu_planning_scene_model gpu_planning_scene_scene gpu_planning_scene_gpu gpu_planning_scene_collision
  gpu_planning_scene_planning)
set(export_folder ${CATKIN_PACKAGE_SHARE_DESTINATION}/cmake)
# Debian's catkin installs CMake's files of a library beside the library if the prefix is /usr.
set(installed_export_folder ${export_folder})
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr" AND CATKIN_PACKAGE_LIB_DESTINATION MATCHES "/")
  set(installed_export_folder ${CATKIN_PACKAGE_LIB_DESTINATION}/cmake/${PROJECT_NAME})
endif()
# The libraries find read_mesh here. In Debian's packages, this folder is not the one of the other programs.
set(read_mesh_folder ${CATKIN_PACKAGE_LIB_DESTINATION}/${PROJECT_NAME})

# The binary interface may change with each minor version until 1.0. A wheel cannot hold the symbolic links of versions.
if(NOT GPU_PLANNING_SCENE_WHEEL)
  set(versioned ${libraries})
  if(TARGET gpu_planning_scene_client)
    list(APPEND versioned gpu_planning_scene_client)
  endif()
  set_target_properties(${versioned} PROPERTIES VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
endif()

# A wheel has only what the Python module needs: the libraries, the shaders and the reader of mesh files. The prefix is the folder of the Python package.
if(GPU_PLANNING_SCENE_WHEEL)
  install(TARGETS ${libraries} LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
  install(TARGETS read_mesh RUNTIME DESTINATION ${read_mesh_folder})
  install(DIRECTORY shaders DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
  return()
endif()

install(TARGETS ${libraries} EXPORT gpu_planning_scene-targets LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
install(TARGETS check_states generate_acm render RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(TARGETS read_mesh RUNTIME DESTINATION ${read_mesh_folder})
install(DIRECTORY include/ DESTINATION ${CATKIN_GLOBAL_INCLUDE_DESTINATION})
install(DIRECTORY shaders config launch DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
install(EXPORT gpu_planning_scene-targets NAMESPACE gpu_planning_scene:: DESTINATION ${installed_export_folder})

if(NOT GPU_PLANNING_SCENE_ROS)
  # catkin_package writes these files otherwise.
  include(CMakePackageConfigHelpers)
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/gpu_planning_sceneConfig-version.cmake
    COMPATIBILITY SameMinorVersion)
  #catkin_lint: ignore_once missing_file
  install(FILES ${PROJECT_BINARY_DIR}/gpu_planning_sceneConfig-version.cmake DESTINATION ${export_folder})
  install(FILES cmake/gpu_planning_scene-extras.cmake DESTINATION ${export_folder} RENAME gpu_planning_sceneConfig.cmake)
endif()

if(GPU_PLANNING_SCENE_ROS)
  install(TARGETS gpu_planning_scene_client EXPORT gpu_planning_scene-targets
    LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
  install(TARGETS gpu_planning_scene_planners LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
  install(FILES planner_plugins.xml DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
  if(TARGET gpu_planning_scene_moveit)
    install(TARGETS gpu_planning_scene_moveit gpu_planning_scene_moveit_planner
      LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
    install(FILES moveit_plugins.xml moveit_planner_plugins.xml DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
  endif()
  install(TARGETS add_object planning_scene_node RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  catkin_install_python(PROGRAMS scripts/allow_collision.py scripts/demo_client.py scripts/joint_sliders.py scripts/limit_speed.py
    scripts/save_scene.py scripts/show_scene.py
    DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  export(EXPORT gpu_planning_scene-targets NAMESPACE gpu_planning_scene::
    FILE ${CATKIN_DEVEL_PREFIX}/${export_folder}/gpu_planning_scene-targets.cmake)
endif()
