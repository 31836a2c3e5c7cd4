# The catkin package: its messages, and its exports for find_package(gpu_planning_scene).

# Debian's ROS needs the system's Python, which has catkin_pkg and ament_package (for pluginlib). A python3 of pyenv or
# conda, which may come earlier on PATH, lacks them.
foreach(name PYTHON_EXECUTABLE Python3_EXECUTABLE)
  if(NOT ${name} AND EXISTS /usr/bin/python3)
    set(${name} /usr/bin/python3 CACHE FILEPATH "The Python that has catkin_pkg and ament_package")
  endif()
endforeach()

find_package(catkin REQUIRED COMPONENTS actionlib_msgs diagnostic_msgs geometry_msgs message_generation pluginlib roscpp
  roslib sensor_msgs shape_msgs std_msgs tf2 tf2_ros trajectory_msgs visualization_msgs)

set(message_dependencies diagnostic_msgs geometry_msgs sensor_msgs shape_msgs std_msgs trajectory_msgs)
add_message_files(FILES
  AllowedCollisionEntry.msg
  AllowedCollisionMatrix.msg
  AnswerStatus.msg
  AttachedCollisionObject.msg
  BoundingVolume.msg
  CollisionObject.msg
  Constraints.msg
  ContactInformation.msg
  BodyDistance.msg
  BodySolid.msg
  JointConstraint.msg
  LinkPadding.msg
  LinkScale.msg
  NearestPair.msg
  ObjectColor.msg
  ObjectType.msg
  Octomap.msg
  OctomapWithPose.msg
  OrientationConstraint.msg
  PlanningScene.msg
  PlanningSceneComponents.msg
  PlanningSceneWorld.msg
  PositionConstraint.msg
  RobotState.msg
  WatchState.msg
  WorkspaceParameters.msg)
add_service_files(FILES
  ApplyPlanningScene.srv
  CheckMotions.srv
  CheckStates.srv
  CheckTrajectory.srv
  Clear.srv
  ComputeCartesianPath.srv
  ComputeFk.srv
  ComputeIk.srv
  ExcludeFromSensors.srv
  GetPlanningScene.srv
  GetReport.srv
  PlanMotion.srv
  ShowTreeLevel.srv
  WatchTrajectory.srv)
generate_messages(DEPENDENCIES ${message_dependencies})

# Only the libraries without ROS are exported, so that their users need no roscpp.
catkin_package(
  INCLUDE_DIRS include
  LIBRARIES gpu_planning_scene_model gpu_planning_scene_scene gpu_planning_scene_gpu gpu_planning_scene_collision
    gpu_planning_scene_planning
  CATKIN_DEPENDS message_runtime ${message_dependencies}
  DEPENDS EIGEN3 OMPL
  CFG_EXTRAS gpu_planning_scene-extras.cmake)
