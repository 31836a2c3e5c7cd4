#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "collision/batch_size.h"
#include "collision/bounds/reach.h"
#include "gpu_planning_scene/interpolation.h"
#include "gpu_planning_scene/motion_checker.h"

namespace gpu_planning_scene::core
{
/// The motions of one call of MotionChecker::check: first their samples, then, where the rule asks for it, what is
/// between these.
class MotionBatch
{
 public:
  MotionBatch(StateChecker& checker, const RobotModel& robot, const std::string& group,
              const MotionCheckerOptions& options, MotionQuery question, const std::function<bool()>& stop);

  /// Rows of all variables, which must outlive this.
  void add(const double* from, const double* to);

  /// Few samples of each motion first: most motions that collide do so at one of them.
  void checkSamples();
  /// Then, what of the motions that are left is between their samples.
  void prove();
  std::vector<MotionVerdict> verdicts() const;
  std::size_t statesChecked() const { return states_checked_; }

 private:
  /// The part of a motion that a sample stands for: fractions from middle - half to middle + half.
  struct Interval
  {
    std::size_t motion;
    double middle;
    double half;

    double begin() const { return std::max(0.0, middle - half); }
  };

  struct Motion
  {
    const double* from;
    const double* to;
    std::size_t parts;                // its samples are the fractions 0, 1 / parts, ... 1
    std::vector<std::size_t> order;   // of its samples: ends first, then middles of what is between those before
    std::vector<JointTravel> travel;  // Bound: of all of it
    double longest_travel = 0.0;      // of them
    std::size_t samples = 0;          // that were taken
    double limit = 1.0;               // what is beyond this fraction is not wanted any more
    double first_invalid = 1.0;
    bool valid = true;
    BodyPair colliding = kNoPair;

    /// Nothing of it is free, or none of it can be proven.
    void reject()
    {
      valid = false;
      limit = first_invalid = 0.0;
    }
    double fraction(std::size_t sample) const { return static_cast<double>(sample) / static_cast<double>(parts); }
  };

  bool isWanted(const Interval& interval) const
  {
    const Motion& motion = motions_[interval.motion];
    return last_valid_ ? interval.begin() < motion.limit : motion.valid;
  }

  /// The middle of the interval is not free, or the interval is not proven to be.
  void fail(const Interval& interval, const BodyPair& colliding)
  {
    Motion& motion = motions_[interval.motion];
    motion.valid = false;
    if (std::pair(interval.begin(), interval.middle) > std::pair(motion.limit, motion.first_invalid))
      return;
    motion.limit = interval.begin();
    motion.first_invalid = interval.middle;
    motion.colliding = colliding;
  }

  /// Calls visit(interval, free, colliding pair) for what the checker says of the middles, with or without margins; not
  /// free once the call is stopped.
  template <class Visit>
  void ask(const std::vector<Interval>& intervals, bool with_margins, const Visit& visit);
  std::vector<Interval> firstIntervals() const;
  std::vector<Interval> halves(const std::vector<Interval>& intervals);

  StateChecker& checker_;
  const RobotModel& robot_;
  const std::vector<VariableRange> limits_;
  const std::string& group_;
  const MotionCheckerOptions& options_;
  const bool last_valid_;
  const std::function<bool()>& stop_;

  bool stopped_ = false;
  BatchSize batch_size_;
  std::vector<Motion> motions_;
  std::size_t states_checked_ = 0;
};
}  // namespace gpu_planning_scene::core
