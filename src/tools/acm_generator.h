#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// Why a pair of links need not be checked, in the words of MoveIt's Setup Assistant.
enum class DisabledReason
{
  Adjacent,  ///< a joint joins them
  Default,   ///< they collide in RobotModel::defaultState()
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
  double always_share = 0.95;  ///< of the samples, from which a pair counts as Always
};

struct GeneratedMatrix
{
  std::vector<DisabledPair> disabled;  ///< sorted by link indices
  std::size_t remaining_pairs = 0;     ///< of links with collision shapes: still to be checked
};

/// Decides for all pairs of links with collision shapes from random states, which it checks for every pair, in double
/// precision, on all cores. Pairs that the robot's SRDF disables for a reason of the user's own, or enables are
/// left as they are. Shows a progress bar.
GeneratedMatrix generateMatrix(std::shared_ptr<const RobotModel> robot, const SamplingOptions& options);

/// Whether an SRDF entry with this reason is the user's own, and not one that the generator makes.
bool isUsersReason(const std::string& reason);
}  // namespace gpu_planning_scene::core
