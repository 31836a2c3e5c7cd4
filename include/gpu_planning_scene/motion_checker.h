#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gpu_planning_scene/interpolation.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// When a straight motion between two states is accepted.
enum class MotionRule
{
  Samples,  ///< its samples are free: as in MoveIt and OMPL, a thin obstacle between two samples is jumped
  Bound     ///< and each is free by more than any point of the robot can move up to half way to the next sample
};

/// "samples" or "bound"; throws Error otherwise.
MotionRule motionRuleFromName(const std::string& name);

struct MotionCheckerOptions
{
  MotionRule rule = MotionRule::Bound;
  MotionSteps steps{0.02, 0.02};  ///< between samples, before any subdivision
  /// Of a motion: one that the steps cut into more is not accepted; Bound: nor what is not proven when so many checks
  /// of states were made for it, those of its samples included.
  std::size_t most_samples = 20000;
};

struct MotionVerdict
{
  bool valid = false;
  /// Fraction (0 to 1) of the last free sample before the first collision; with MotionRule::Bound, up to which the
  /// motion is proven, at most that. 0 where the start collides; 1 where the motion is valid.
  double last_valid = 0.0;
  /// Fraction of the sample where `last_valid` ends: it collides, or the motion is not proven free around it. 1 where
  /// the motion is valid.
  double first_invalid = 0.0;
  /// The pair that collides there; no pair where the motion is merely not proven free.
  BodyPair colliding = kNoPair;
};

enum class MotionQuery
{
  Valid,      ///< is it valid? A motion is given up at any of its collisions, and its verdict's last_valid is 0
  LastValid,  ///< up to where?
  Samples     ///< is it under MotionRule::Samples, whatever the rule is? What is not, is not under any rule
};

/// Checks straight motions in bulk. The samples of all motions are checked batch by batch: ends and middles, the other
/// samples of what is left, then, for MotionRule::Bound, all again with margins, with twice the samples where that does
/// not do (Schwarzer, Saha, Latombe 2002, "Exact collision checking of robot paths", with a batch for each level).
/// Thread-safe.
class MotionChecker
{
 public:
  /// `group`: as for StateChecker::check. Throws Error for a step that is not a positive number.
  MotionChecker(std::shared_ptr<StateChecker> checker, std::shared_ptr<const RobotModel> robot, std::string group,
                const MotionCheckerOptions& options = {});

  /// `starts`, `ends`: `count` rows of all variables. `stop` is asked before each batch of states, which takes some
  /// 0.05 s; where it says so, motions that are not decided yet are not valid. Throws Error as the checker does.
  std::vector<MotionVerdict> check(const double* starts, const double* ends, std::size_t count,
                                   MotionQuery question = MotionQuery::Valid,
                                   const std::function<bool()>& stop = {}) const;

  MotionRule rule() const { return options_.rule; }

  /// States that were checked so far, with and without margins.
  std::uint64_t statesChecked() const { return states_checked_; }

 private:
  std::shared_ptr<StateChecker> checker_;
  std::shared_ptr<const RobotModel> robot_;
  std::string group_;
  MotionCheckerOptions options_;
  mutable std::atomic<std::uint64_t> states_checked_{0};
};
}  // namespace gpu_planning_scene::core
