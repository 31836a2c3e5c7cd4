# The catkin package: messages, and what other packages get by find_package(gpu_planning_scene).

# Debian's ROS lives in the system's Python; a pyenv or conda python3 earlier on PATH lacks catkin_pkg.
# So does what Debian's pluginlib brings.
foreach(name PYTHON_EXECUTABLE Python3_EXECUTABLE)
  if(NOT ${name} AND EXISTS /usr/bin/python3)
    set(${name} /usr/bin/python3 CACHE FILEPATH "The Python that has catkin_pkg and ament_package")
  endif()
endforeach()

find_package(catkin REQUIRED COMPONENTS diagnostic_msgs geometry_msgs message_generation pluginlib roscpp roslib
  sensor_msgs shape_msgs std_msgs tf2 tf2_ros trajectory_msgs visualization_msgs)
find_package(Eigen3 REQUIRED)

set(message_dependencies diagnostic_msgs geometry_msgs sensor_msgs shape_msgs std_msgs trajectory_msgs)
add_message_files(FILES
  AllowedCollisionEntry.msg
  AllowedCollisionMatrix.msg
  AttachedCollisionObject.msg
  CollisionObject.msg
  ContactInformation.msg
  LinkPadding.msg
  LinkScale.msg
  ObjectColor.msg
  PlanningScene.msg
  PlanningSceneComponents.msg
  PlanningSceneWorld.msg
  RobotState.msg)
add_service_files(FILES
  ApplyPlanningScene.srv
  CheckMotions.srv
  CheckStates.srv
  Clear.srv
  GetPlanningScene.srv
  GetReport.srv
  PlanMotion.srv
  ShowTreeLevel.srv)
generate_messages(DEPENDENCIES ${message_dependencies})

# Only the ROS-free libraries are exported, so a user of the library needs no roscpp.
catkin_package(
  INCLUDE_DIRS include
  LIBRARIES gpu_planning_scene_model gpu_planning_scene_scene gpu_planning_scene_gpu gpu_planning_scene_collision
    gpu_planning_scene_planning
  CATKIN_DEPENDS message_runtime ${message_dependencies}
  DEPENDS EIGEN3 OMPL
  CFG_EXTRAS gpu_planning_scene-extras.cmake)
