#include "gpu_planning_scene/motion_checker.h"

#include <algorithm>
#include <utility>

#include "collision/reach.h"
#include "collision/state_rows.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene
{
namespace
{
// States that are asked about at once: more gain nothing on any device, and take memory.
constexpr std::size_t kMostStates = 65536;

// The first samples of a motion that are asked about: its ends and its middle; each time later so many times as many.
constexpr std::size_t kFirstSamples = 3;
constexpr std::size_t kGrowth = 4;

// A sample that cannot be proven to be free for less than this around it is as good as a collision.
constexpr double kLeastWay = 1e-7;  // radians and metres

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
  std::size_t parts;               // its samples are the fractions 0, 1 / parts, ... 1
  std::vector<std::size_t> order;  // of its samples: ends first, then middles of what is between those before
  std::vector<JointWay> ways;      // Bound: of all of it
  double longest_way = 0.0;        // of them
  std::size_t samples = 0;         // that were taken
  double limit = 1.0;              // what is beyond this fraction is not wanted any more
  bool valid = true;
  std::array<std::int32_t, 2> colliding{{-1, -1}};

  double fraction(std::size_t sample) const { return static_cast<double>(sample) / static_cast<double>(parts); }
};

/// 0 and n, then the middles of what is between two of those before, all parts of a level before the next.
std::vector<std::size_t> bisectionOrder(std::size_t n)
{
  std::vector<std::size_t> order = {n, 0};
  std::vector<std::pair<std::size_t, std::size_t>> parts = {{0, n}};
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    const auto [begin, end] = parts[i];
    if (end - begin < 2)
      continue;
    const std::size_t middle = begin + (end - begin) / 2;
    order.push_back(middle);
    parts.emplace_back(begin, middle);
    parts.emplace_back(middle, end);
  }
  return order;
}

/// The motions of one call.
class Check
{
 public:
  Check(StateChecker& checker, const RobotModel& robot, const std::string& group, const MotionCheckerOptions& options,
        bool last_valid)
    : checker_(checker),
      robot_(robot),
      limits_(limitRanges(robot)),
      group_(group),
      options_(options),
      last_valid_(last_valid)
  {
  }

  void add(const double* from, const double* to)
  {
    const double parts = partsOfWay(robot_, from, to, options_.steps);
    const bool is_too_long = parts >= static_cast<double>(options_.most_samples);
    Motion motion{from, to, is_too_long ? 1 : static_cast<std::size_t>(parts), {}, {}};
    if (is_too_long)
    {
      motion.valid = false;
      motion.limit = 0.0;
    }
    motion.order = bisectionOrder(motion.parts);
    if (options_.rule == MotionRule::Bound)
      motion.ways = jointWays(robot_, from, to);
    for (const JointWay& way : motion.ways)
      motion.longest_way = std::max({motion.longest_way, way.length, way.angle});
    // Beyond the limits displacements have no bounds.
    if (options_.rule == MotionRule::Bound && !(withinRanges(limits_, from) && withinRanges(limits_, to)))
    {
      motion.valid = false;
      motion.limit = 0.0;
    }
    motions_.push_back(std::move(motion));
  }

  void checkSamples();
  void prove();
  std::vector<MotionVerdict> verdicts() const;
  std::size_t statesChecked() const { return states_checked_; }

 private:
  bool isWanted(const Interval& interval) const
  {
    const Motion& motion = motions_[interval.motion];
    return last_valid_ ? interval.begin() < motion.limit : motion.valid;
  }

  /// The motion is not free, or not proven so, from a fraction on.
  void fail(std::size_t number, double last_valid, const std::array<std::int32_t, 2>& colliding)
  {
    Motion& motion = motions_[number];
    motion.valid = false;
    if (last_valid <= motion.limit)
    {
      motion.limit = last_valid;
      motion.colliding = colliding;
    }
  }

  /// Calls visit(interval, free, colliding pair) for what the checker says of the middles, with or without margins.
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
  std::vector<Motion> motions_;
  std::size_t states_checked_ = 0;
};

template <class Visit>
void Check::ask(const std::vector<Interval>& intervals, bool with_margins, const Visit& visit)
{
  const std::size_t width = robot_.variables().size();
  std::vector<double> states;
  for (std::size_t begin = 0; begin < intervals.size(); begin += kMostStates)
  {
    const std::size_t count = std::min(kMostStates, intervals.size() - begin);
    states.resize(count * width);
    Surroundings around;
    std::size_t last_motion = motions_.size();
    for (std::size_t i = 0; i < count; ++i)
    {
      const Interval& interval = intervals[begin + i];
      Motion& motion = motions_[interval.motion];
      interpolate(robot_, motion.from, motion.to, interval.middle, states.data() + i * width);
      ++motion.samples;
      if (!with_margins)
        continue;
      if (interval.motion != last_motion)  // the intervals of a motion follow one another and are equally wide
        for (const JointWay& way : motion.ways)
          around.ways.push_back({way.length * interval.half, way.angle * interval.half});
      last_motion = interval.motion;
      around.rows.push_back(static_cast<std::uint32_t>(around.ways.size() / motion.ways.size() - 1));
    }
    states_checked_ += count;
    const BatchResult result = checker_.check(states.data(), count, group_, with_margins ? &around : nullptr);
    for (std::size_t i = 0; i < count; ++i)
      visit(intervals[begin + i], result.valid[i] != 0, result.colliding[i]);
  }
}

