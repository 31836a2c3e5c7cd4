#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Describes a scene in lines of text: the device, the robot, the sources of its limits, the triangles, the checked
/// pairs, and the omitted pairs with their reasons.
std::vector<std::string> describeScene(const PlanningScene& scene, const SceneReport& report,
                                       const std::string& device);

/// One line for each reason why pairs collide in all samples, with the pairs and the remedy, and one if a body is so
/// far from the origin of the planning frame that answers are not guaranteed to be exact. Usually empty.
std::vector<std::string> warningsOfScene(const PlanningScene& scene, const SceneReport& report);

/// "1 link", "2 links".
std::string counted(std::size_t count, const std::string& noun);

/// Counts for each pair of bodies the states in which it collided.
class PairCounts
{
 public:
  void add(const BatchResult& result);
  /// A heading, and the `limit` most frequent pairs, in descending order, each as "  BODY - BODY: N states". The last
  /// line sums up the other pairs. Nothing if no state collides.
  std::vector<std::string> describe(const PlanningScene& scene, std::size_t limit) const;

 private:
  std::map<std::pair<int, int>, std::size_t> counts_;
};
}  // namespace gpu_planning_scene::core
