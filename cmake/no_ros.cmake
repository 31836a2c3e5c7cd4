# The libraries, tools and benchmarks on a machine without ROS: the folders that catkin would name.
set(CATKIN_GLOBAL_INCLUDE_DESTINATION include)
set(CATKIN_PACKAGE_LIB_DESTINATION lib)
set(CATKIN_PACKAGE_BIN_DESTINATION lib/${PROJECT_NAME})
set(CATKIN_PACKAGE_SHARE_DESTINATION share/${PROJECT_NAME})
