#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
struct Camera
{
  Eigen::Vector3d eye;
  Eigen::Vector3d target;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< of unit length, not along the line of sight
  double field_of_view = 0.7;                     ///< radians, vertical
};

/// The bounding box of the robot in `state`, its attached objects, and the parts of objects near it. In the planning
/// frame.
Eigen::AlignedBox3d nearRobot(const PlanningScene& scene, const double* state);

/// Cameras that show all of nearRobot from eight sides and two heights. The first is at the front and the side.
std::vector<Camera> viewsOf(const PlanningScene& scene, const double* state, const Eigen::Vector3d& up);

/// Pixels in rows from the top, three bytes (red, green, blue) each.
struct Image
{
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Every pair of bodies that collides in `state`, by the exact checker.
std::vector<BodyPair> collidingPairs(const PlanningScene& scene, const double* state);

/// The first of viewsOf, unless another view shows clearly more of the robot, of its colliding parts and of the contact
/// points. Same arguments and errors as render.
Camera clearestView(const PlanningScene& scene, const double* state, const std::vector<BodyPair>& colliding,
                    const std::vector<Eigen::Vector3d>& contact_points, const Eigen::Vector3d& up,
                    const std::string& device);

/// A picture of the scene in the colours of drawingOf, with soft shadows. Hidden contact points are faint. `device`: a
/// selector, as in EglContext. The same scene gives the same picture on the same device. Throws Error if the size, the
/// camera or the device cannot be used.
Image render(const PlanningScene& scene, const double* state, const std::vector<BodyPair>& colliding,
             const std::vector<Eigen::Vector3d>& contact_points, const Camera& camera, int width, int height,
             const std::string& device);

/// Throws Error if the file cannot be written.
void writePng(const Image& image, const std::string& path);
}  // namespace gpu_planning_scene::core
