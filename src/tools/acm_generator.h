#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The reason why a pair of links need not be checked, as named by MoveIt's Setup Assistant.
enum class DisabledReason
{
  Adjacent,  ///< see RobotModel::adjacentLinks
  Default,   ///< they collide in RobotModel::defaultState(), and in nearly every random state
  Always,    ///< they collide in nearly every random state
  Never      ///< they collide in no random state
};
const char* nameOf(DisabledReason reason);

struct DisabledPair
{
  int first;  ///< link indices, ascending
  int second;
  DisabledReason reason;
};

struct SamplingOptions
{
  std::size_t samples = 10000;
  std::uint64_t seed = 0;
  double always_share = 0.95;  ///< a pair that collides in at least this share of the samples is Always or Default
};

struct GeneratedMatrix
{
  std::vector<DisabledPair> disabled;  ///< sorted by link indices
  /// Pairs of links that collide in the default state, but in a smaller share of the random states than
  /// SamplingOptions::always_share. They must be checked; MoveIt's Setup Assistant disables them.
  std::vector<std::pair<int, int>> colliding_in_default_state;
  std::size_t remaining_pairs = 0;  ///< pairs of links with collision shapes that must be checked
};

/// Decides for each pair of links with collision shapes whether it must be checked. It samples random states and checks
/// all pairs in each, in double precision, on all cores. Pairs that the robot's SRDF enables, or disables for a reason
/// of the user's own, are left out. Shows a progress bar.
GeneratedMatrix generateMatrix(std::shared_ptr<const RobotModel> robot, const SamplingOptions& options);

/// Whether this reason of an SRDF entry is the user's own, that is, none of DisabledReason.
bool isUsersReason(const std::string& reason);
}  // namespace gpu_planning_scene::core
