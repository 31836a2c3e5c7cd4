#include "collision/motion/motion_batch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "gpu_planning_scene/error.h"

// Samples are checked in bisection order, so that collisions are found early. Under the rule Bound, a sample proves a
// segment free, and so also the other samples in it, if the distance of each pair exceeds its required distance by more
// than its joint displacement bound. Other segments are halved (adaptive bisection of Schwarzer, Saha, Latombe 2002 and
// 2005).
namespace gpu_planning_scene::core
{
namespace
{
// So many states are in memory at once.
constexpr std::size_t kStatesInMemory = 65'536;
// With margins, a state may need as many numbers as the robot has pairs of links.
constexpr std::size_t kStatesWithMarginsInMemory = 8192;

// The first round checks the ends and the middle of a motion, but only the end of an extension: most extensions in a
// narrow place collide there. Each later round multiplies the number of checked samples by kGrowth.
constexpr std::size_t kFirstSamples = 3;
constexpr std::size_t kFirstSamplesOfExtensions = 1;
constexpr std::size_t kGrowth = 4;

// The smallest neighbourhood of a sample. If even this neighbourhood is not proven free, the motion is rejected at the
// sample.
constexpr double kLeastTravel = 1e-7;  // radians and metres

// Under the rule Bound, one of kBeforeProof samples is checked before the segments are proven free. Most motions are
// free, and a proof includes the samples in its segment.
constexpr std::size_t kBeforeProof = 8;

/// An upper bound, in radians, of the rounding of a joint's angle in a state between the two states.
double angleRounding(const RobotModel& robot, const double* from, const double* to)
{
  double largest = 0.0;
  for (const Joint& joint : robot.joints())
  {
    const bool is_planar = joint.type == JointType::Planar;
    if (!is_planar && joint.type != JointType::Revolute && joint.type != JointType::Continuous)
      continue;
    const int angle = joint.first_variable + (is_planar ? 2 : 0);
    for (const double* state : {from, to})
      largest = std::max(largest, std::abs(joint.multiplier * state[angle] + joint.offset));
  }
  return 4.0 * std::numeric_limits<double>::epsilon() * largest;
}

/// The samples of n segments in the order of their checks: n, then 0 (left out if the start is known to be free), then
/// the middles of the segments in between, level by level.
std::vector<std::size_t> bisectionOrder(std::size_t n, bool is_start_free)
{
  std::vector<std::size_t> order;
  order.reserve(n + 1);
  order.push_back(n);
  if (!is_start_free)
    order.push_back(0);
  std::vector<std::pair<std::size_t, std::size_t>> segments;
  segments.reserve(2 * n);
  segments.emplace_back(0, n);
  for (std::size_t i = 0; i < segments.size(); ++i)
  {
    const auto [begin, end] = segments[i];
    if (end - begin < 2)
      continue;
    const std::size_t middle = begin + (end - begin) / 2;
    order.push_back(middle);
    segments.emplace_back(begin, middle);
    segments.emplace_back(middle, end);
  }
  return order;
}
}  // namespace

MotionBatch::MotionBatch(StateChecker& checker, const RobotModel& robot, const std::string& group,
                         const MotionCheckerOptions& options, MotionQuery query, const std::function<bool()>& stop)
  : checker_(checker),
    robot_(robot),
    limits_(options.rule == MotionRule::Bound ? provenRanges(robot) : std::vector<VariableRange>()),
    group_(group),
    options_(options),
    last_valid_(query == MotionQuery::LastValid),
    are_extensions_(query == MotionQuery::Extension),
    stop_(stop)
{
}

void MotionBatch::add(const double* from, const double* to)
{
  const double segments = segmentCount(robot_, from, to, options_.steps);
  const bool is_too_long = segments >= static_cast<double>(options_.max_samples);
  const std::size_t number = is_too_long ? 1 : static_cast<std::size_t>(segments);
  std::vector<std::size_t>& order = orders_[number];
  if (order.empty())
    order = bisectionOrder(number, are_extensions_);
  Motion motion{from, to, number, &order, {}};
  if (is_too_long)
    motion.reject();
  if (options_.rule == MotionRule::Bound)
  {
    motion.travel = jointTravel(robot_, from, to);
    motion.angle_rounding = angleRounding(robot_, from, to);
  }
  for (const JointTravel& joint : motion.travel)
    motion.longest_travel = std::max({motion.longest_travel, joint.length, joint.angle});
  // Outside the joints' limits, and at very large angles, there are no displacement bounds.
  if (options_.rule == MotionRule::Bound && !(withinRanges(limits_, from) && withinRanges(limits_, to)))
    motion.reject();
  motions_.push_back(std::move(motion));
}

BatchResult MotionBatch::checkStates(const std::vector<double>& states, std::size_t count,
                                     const JointNeighbourhood* around)
{
  StateBatch batch{states.data(), count, group_, around};
  if (stop_)
    batch.go_on = [this](std::size_t /*answered*/) { return !stop_(); };
  try
  {
    return checker_.checkBatch(batch);
  }
  catch (const Cancelled&)
  {
    stopped_ = true;
    return {};
  }
}

/// Adds the row that the intervals of a group share. It depends only on the motion and on the group, so the answers do
/// not depend on how batches are cut.
void MotionBatch::addRow(const Interval& interval, JointNeighbourhood& around) const
{
  const Motion& motion = motions_[interval.motion];
  for (const JointTravel& joint : motion.travel)
    around.travel.push_back(
        {joint.length * interval.half, joint.angle == 0.0 ? 0.0 : joint.angle * interval.half + motion.angle_rounding});
  const double middle = static_cast<double>(2 * interval.group() + 1) * Interval::kGroup * interval.half;
  const std::size_t width = robot_.variables().size();
  around.centers.resize(around.centers.size() + width);
  interpolate(robot_, motion.from, motion.to, std::min(1.0, middle), &around.centers[around.centers.size() - width]);
}

template <class Visit>
void MotionBatch::giveUp(const std::vector<Interval>& intervals, std::size_t begin, const Visit& visit)
{
  for (std::size_t i = begin; i < intervals.size(); ++i)
  {
    if (!isWanted(intervals[i]))
      continue;
    motions_[intervals[i].motion].given_up = !stopped_;
    visit(intervals[i], false, kNoPair);
  }
}

template <class Visit>
void MotionBatch::checkMiddles(const std::vector<Interval>& intervals, bool with_margins, const Visit& visit)
{
  const std::size_t width = robot_.variables().size();
  const std::size_t most = with_margins ? kStatesWithMarginsInMemory : kStatesInMemory;
  std::vector<double> states;
  std::size_t count = 0;
  for (std::size_t begin = 0; begin < intervals.size(); begin += count)
  {
    stopped_ = stopped_ || (stop_ && stop_());
    count = stopped_ ? 0 : std::min({intervals.size() - begin, most, options_.max_checks - states_checked_});
    if (count == 0)
      return giveUp(intervals, begin, visit);
    states.resize(count * width);
    JointNeighbourhood around;
    around.spread = Interval::kGroup;
    std::size_t last_motion = motions_.size();
    std::size_t last_group = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
      const Interval& interval = intervals[begin + i];
      Motion& motion = motions_[interval.motion];
      interpolate(robot_, motion.from, motion.to, interval.middle, states.data() + i * width);
      if (!with_margins)
        continue;
      ++motion.segments_examined;
      // All intervals of a motion are equally wide, so the motion and the group name the row.
      if (interval.motion != last_motion || interval.group() != last_group)
        addRow(interval, around);
      last_motion = interval.motion;
      last_group = interval.group();
      around.rows.push_back(static_cast<std::uint32_t>(around.travel.size() / motion.travel.size() - 1));
    }
    const BatchResult result = checkStates(states, count, with_margins ? &around : nullptr);
    if (stopped_)
      return giveUp(intervals, begin, visit);
    states_checked_ += count;
    for (std::size_t i = 0; i < count; ++i)
      visit(intervals[begin + i], result.valid[i] != 0, result.colliding[i]);
  }
}

