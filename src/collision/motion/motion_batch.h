#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "collision/bounds/reach.h"
#include "gpu_planning_scene/interpolation.h"
#include "gpu_planning_scene/motion_checker.h"

namespace gpu_planning_scene::core
{
/// The motions of one call of MotionChecker::check. Their samples are checked first. If the rule is Bound, only some
/// are checked (all for the query LastValid), and the segments between the samples are then proven to be free.
class MotionBatch
{
 public:
  /// `options.rule` must be Samples for the queries Samples and Extension.
  MotionBatch(StateChecker& checker, const RobotModel& robot, const std::string& group,
              const MotionCheckerOptions& options, MotionQuery query, const std::function<bool()>& stop);

  /// Adds a motion. `from` and `to` are rows of all variables; they must outlive this object.
  void add(const double* from, const double* to);

  /// Checks the samples. It begins with one or a few samples of each motion, because most colliding motions collide at
  /// one of them.
  void checkSamples();
  /// Proves that the motions that are still valid are free, at the samples that checkSamples() left out too.
  void prove();
  std::vector<MotionVerdict> verdicts() const;
  std::size_t statesChecked() const { return states_checked_; }

 private:
  /// The segment of a motion that a sample represents: the fractions from middle - half to middle + half. The segment
  /// with the number i has middle = (2 i + 1) half.
  struct Interval
  {
    std::size_t motion;
    double middle;
    double half;

    double begin() const { return std::max(0.0, middle - half); }

    /// Neighbouring intervals of one width share displacement bounds. Larger groups have wider bounds, smaller ones
    /// take more time.
    static constexpr int kGroup = 8;
    std::size_t group() const { return static_cast<std::size_t>(0.5 * middle / half) / kGroup; }
  };

  struct Motion
  {
    const double* from;
    const double* to;
    std::size_t segments;                   // the samples are the fractions 0, 1 / segments, ... 1; see MotionQuery
    const std::vector<std::size_t>* order;  // order of the samples, one of orders_
    std::vector<JointTravel> travel;        // travel of each joint over the whole motion (rule Bound)
    double longest_travel = 0.0;            // largest length or angle in `travel`
    double angle_rounding = 0.0;            // radians: largest rounding of an interpolated angle
    std::size_t segments_examined = 0;
    double limit = 1.0;  // the motion is no longer checked beyond this fraction
    double first_invalid = 1.0;
    bool valid = true;
    bool given_up = false;  // the call had no checks left for it
    BodyPair colliding = kNoPair;

    /// Rejects the whole motion, because it needs too many samples or is outside the joints' limits.
    void reject()
    {
      valid = false;
      limit = first_invalid = 0.0;
    }
    double fraction(std::size_t sample) const { return static_cast<double>(sample) / static_cast<double>(segments); }
  };

  bool isWanted(const Interval& interval) const
  {
    const Motion& motion = motions_[interval.motion];
    // Begins and limits are multiples of `half`, up to rounding.
    return last_valid_ ? interval.begin() < motion.limit - 0.25 * interval.half : motion.valid;
  }

  /// Rejects the motion from this interval on: its middle collides, or the interval cannot be proven to be free.
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

  /// Checks the middles of the intervals, with or without margins, and calls visit(interval, free, colliding pair) for
  /// each. After the call has been stopped, or when it has no checks left, `free` is false.
  template <class Visit>
  void checkMiddles(const std::vector<Interval>& intervals, bool with_margins, const Visit& visit);
  void addRow(const Interval& interval, JointNeighbourhood& around) const;
  /// Visits the intervals from `begin` on as not free, because the call is stopped or has no checks left.
  template <class Visit>
  void giveUp(const std::vector<Interval>& intervals, std::size_t begin, const Visit& visit);
  /// After the call, stopped_ may be set; the result is then empty.
  BatchResult checkStates(const std::vector<double>& states, std::size_t count, const JointNeighbourhood* around);
  std::vector<Interval> firstIntervals() const;
  std::vector<Interval> halves(const std::vector<Interval>& intervals);

  StateChecker& checker_;
  const RobotModel& robot_;
  const std::vector<VariableRange> limits_;  // empty unless the rule is Bound
  const std::string& group_;
  const MotionCheckerOptions& options_;
  const bool last_valid_;
  const bool are_extensions_;
  const std::function<bool()>& stop_;

  bool stopped_ = false;
  std::unordered_map<std::size_t, std::vector<std::size_t>> orders_;  // see bisectionOrder; by the number of segments
  std::vector<Motion> motions_;
  std::size_t states_checked_ = 0;
};
}  // namespace gpu_planning_scene::core
