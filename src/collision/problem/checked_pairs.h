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
/// A body that moves with the robot: a link, or an object that a link carries.
struct RobotBody
{
  int body;  ///< body index of the planning scene
  int link;  ///< that it moves with
  const std::string* name;
  const std::vector<PlacedShape>* shapes;
  Eigen::Isometry3d pose;          ///< of the shapes' frame in the link's
  double padding;                  ///< metres: its link's, and for what is carried its own on top
  const AttachedObject* attached;  ///< null for a link
};

/// The links, then the attached objects, of those that have shapes. Points into the scene.
std::vector<RobotBody> robotBodies(const PlanningScene& scene);

struct CheckedPair
{
  std::uint32_t body;   ///< index into the robot's bodies
  std::uint32_t other;  ///< self pairs: a later one; world pairs: index of an object
  bool moved;           ///< the group moves at least one of the two
};

/// What is checked of a scene, whatever the group, by pairs of bodies that have shapes.
struct CheckedPairs
{
  std::vector<CheckedPair> self;
  std::vector<CheckedPair> world;
};

/// Moves the pairs of which leaves(pair) is true from one list to the end of another.
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

/// How many of the pairs the group moves.
std::size_t countMoved(const std::vector<CheckedPair>& pairs);

/// `moved`: of each link, whether the group moves it. Counts in `report` what is checked and what is left out.
CheckedPairs findCheckedPairs(const PlanningScene& scene, const std::vector<RobotBody>& bodies,
                              const std::vector<bool>& moved, SceneReport& report);
}  // namespace gpu_planning_scene::core