void MotionBatch::checkSamples()
{
  const bool all = options_.rule == MotionRule::Samples || last_valid_;
  std::size_t largest = 0;
  for (const Motion& motion : motions_)
    largest = std::max(largest, motion.order->size());
  const std::size_t few = are_extensions_ ? kFirstSamplesOfExtensions : kFirstSamples;
  std::size_t end = last_valid_ ? largest : few;
  for (std::size_t begin = 0; begin < largest; begin = end, end *= kGrowth)
  {
    std::vector<Interval> intervals;
    for (std::size_t i = 0; i < motions_.size(); ++i)
    {
      const Motion& motion = motions_[i];
      const std::vector<std::size_t>& order = *motion.order;
      const std::size_t last = all ? order.size() : kFirstSamples + order.size() / kBeforeProof;
      for (std::size_t k = begin; motion.valid && k < std::min({end, last, order.size()}); ++k)
        intervals.push_back({i, motion.fraction(order[k]), 1.0 / static_cast<double>(motion.segments)});
    }
    checkMiddles(intervals, false,
                 [this](const Interval& interval, bool free, const BodyPair& colliding)
                 {
                   if (!free)
                     fail(interval, colliding);
                 });
  }
}

/// The intervals around every second sample. They are twice as wide as the steps, because most of them can be proven to
/// be free.
std::vector<MotionBatch::Interval> MotionBatch::firstIntervals() const
{
  std::vector<Interval> intervals;
  for (std::size_t i = 0; i < motions_.size(); ++i)
  {
    const Motion& motion = motions_[i];
    for (std::size_t k = 1; k <= motion.segments; k += 2)
    {
      const Interval interval{i, motion.fraction(k), 1.0 / static_cast<double>(motion.segments)};
      if (isWanted(interval))
        intervals.push_back(interval);
    }
  }
  return intervals;
}

