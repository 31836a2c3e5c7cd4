#pragma once

#include <cstddef>

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/RandomNumbers.h>

namespace gpu_planning_scene::core
{
struct ShortcutterOptions
{
  std::size_t candidates = 16;   ///< shortcuts that are checked at once
  std::size_t most_rounds = 64;  ///< of so many candidates
  std::size_t idle_rounds = 2;   ///< the end, after so many rounds in a row that gain too little
  double least_gain = 1e-2;      ///< of a round, as a part of the path's length
};

/// Shortens paths for a MotionValidator, which checks many motions in little more time than one. At first, one motion
/// takes the place of several that are as long together. Then, in each round, shortcuts between two points of the path
/// are drawn and checked in one call; of the valid ones those are taken, largest gain first, that do not overlap one
/// taken before. Points are vertices as well as points on edges.
///
/// R. Geraerts, M. H. Overmars: Creating high-quality paths for motion planning. IJRR 26(8), 2007, has such shortcuts
/// one at a time.
class PathShortcutter
{
 public:
  /// Throws ompl::Exception if the space information has no gpu_planning_scene::core::MotionValidator.
  explicit PathShortcutter(const ompl::base::SpaceInformationPtr& information, const ShortcutterOptions& options = {});

  /// Whether the path became shorter. Its first and last state stay as they are; each motion that it did not have
  /// before was found valid, also where it is a part of an old one. `ptc` is asked between batches of states.
  bool shorten(ompl::geometric::PathGeometric& path, const ompl::base::PlannerTerminationCondition& ptc);

 private:
  double shortenOnce(ompl::geometric::PathGeometric& path, bool first,
                     const ompl::base::PlannerTerminationCondition& ptc);

  ompl::base::SpaceInformationPtr information_;
  ShortcutterOptions options_;
  ompl::RNG random_;
};
}  // namespace gpu_planning_scene::core
