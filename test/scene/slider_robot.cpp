#include "scene/slider_robot.h"

namespace gpu_planning_scene
{
namespace
{
std::string srdfWith(const std::string& virtual_joint)
{
  return "<robot name=\"slider\">" + virtual_joint + R"(
  <group name="drive"><joint name="slide"/><joint name="turn"/></group>
  <group name="mast"><joint name="turn"/></group>
  <disable_collisions link1="cart" link2="pole" reason="Adjacent"/>
</robot>
)";
}
}  // namespace

std::string sliderUrdf()
{
  return R"(<robot name="slider">
  <link name="rail"/>
  <link name="cart"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="pole">
    <collision><origin xyz="0 0 0.5"/><geometry><box size="0.1 0.1 0.4"/></geometry></collision>
  </link>
  <link name="pennant"/>
  <link name="nut"/>
  <joint name="slide" type="prismatic">
    <parent link="rail"/><child link="cart"/><axis xyz="1 0 0"/>
    <limit lower="-2" upper="2" effort="1" velocity="1"/>
  </joint>
  <joint name="turn" type="revolute">
    <parent link="cart"/><child link="pole"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/>
  </joint>
  <joint name="flag" type="revolute">
    <parent link="pole"/><child link="pennant"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/>
    <mimic joint="turn" multiplier="0.5"/>
  </joint>
  <joint name="bolt" type="fixed"><parent link="cart"/><child link="nut"/></joint>
</robot>
)";
}

std::string sliderSrdf()
{
  return srdfWith("");
}

std::shared_ptr<const RobotModel> sliderRobot()
{
  return RobotModel::fromXml(sliderUrdf(), sliderSrdf(), {});
}

std::shared_ptr<const RobotModel> sliderRobotOnFloor(const std::string& joint_type)
{
  return RobotModel::fromXml(
      sliderUrdf(),
      srdfWith("<virtual_joint name=\"floor\" type=\"" + joint_type + "\" parent_frame=\"hall\" child_link=\"rail\"/>"),
      {});
}
}  // namespace gpu_planning_scene
