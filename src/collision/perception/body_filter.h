#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "collision/bounds/problem_maker.h"
#include "collision/exact/forest_cache.h"
#include "collision/perception/voxel_grid.h"

namespace gpu_planning_scene::core
{
// Flags of the bodies near a voxel.
constexpr std::uint8_t kNearRobot = 1;   ///< a link, or an attached object that is not named
constexpr std::uint8_t kNearObject = 2;  ///< a named object

/// Removes the elements that have one of the flags of `mask`.
template <class Element>
void removeFlagged(std::vector<Element>& elements, const std::vector<std::uint8_t>& flags,
                   std::uint8_t mask = kNearRobot | kNearObject)
{
  std::size_t kept = 0;
  for (std::size_t i = 0; i < elements.size(); ++i)
    if ((flags[i] & mask) == 0)
      elements[kept++] = elements[i];
  elements.resize(kept);
}

/// Finds the voxels that belong to the robot or to named objects. The exact checker decides this; the paddings of the
/// scene do not count. Not thread-safe: the robot's trees are kept from call to call.
class BodyFilter
{
 public:
  /// The flags kNearRobot and kNearObject of each cube of `grid`. A cube is near a body if their distance is at most
  /// `padding` (metres). `state`: one value per variable. `objects`: ids of objects of the world and of attached
  /// objects; ids that the scene does not have are ignored. Throws Error if a named object has a half-space.
  std::vector<std::uint8_t> near(const VoxelGrid& grid, const std::vector<Eigen::Vector3d>& centres,
                                 const PlanningScene& scene, const double* state, double padding,
                                 const std::set<std::string>& objects);

 private:
  ProblemMaker maker_{optionsWithAllPairs()};
  ForestCache trees_;
};
}  // namespace gpu_planning_scene::core
