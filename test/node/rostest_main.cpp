// The main() of test programs that rostest runs beside a planning_scene_node.

#include <gtest/gtest.h>
#include <ros/ros.h>

int main(int argc, char** argv)
{
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "rostest");
  ros::AsyncSpinner spinner(1);
  spinner.start();
  return RUN_ALL_TESTS();
}
