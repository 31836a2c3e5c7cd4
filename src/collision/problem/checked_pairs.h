#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// A body that moves with the robot: a link or an attached object.
struct RobotBody
{
  int body;  ///< body index of the planning scene
  int link;  ///< link that the body moves with
  const std::string* name;
  const std::vector<PlacedShape>* shapes;
  Eigen::Isometry3d pose;          ///< pose of the shapes' frame in the frame of the link
  double padding;                  ///< metres: the padding of the link; for an attached object, plus its own padding
  const AttachedObject* attached;  ///< null for a link
};

/// The links that have shapes, followed by the attached objects that have shapes. The result points into the scene.
std::vector<RobotBody> robotBodies(const PlanningScene& scene);

struct CheckedPair
{
  std::uint32_t body;   ///< index into the robot's bodies
  std::uint32_t other;  ///< self pairs: index of a later body; world pairs: index of an object
  bool moved;           ///< the group moves at least one of the two
};

/// The checked pairs of a scene for all groups. Both bodies of a pair have shapes.
struct CheckedPairs
{
  std::vector<CheckedPair> self;
  std::vector<CheckedPair> world;
};

/// Moves the pairs for which leaves(pair) is true from one list to the end of another.
template <class Predicate>
void takePairs(std::vector<CheckedPair>& from, std::vector<CheckedPair>& to, const Predicate& leaves)
{
  const auto taken = [&](const CheckedPair& pair)
  {
    const bool is_taken = leaves(pair);
    if (is_taken)
      to.push_back(pair);
    return is_taken;
  };
  from.erase(std::remove_if(from.begin(), from.end(), taken), from.end());
}

/// The number of pairs that the group moves.
std::size_t countMoved(const std::vector<CheckedPair>& pairs);

/// Finds the checked pairs of a scene. `moved` tells for each link whether the group moves it. Counts the checked pairs
/// and the omitted ones in `report`.
CheckedPairs findCheckedPairs(const PlanningScene& scene, const std::vector<RobotBody>& bodies,
                              const std::vector<bool>& moved, SceneReport& report);
}  // namespace gpu_planning_scene::core
