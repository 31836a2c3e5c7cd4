#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Lines for a person: the device, the robot, the triangles, the checked pairs, and what is left out and why.
std::vector<std::string> describeScene(const PlanningScene& scene, const SceneReport& report,
                                       const std::string& device);

/// "1 link", "2 links".
std::string counted(std::size_t count, const std::string& noun);

/// Which pairs of bodies collided in how many states.
class PairCounts
{
 public:
  void add(const BatchResult& result);
  /// The commonest `limit` pairs, "BODY - BODY: N states", most first.
  std::vector<std::string> commonest(const PlanningScene& scene, std::size_t limit) const;

 private:
  std::map<std::pair<int, int>, std::size_t> counts_;
};
}  // namespace gpu_planning_scene::core
