#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// A robot whose collisions follow from arithmetic (slider.urdf, slider.srdf). The cart, a cube of 0.2 m, slides along
/// x over a rail without shapes (`slide`, metres). The pole, a box of 0.1 x 0.1 x 0.4 m, turns about z (`turn`,
/// radians); its centre is 0.5 m above the cart's centre. The joint `flag` mimics `turn` and the joint `bolt` is fixed;
/// their links have no shapes. The group `drive` moves everything, the group `mast` moves only the pole. The
/// states `left` and `right` have the cart at x = -1 m and 1 m, and the pole turned by 0.8 rad.
std::string sliderUrdf();
std::string sliderSrdf();
std::shared_ptr<const RobotModel> sliderRobot();

/// The same robot on a planar or floating virtual joint `floor` in the frame `hall`.
std::shared_ptr<const RobotModel> sliderRobotOnFloor(const std::string& joint_type);

/// The same robot with meshes in place of its boxes. The cart is a closed cube. The pole lacks the side at x > 0, which
/// is more than a tenth of its area, so it is a surface unless a rule fills it.
std::shared_ptr<const RobotModel> sliderRobotOfMeshes();
std::shared_ptr<const RobotModel> sliderRobotOfMeshes(const std::string& joint_type);  ///< on the joint `floor`

/// The robot and the object "wall" from x = 0.9 to 1.1 m, which the cart can hit.
PlanningScene sliderAndWall(std::uint64_t revision = 0);
}  // namespace gpu_planning_scene::core
