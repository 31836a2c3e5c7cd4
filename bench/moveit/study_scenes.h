#pragma once

#include <string>

#include <moveit/planning_scene/planning_scene.h>

namespace gpu_planning_scene
{
/// A robot of MoveIt's tests (panda, pr2), or one of ../shared/robots (ur5_robotiq). Throws std::runtime_error if there
/// is none.
moveit::core::RobotModelPtr loadStudyRobot(const std::string& name);

/// The planning scene of a robot with MoveIt's FCL detector, or with the detector of this package. Pairs of links that
/// collide in the default state are allowed.
planning_scene::PlanningScenePtr makeStudyScene(const moveit::core::RobotModelPtr& robot, bool ours);

/// Adds `count` boxes, spheres, cylinders, cones and meshes at random places around the robot. If `as_meshes`, the
/// curved shapes and boxes are added as meshes.
void addStudyObjects(planning_scene::PlanningScene& scene, int count, unsigned seed, bool as_meshes = false);

/// Adds an octomap with `cells` random occupied cells of 5 cm.
void addStudyOctomap(planning_scene::PlanningScene& scene, int cells, unsigned seed);

/// Attaches a box and a mesh to the last link of a chain of the robot.
void attachStudyTool(moveit::core::RobotState& state);

/// A state with random values of all joints. Joints that follow others have the values that these give them.
void randomizeState(moveit::core::RobotState& state, random_numbers::RandomNumberGenerator& random);
}  // namespace gpu_planning_scene
