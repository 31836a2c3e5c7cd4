#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "collision/proofs/stopped.h"
#include "collision/trees/cpu_tree.h"

namespace gpu_planning_scene::core
{
/// A joint between two bodies, in the frame of the first body's tree, for the joints' middle values.
struct JointAxis
{
  bool prismatic;
  Eigen::Vector3d point;      ///< on the axis of rotation
  Eigen::Vector3d direction;  ///< unit length
  double travel;              ///< largest distance from the middle value: radians or metres, at least 0
};

/// Upper bound of the displacement of points of the second body relative to the first. `axes`: the joints between the
/// bodies, in the order from the first body to the second. The points are in a ball around `center` for the middle
/// values. A joint displaces a point by at most its travel times the point's distance from the axis (Schwarzer, Saha
/// and Latombe, "Exact collision checking of robot paths", 2002). Schwarzer et al. use the distance of the whole body
/// from the axis; this bound uses the distance of the points.
double displacementBound(const std::vector<JointAxis>& axes, const Eigen::Vector3d& center, double radius);

/// Whether the surfaces of two bodies are proven apart for all joint values within the travel: each part of the second
/// body is farther from the first body than the part can move. `b_in_a`: pose of b in the frame of a for the middle
/// values. `required`: metres by which the surfaces must be apart. Gives up, with false, after 20,000 node pairs. Adds
/// the number of visited node pairs to `steps`. Throws ProofsStopped.
bool surfacesApartWhileMoving(const CpuTree& a, const CpuTree& b, const Eigen::Isometry3d& b_in_a,
                              const std::vector<JointAxis>& axes, double required, std::uint64_t& steps,
                              const Stopped& stopped);
}  // namespace gpu_planning_scene::core
