#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core::literature
{
/// A pose of a hard case. Its family names the difficulty. `level`: its degree, with the meaning that families.csv
/// gives to the family; for contacts, the clearance (above 0) or penetration (below 0), divided by the size of the
/// meshes.
struct HardPose
{
  std::string family;
  double level;
  Eigen::Isometry3d b_in_a;
};

/// Two meshes and hard poses of b in the frame of a.
struct HardPair
{
  std::shared_ptr<const Mesh> a;
  std::shared_ptr<const Mesh> b;
  bool convex = false;     ///< both are convex
  bool open = false;       ///< one of them does not enclose a volume
  bool contained = false;  ///< one is inside the other
  bool remote = false;     ///< vertices are farther than a kilometre from the origin
  std::vector<HardPose> poses;
};

/// Pairs of all families. `count`: number of contacts of a family, each at all of its levels. The same seed gives the
/// same pairs.
std::vector<HardPair> hardPairs(std::size_t count, std::uint64_t seed);
}  // namespace gpu_planning_scene::core::literature
