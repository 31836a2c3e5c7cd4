#include "model/all_joints_robot.h"

#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
std::shared_ptr<const RobotModel> allJointsRobot()
{
  const std::string wide = R"(<limit lower="-2" upper="2" effort="1" velocity="1"/>)";
  std::string urdf;
  for (const char* link : {"root", "a", "b", "c", "middle", "plane", "end"})
    urdf += boxLink(link);
  urdf += jointXml("spin", "continuous", "root", "a",
                   R"(<origin xyz="0.1 0.2 0.3" rpy="0.4 0.5 -0.6"/><axis xyz="0 1 0"/>)");
  urdf +=
      jointXml("bend", "revolute", "a", "b", R"(<origin xyz="0 0.3 0.1" rpy="1 0 0.5"/><axis xyz="1 1 0"/>)" + wide);
  urdf +=
      jointXml("slide", "prismatic", "b", "c", R"(<origin xyz="0.2 0 0.1" rpy="0 0.7 0"/><axis xyz="1 0 2"/>)" + wide);
  urdf += jointXml(
      "follow", "revolute", "c", "middle",
      R"(<origin xyz="0 0.1 0.4"/><axis xyz="0 0 1"/><mimic joint="bend" multiplier="-0.5" offset="0.3"/>)" + wide);
  urdf += jointXml("drive", "planar", "middle", "plane", R"(<origin xyz="0.3 0 0" rpy="0.2 0 0"/><axis xyz="1 0 1"/>)");
  urdf += jointXml("fly", "floating", "plane", "end", R"(<origin xyz="0 0 0.2" rpy="0 0.3 0.1"/>)");
  return robotOf(urdf, R"(<virtual_joint name="base" type="floating" parent_frame="world" child_link="root"/>)"
                       R"(<group name="all"><joint name="base"/><chain base_link="root" tip_link="end"/></group>)");
}
}  // namespace gpu_planning_scene::core
