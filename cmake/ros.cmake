# The catkin package: messages, and what other packages get by find_package(gpu_planning_scene).

# Debian's ROS lives in the system's Python; a pyenv or conda python3 earlier on PATH lacks catkin_pkg.
if(NOT PYTHON_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(PYTHON_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "The Python that has catkin_pkg")
endif()

find_package(catkin REQUIRED COMPONENTS message_generation roscpp roslib sensor_msgs std_msgs)
find_package(Eigen3 REQUIRED)

add_service_files(FILES CheckStates.srv)
generate_messages(DEPENDENCIES std_msgs)

# Only the ROS-free libraries are exported, so a user of the library needs no roscpp.
catkin_package(
  INCLUDE_DIRS include
  LIBRARIES gpu_planning_scene_model gpu_planning_scene_scene gpu_planning_scene_gpu gpu_planning_scene_collision
  CATKIN_DEPENDS message_runtime std_msgs
  DEPENDS EIGEN3
  CFG_EXTRAS gpu_planning_scene-extras.cmake)
