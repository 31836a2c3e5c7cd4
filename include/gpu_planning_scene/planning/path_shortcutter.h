#pragma once

#include <cstddef>

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/RandomNumbers.h>

namespace gpu_planning_scene::core
{
/// Options of PathShortcutter.
struct ShortcutterOptions
{
  std::size_t candidates = 16;  ///< shortcuts that are checked in one call (a round)
  std::size_t max_rounds = 64;  ///< the shortcutter stops after this many rounds
  std::size_t idle_rounds = 2;  ///< it also stops after this many rounds in a row that gain less than least_gain
  double least_gain = 1e-2;     ///< least gain of a round, as a fraction of the path's length
};

/// Shortens paths with a MotionValidator, which checks many motions in little more time than one motion. First,
/// consecutive motions are replaced by one motion if this motion has the same total length. Then each round draws
/// shortcuts between two points of the path, which are vertices or points on edges, and checks them in one call. It
/// takes the valid shortcuts in the order of their gain, largest first, and skips a shortcut that overlaps one already
/// taken. Not thread-safe.
///
/// R. Geraerts, M. H. Overmars: Creating high-quality paths for motion planning. IJRR 26(8), 2007. Their method checks
/// one shortcut at a time.
class PathShortcutter
{
 public:
  /// Throws ompl::Exception if the space information has no gpu_planning_scene::core::MotionValidator.
  explicit PathShortcutter(const ompl::base::SpaceInformationPtr& information, const ShortcutterOptions& options = {});

  /// Returns true if the path became shorter. The first and the last state stay the same. Every new motion of the path
  /// is checked, even if it is part of an old one. `ptc` is tested between batches of states.
  bool shorten(ompl::geometric::PathGeometric& path, const ompl::base::PlannerTerminationCondition& ptc);

 private:
  double shortenOnce(ompl::geometric::PathGeometric& path, bool first,
                     const ompl::base::PlannerTerminationCondition& ptc);

  ompl::base::SpaceInformationPtr information_;
  ShortcutterOptions options_;
  ompl::RNG random_;
};
}  // namespace gpu_planning_scene::core