/// Those of few samples first: most motions that collide do so at one of them.
void Check::checkSamples()
{
  std::size_t largest = 0;
  for (const Motion& motion : motions_)
    largest = std::max(largest, motion.order.size());
  std::size_t end = last_valid_ ? largest : kFirstSamples;
  for (std::size_t begin = 0; begin < largest; begin = end, end *= kGrowth)
  {
    std::vector<Interval> intervals;
    for (std::size_t i = 0; i < motions_.size(); ++i)
    {
      const Motion& motion = motions_[i];
      for (std::size_t k = begin; motion.valid && k < std::min(end, motion.order.size()); ++k)
        intervals.push_back({i, motion.fraction(motion.order[k]), 1.0 / static_cast<double>(motion.parts)});
    }
    ask(intervals, false,
        [this](const Interval& interval, bool free, const std::array<std::int32_t, 2>& colliding)
        {
          if (!free)
            fail(interval.motion, interval.begin(), colliding);
        });
  }
}

std::vector<Interval> Check::firstIntervals() const
{
  std::vector<Interval> intervals;
  for (std::size_t i = 0; i < motions_.size(); ++i)
  {
    const Motion& motion = motions_[i];
    for (std::size_t k = 0; k <= motion.parts; ++k)
    {
      const Interval interval{i, motion.fraction(k), 0.5 / static_cast<double>(motion.parts)};
      if (isWanted(interval))
        intervals.push_back(interval);
    }
  }
  return intervals;
}

/// Of those that are still wanted; where that is too small, or too many samples were taken, the motion is given up.
std::vector<Interval> Check::halves(const std::vector<Interval>& intervals)
{
  for (const Interval& interval : intervals)
    if (const Motion& motion = motions_[interval.motion];
        motion.samples >= options_.most_samples || motion.longest_way * interval.half < kLeastWay)
      fail(interval.motion, interval.begin(), {-1, -1});
  std::vector<Interval> result;
  for (const Interval& interval : intervals)
    if (isWanted(interval))
      for (const double side : {-0.5, 0.5})
      {
        const Interval half{interval.motion, interval.middle + side * interval.half, 0.5 * interval.half};
        // What the first and the last sample stand for is half outside.
        if (half.middle > 0.0 && half.middle < 1.0)
          result.push_back(half);
      }
  return result;
}

void Check::prove()
{
  std::vector<Interval> open = firstIntervals();
  for (bool are_free = true; !open.empty(); are_free = false)
  {
    std::vector<Interval> near;
    ask(open, true,
        [&near](const Interval& interval, bool free, const std::array<std::int32_t, 2>&)
        {
          if (!free)
            near.push_back(interval);
        });
    if (!are_free)
      ask(near, false,
          [this](const Interval& interval, bool free, const std::array<std::int32_t, 2>& colliding)
          {
            if (!free)
              fail(interval.motion, interval.begin(), colliding);
          });
    open = halves(near);
  }
}

std::vector<MotionVerdict> Check::verdicts() const
{
  std::vector<MotionVerdict> verdicts;
  verdicts.reserve(motions_.size());
  for (const Motion& motion : motions_)
    verdicts.push_back({motion.valid, motion.valid ? 1.0 : last_valid_ ? motion.limit : 0.0, motion.colliding});
  return verdicts;
}
}  // namespace

MotionRule motionRuleFromName(const std::string& name)
{
  if (name == "samples")
    return MotionRule::Samples;
  if (name == "bound")
    return MotionRule::Bound;
  throw Error("the motion rule is '" + name + "'; it must be samples or bound");
}

MotionChecker::MotionChecker(std::shared_ptr<StateChecker> checker, std::shared_ptr<const RobotModel> robot,
                             std::string group, const MotionCheckerOptions& options)
  : checker_(std::move(checker)), robot_(std::move(robot)), group_(std::move(group)), options_(options)
{
  validateSteps(options_.steps);
}

std::vector<MotionVerdict> MotionChecker::check(const double* starts, const double* ends, std::size_t count,
                                                bool last_valid) const
{
  return check(starts, ends, count, options_, last_valid);
}

std::vector<MotionVerdict> MotionChecker::checkSamples(const double* starts, const double* ends,
                                                       std::size_t count) const
{
  MotionCheckerOptions options = options_;
  options.rule = MotionRule::Samples;
  return check(starts, ends, count, options, false);
}

std::vector<MotionVerdict> MotionChecker::check(const double* starts, const double* ends, std::size_t count,
                                                const MotionCheckerOptions& options, bool last_valid) const
{
  refuseNonFinite(*robot_, starts, count);
  refuseNonFinite(*robot_, ends, count);
  const std::size_t width = robot_->variables().size();
  Check check(*checker_, *robot_, group_, options, last_valid);
  for (std::size_t i = 0; i < count; ++i)
    check.add(starts + i * width, ends + i * width);
  check.checkSamples();
  if (options.rule == MotionRule::Bound && !robot_->joints().empty())
    check.prove();
  states_checked_ += check.statesChecked();
  return check.verdicts();
}
}  // namespace gpu_planning_scene
