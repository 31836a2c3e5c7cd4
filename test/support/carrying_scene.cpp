#include "support/carrying_scene.h"

namespace gpu_planning_scene::core
{
WorldObject boxInGripper(const RobotModel& robot, const double* state)
{
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  robot.linkPoses(state, poses.data());
  WorldObject box;
  box.id = "held_box";
  // The fingers point along z and close along x. They are 79 mm apart, so each of them penetrates the box by 3 mm.
  box.pose = poses[robot.linkIndex("robotiq_85_base_link")] * Eigen::Translation3d(0.0, 0.0, 0.15);
  box.shapes = {{Box{{0.085, 0.2, 0.06}}}};
  return box;
}

const std::vector<std::string>& gripperLinks()
{
  static const std::vector<std::string> links = {"robotiq_85_base_link",
                                                 "robotiq_85_left_knuckle_link",
                                                 "robotiq_85_right_knuckle_link",
                                                 "robotiq_85_left_finger_link",
                                                 "robotiq_85_right_finger_link",
                                                 "robotiq_85_left_inner_knuckle_link",
                                                 "robotiq_85_right_inner_knuckle_link",
                                                 "robotiq_85_left_finger_tip_link",
                                                 "robotiq_85_right_finger_tip_link"};
  return links;
}

TestScene carryingScene()
{
  TestScene made = testScene("ur5_table_pick");
  made.name = "ur5_table_pick, carrying, padded";
  PlanningScene scene = *made.scene;
  scene.link_padding.assign(scene.robot->links().size(), 0.005);
  for (WorldObject& object : scene.objects)
    object.padding = 0.002;
  const std::vector<double> state = scene.robot->defaultState();
  scene.objects.push_back(boxInGripper(*scene.robot, state.data()));
  scene.attach("held_box", "ee_link", gripperLinks(), state.data());
  WorldObject floor;
  floor.id = "floor";
  floor.shapes = {{HalfSpace{Eigen::Vector3d::UnitZ(), 0.02}}};
  scene.objects.push_back(floor);
  for (const char* link : {"base_link", "shoulder_link"})
    scene.allowed_collisions.setEntry(link, "floor", true);
  made.scene = std::make_shared<const PlanningScene>(std::move(scene));
  return made;
}
}  // namespace gpu_planning_scene::core