/// Halves the intervals that are still wanted. Rejects a motion if its interval is too small or if too many of its
/// segments have been examined.
std::vector<MotionBatch::Interval> MotionBatch::halves(const std::vector<Interval>& intervals)
{
  for (const Interval& interval : intervals)
    if (const Motion& motion = motions_[interval.motion];
        motion.segments_examined >= options_.max_samples || motion.longest_travel * interval.half < kLeastTravel)
      fail(interval, kNoPair);
  std::vector<Interval> result;
  for (const Interval& interval : intervals)
    if (isWanted(interval))
      for (const double side : {-0.5, 0.5})
      {
        const Interval half{interval.motion, interval.middle + side * interval.half, 0.5 * interval.half};
        // The last interval of a motion can lie half outside the motion.
        if (half.middle > 0.0 && half.middle < 1.0)
          result.push_back(half);
      }
  return result;
}

void MotionBatch::prove()
{
  std::vector<Interval> open = firstIntervals();
  // For the query LastValid, the middles of the first intervals have been checked as samples.
  for (bool are_free = last_valid_; !open.empty(); are_free = false)
  {
    std::vector<Interval> near;
    checkMiddles(open, true,
                 [&near](const Interval& interval, bool free, const BodyPair&)
                 {
                   if (!free)
                     near.push_back(interval);
                 });
    if (!are_free)
      checkMiddles(near, false,
                   [this](const Interval& interval, bool free, const BodyPair& colliding)
                   {
                     if (!free)
                       fail(interval, colliding);
                   });
    open = halves(near);
  }
}

std::vector<MotionVerdict> MotionBatch::verdicts() const
{
  std::vector<MotionVerdict> verdicts;
  verdicts.reserve(motions_.size());
  for (const Motion& motion : motions_)
    if (motion.valid)
      verdicts.push_back({true, 1.0, 1.0, kNoPair, false});
    else
      verdicts.push_back(
          {false, last_valid_ ? motion.limit : 0.0, motion.first_invalid, motion.colliding, motion.given_up});
  return verdicts;
}
}  // namespace gpu_planning_scene::core
