#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "gpu_planning_scene/interpolation.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// The rule by which a straight motion between two states is valid.
enum class MotionRule
{
  /// All samples are free, as in MoveIt and OMPL. A thin obstacle between two samples is missed.
  Samples,
  /// The motion is proven free, its samples included. Around every second sample lies a segment that ends at the
  /// neighbouring samples. The proof: the clearance of the sample exceeds the displacement of every point of the robot
  /// within this segment.
  Bound
};

/// Reads "samples" or "bound". Throws Error for any other name.
MotionRule motionRuleFromName(const std::string& name);

struct MotionCheckerOptions
{
  MotionRule rule = MotionRule::Bound;
  MotionSteps steps{0.02, 0.02};  ///< largest steps between samples, before any subdivision
  /// Largest number of samples of a motion. Under MotionRule::Bound, a motion is also rejected if this number of
  /// segments has been examined and a segment must still be halved.
  std::size_t max_samples = 20000;
  /// Limit for each call of MotionChecker::check: the number of state checks for all its motions. Motions that are not
  /// decided by then are reported as invalid, with MotionVerdict::given_up.
  std::size_t max_checks = std::numeric_limits<std::size_t>::max();
};

/// A motion is invalid as a whole if it has more than MotionCheckerOptions::max_samples samples at the given steps, or,
/// under MotionRule::Bound, if a joint of its start or end is beyond its limits, or turns by more than 1e6 radians from
/// 0. Both fractions are then 0.
struct MotionVerdict
{
  bool valid = false;
  /// Fraction of the motion, 0 to 1. Under MotionRule::Samples: the last free sample before the first collision. Under
  /// MotionRule::Bound: the motion is proven free up to this fraction. It is at most the fraction under
  /// MotionRule::Samples. 1 if the motion is valid. Only MotionQuery::LastValid computes this fraction: with the other
  /// queries, it is 0 for every invalid motion.
  double last_valid = 0.0;
  /// The fraction of the first sample that collides or around which the motion is not proven free. Unless the query is
  /// MotionQuery::LastValid: the first such sample that the check found, which need not be the first of the motion. 1
  /// if the motion is valid.
  double first_invalid = 0.0;
  /// The colliding pair at `first_invalid`. kNoPair if the check found no sample that collides: the motion is valid, it
  /// is not proven free, it is invalid as a whole, or its check ended early.
  BodyPair colliding = kNoPair;
  /// True: MotionCheckerOptions::max_checks ended the checks of this motion too early. The motion is not valid, but its
  /// free part may be longer than `last_valid`.
  bool given_up = false;
};

enum class MotionQuery
{
  Valid,      ///< is the motion valid? The check ends at the first collision found
  LastValid,  ///< up to which fraction is the motion valid?
  Samples,    ///< as Valid, but checks the samples only, whatever the rule is
  Extension   ///< as Samples, for a start that is known to be free: it is not checked, and the end is checked first
};

/// Checks straight motions in bulk. The samples of all motions are checked batch by batch: first the ends and middles
/// (of extensions the ends alone), then the remaining samples of the motions that are still valid; under
/// MotionRule::Bound only some of them, except for MotionQuery::LastValid. MotionRule::Bound then checks every second
/// sample with margins. It subdivides a motion where a sample does not have its margin. Thread-safe.
///
/// F. Schwarzer, M. Saha, J.-C. Latombe: Exact collision checking of robot paths (2002). Here, each level of
/// subdivision is one batch.
class MotionChecker
{
 public:
  /// `robot`: that of the checker's scene. `group`: as for StateChecker::check, which reports an unknown group. Throws
  /// Error if a step is not a finite number above 0.
  MotionChecker(std::shared_ptr<StateChecker> checker, std::shared_ptr<const RobotModel> robot, std::string group,
                const MotionCheckerOptions& options = {});

  /// `starts`, `ends`: row-major, `count` rows with one value per variable. `stop` is called before each batch of
  /// states; a batch takes about 0.05 s. After `stop` has returned true, motions without a verdict are reported as
  /// invalid. Throws Error as StateChecker::check does, and for a motion that moves variables outside the group,
  /// because collisions of links that only these variables move are not checked.
  std::vector<MotionVerdict> check(const double* starts, const double* ends, std::size_t count,
                                   MotionQuery query = MotionQuery::Valid,
                                   const std::function<bool()>& stop = {}) const;

  MotionRule rule() const { return options_.rule; }
  bool checksSideBySide() const { return checker_->checksSideBySide(); }  ///< see StateChecker

  /// Number of states checked so far, with and without margins.
  std::uint64_t statesChecked() const { return states_checked_; }

 private:
  std::shared_ptr<StateChecker> checker_;
  std::shared_ptr<const RobotModel> robot_;
  std::string group_;
  MotionCheckerOptions options_;
  mutable std::atomic<std::uint64_t> states_checked_{0};
};
}  // namespace gpu_planning_scene::core
