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
  Never      ///< a proof shows that they collide in no state within the joint limits
};
const char* nameOf(DisabledReason reason);

/// What proves that a pair never collides. No number of random states proves it: two thin links can meet in so few
/// states that a million random states miss them.
enum class NeverProof
{
  Reach,       ///< the regions that the two links can reach are apart, see Reach
  JointRanges  ///< all joint values between the two links, part by part, see SeparationProver
};

struct DisabledPair
{
  int first;  ///< link indices, ascending
  int second;
  DisabledReason reason;
  NeverProof proof = NeverProof::Reach;  ///< for Never
  double free_share = 0.0;  ///< for Default and Always: the share of the checked random states without a collision
};

/// A pair that stays checked.
struct CheckedLinks
{
  int first;  ///< link indices, ascending
  int second;
  double colliding_share;
  std::size_t states;  ///< random states in which the pair was checked, of which the share is
};

struct GeneratorOptions
{
  std::size_t samples = 10000;  ///< random states
  std::uint64_t seed = 0;
  double always_share = 0.95;  ///< a pair that collides in at least this share of the samples is Always or Default
  std::size_t proof_tests = 100000;  ///< at most so many boxes of joint values are tested for each pair
  /// Whether pairs that the robot's SRDF checks may be disabled, too. It has no effect if the SRDF disables no pair.
  bool drop_checked = false;
};

struct GeneratedMatrix
{
  std::vector<DisabledPair> disabled;  ///< sorted by link indices
  /// Pairs of links that collide in the default state, but in a smaller share of the random states than
  /// GeneratorOptions::always_share. They must be checked; MoveIt's Setup Assistant disables them.
  std::vector<CheckedLinks> colliding_in_default_state;
  /// Pairs that the robot's SRDF checks. They stay checked, although there is a reason to disable them. With
  /// GeneratorOptions::drop_checked, they are in `disabled` as well.
  std::vector<DisabledPair> checked_by_srdf;
  std::vector<CheckedLinks> no_longer_disabled;  ///< the robot's SRDF disables them, without a reason of the user's own
  /// Checked: no random state collides, but nothing proves that no state does. The Setup Assistant disables them.
  std::vector<std::pair<int, int>> unproven;
  std::size_t remaining_pairs = 0;  ///< pairs of links with collision shapes that must be checked
};

/// Decides for each pair of links with collision shapes whether it must be checked. It samples random states and checks
/// all pairs in each, in double precision, on all cores. For pairs that do not collide, it then looks for a proof.
/// Pairs that the robot's SRDF enables, or disables by default or for a reason of the user's own, are left out. Shows a
/// progress bar. The pairs with the reason Never do not depend on the seed.
GeneratedMatrix generateMatrix(std::shared_ptr<const RobotModel> robot, const GeneratorOptions& options);

/// Whether this reason of an SRDF entry is the user's own, that is, none of DisabledReason.
bool isUsersReason(const std::string& reason);
}  // namespace gpu_planning_scene::core
