# Builds without ROS: sets the install folders that catkin sets otherwise.
#catkin_lint: ignore immutable_var
set(CATKIN_GLOBAL_INCLUDE_DESTINATION include)
set(CATKIN_GLOBAL_PYTHON_DESTINATION lib/python3/dist-packages)
set(CATKIN_PACKAGE_LIB_DESTINATION lib)
set(CATKIN_PACKAGE_BIN_DESTINATION lib/${PROJECT_NAME})
set(CATKIN_PACKAGE_SHARE_DESTINATION share/${PROJECT_NAME})
#catkin_lint: report immutable_var
