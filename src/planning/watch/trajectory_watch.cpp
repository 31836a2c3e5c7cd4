#include "gpu_planning_scene/planning/trajectory_watch.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <string>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/interpolation.h"
#include "planning/watch/braking.h"

// A motion of several trajectories is one motion of all their variables: at the times of all rows, every trajectory has
// a row of its own or one between two of its rows, and between these times, all variables move straight. So bodies of
// two trajectories are checked at the same time of the motion.
namespace gpu_planning_scene::core
{
namespace
{
// Radians or metres: a robot this near to a turn of its trajectory may be past it.
constexpr double kCutTurn = 0.01;

std::size_t widthOf(const WatchedTrajectory& trajectory)
{
  return trajectory.columns.size();
}

/// A full state with a row's values. Only the variables of the trajectory count.
std::vector<double> fullState(const RobotModel& robot, const WatchedTrajectory& trajectory, const double* row)
{
  std::vector<double> state(robot.variables().size(), 0.0);
  for (std::size_t i = 0; i < trajectory.columns.size(); ++i)
    state[static_cast<std::size_t>(trajectory.columns[i])] = row[i];
  return state;
}

/// Whether a whole turn of a variable changes nothing, one entry per variable.
std::vector<bool> wrappingVariables(const RobotModel& robot)
{
  std::vector<bool> wraps(robot.variables().size(), false);
  for (const Joint& joint : robot.joints())
    if (!joint.mimic && joint.type == JointType::Continuous && isPeriodic(robot, joint))
      wraps[static_cast<std::size_t>(joint.first_variable)] = true;
    else if (!joint.mimic && joint.type == JointType::Planar)
      wraps[static_cast<std::size_t>(joint.first_variable) + 2] = true;
  return wraps;
}

/// The differences of two rows of a trajectory, in the shorter direction where a whole turn changes nothing.
class Differences
{
 public:
  Differences(const RobotModel& robot, const WatchedTrajectory& trajectory)
  {
    const std::vector<bool> wraps = wrappingVariables(robot);
    for (const int column : trajectory.columns)
      wraps_.push_back(wraps[static_cast<std::size_t>(column)]);
  }

  std::vector<double> operator()(const std::vector<double>& from, const std::vector<double>& to) const
  {
    std::vector<double> found(from.size());
    for (std::size_t i = 0; i < from.size(); ++i)
      found[i] = wraps_[i] ? shortestAngularDistance(from[i], to[i]) : to[i] - from[i];
    return found;
  }

 private:
  std::vector<bool> wraps_;  // one per variable of the trajectory
};

double product(const std::vector<double>& a, const std::vector<double>& b)
{
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// The part of a trajectory that contains a time, and the fraction of it. The time must be within its rows.
struct Place
{
  std::size_t part;
  double fraction;
};

Place placeOf(const std::vector<double>& seconds, double time)
{
  const auto after = std::upper_bound(seconds.begin(), seconds.end() - 1, time);
  const auto part = static_cast<std::size_t>(after - seconds.begin()) - 1;
  return {part, std::clamp((time - seconds[part]) / (seconds[part + 1] - seconds[part]), 0.0, 1.0)};
}

/// Whether a robot that is not quite at the turns after `place` is already past them: a controller cuts turns short.
/// `values`: of the robot. `turn`: the time of the first row after `place`. `cut`: the place from which turns are cut
/// short, at or before `place`.
bool hasTurned(const RobotModel& robot, const WatchedTrajectory& trajectory, const std::vector<double>& values,
               double place, double cut, std::vector<double>::const_iterator turn)
{
  const std::vector<double>& seconds = trajectory.rows.seconds;
  const Differences difference(robot, trajectory);
  const double deviation = deviationAt(robot, trajectory, values, place);
  for (auto next = std::next(turn); next != seconds.end(); ++turn, ++next)
  {
    const std::vector<double> corner = rowAt(robot, trajectory, *turn);
    if (deviationAt(robot, trajectory, corner, cut) > kCutTurn)
      return false;
    const std::vector<double> along = difference(corner, rowAt(robot, trajectory, *next));
    const double squared = product(along, along);
    const double share = squared > 0.0 ? product(difference(corner, values), along) / squared : 0.0;
    if (share > 0.0 &&
        deviationAt(robot, trajectory, values, *turn + std::min(share, 1.0) * (*next - *turn)) < deviation)
      return true;
  }
  return false;
}
}  // namespace

void validateTrajectory(const WatchedTrajectory& trajectory)
{
  const std::vector<double>& seconds = trajectory.rows.seconds;
  const std::vector<double>& values = trajectory.rows.values;
  if (seconds.empty() || values.size() != seconds.size() * widthOf(trajectory))
    throw Error("the trajectory has " + std::to_string(values.size()) + " values for " +
                std::to_string(seconds.size()) + " rows of " + std::to_string(widthOf(trajectory)) +
                " variables; give whole rows, at least one");
  for (std::size_t row = 0; row < seconds.size(); ++row)
  {
    if (!std::isfinite(seconds[row]) || (row > 0 && !(seconds[row] > seconds[row - 1])))
      throw Error("row " + std::to_string(row) + " of the trajectory is at " + std::to_string(seconds[row]) +
                  " s; the times of the rows must be finite and increase");
    for (std::size_t i = 0; i < widthOf(trajectory); ++i)
      if (!std::isfinite(values[row * widthOf(trajectory) + i]))
        throw Error("row " + std::to_string(row) + " of the trajectory has a value that is not a finite number");
  }
}

std::vector<double> rowAt(const RobotModel& robot, const WatchedTrajectory& trajectory, double time)
{
  const std::vector<double>& seconds = trajectory.rows.seconds;
  const double* values = trajectory.rows.values.data();
  const std::size_t width = widthOf(trajectory);
  if (time <= seconds.front())
    return {values, values + width};
  if (time >= seconds.back())
    return {values + (seconds.size() - 1) * width, values + seconds.size() * width};
  const Place place = placeOf(seconds, time);
  const std::vector<double> from = fullState(robot, trajectory, values + place.part * width);
  const std::vector<double> to = fullState(robot, trajectory, values + (place.part + 1) * width);
  std::vector<double> between(from.size());
  interpolate(robot, from.data(), to.data(), place.fraction, between.data());
  std::vector<double> row;
  for (const int column : trajectory.columns)
    row.push_back(between[static_cast<std::size_t>(column)]);
  return row;
}

double deviationAt(const RobotModel& robot, const WatchedTrajectory& trajectory, const std::vector<double>& values,
                   double time)
{
  double largest = 0.0;
  for (const double each : Differences(robot, trajectory)(rowAt(robot, trajectory, time), values))
    largest = std::max(largest, std::abs(each));
  return largest;
}

Progress progressFrom(const RobotModel& robot, const WatchedTrajectory& trajectory, const std::vector<double>& values,
                      double from)
{
  const Differences difference(robot, trajectory);
  const std::vector<double>& seconds = trajectory.rows.seconds;
  double time = std::max(from, seconds.front());
  std::vector<double> row = rowAt(robot, trajectory, time);
  std::optional<double> cut;  // the place on the trajectory from which turns are cut short
  for (auto next = std::upper_bound(seconds.begin(), seconds.end(), time); next != seconds.end(); ++next)
  {
    const std::vector<double> end = rowAt(robot, trajectory, *next);
    const std::vector<double> along = difference(row, end);
    const double squared = product(along, along);
    const double share = squared > 0.0 ? product(difference(row, values), along) / squared : 1.0;
    const double place = time + std::clamp(share, 0.0, 1.0) * (*next - time);
    if (share < 1.0)
      cut = cut.value_or(place);
    else
      cut.reset();
    if (cut && !hasTurned(robot, trajectory, values, place, *cut, next))
    {
      time = place;
      break;
    }
    time = *next;
    row = end;
  }
  return {time, deviationAt(robot, trajectory, values, time)};
}

TimedRows motionOfAll(const RobotModel& robot, const std::vector<const WatchedTrajectory*>& trajectories,
                      const std::vector<double>& delays, const std::vector<double>& state, double from)
{
  const auto is_finite = [](double time) { return std::isfinite(time); };
  if (!is_finite(from) || !std::all_of(delays.begin(), delays.end(), is_finite))
    throw Error("the time from which a motion is wanted, or a delay, is not a finite number of seconds");
  TimedRows motion;
  motion.seconds = {from};
  for (std::size_t i = 0; i < trajectories.size(); ++i)
    for (const double time : trajectories[i]->rows.seconds)
      if (time + delays[i] > from)
        motion.seconds.push_back(time + delays[i]);
  std::sort(motion.seconds.begin(), motion.seconds.end());
  motion.seconds.erase(std::unique(motion.seconds.begin(), motion.seconds.end()), motion.seconds.end());
  const std::size_t width = robot.variables().size();
  motion.values.reserve(motion.seconds.size() * width);
  for (const double time : motion.seconds)
  {
    motion.values.insert(motion.values.end(), state.begin(), state.end());
    double* const row = motion.values.data() + motion.values.size() - width;
    for (std::size_t i = 0; i < trajectories.size(); ++i)
    {
      const std::vector<double> values = rowAt(robot, *trajectories[i], time - delays[i]);
      for (std::size_t k = 0; k < values.size(); ++k)
        row[trajectories[i]->columns[k]] = values[k];
    }
  }
  return motion;
}

MotionOutlook outlookOf(const MotionChecker& checker, const RobotModel& robot, const TimedRows& motion,
                        const std::function<bool()>& stop)
{
  bool has_stopped = false;
  const std::function<bool()> is_over = [&]
  {
    has_stopped = has_stopped || (stop && stop());
    return has_stopped;
  };
  const std::size_t width = robot.variables().size();
  const double* rows = motion.values.data();
  // A robot that stands is a motion too.
  const std::size_t parts = std::max<std::size_t>(motion.seconds.size() - 1, 1);
  const double* ends = motion.seconds.size() > 1 ? rows + width : rows;
  const auto is_valid = [](const MotionVerdict& verdict) { return verdict.valid; };

  MotionOutlook outlook;
  const std::vector<MotionVerdict> verdicts = checker.check(rows, ends, parts, MotionQuery::Valid, is_over);
  if (has_stopped)
    throw Cancelled();
  const auto bad = std::find_if_not(verdicts.begin(), verdicts.end(), is_valid);
  if (bad == verdicts.end())
  {
    outlook.free = true;
    outlook.free_until = motion.seconds.back();
    return outlook;
  }
  const auto part = static_cast<std::size_t>(bad - verdicts.begin());
  const double* const start = rows + part * width;
  const double* const end = ends + part * width;
  const MotionVerdict verdict = checker.check(start, end, 1, MotionQuery::LastValid, is_over).front();
  if (has_stopped)
    throw Cancelled();
  const double begin = motion.seconds[part];
  const double lasts = motion.seconds.size() > 1 ? motion.seconds[part + 1] - begin : 0.0;
  outlook.free_until = begin + verdict.last_valid * lasts;
  outlook.collision = begin + verdict.first_invalid * lasts;
  outlook.colliding = verdict.colliding;
  outlook.state.resize(width);
  interpolate(robot, start, end, verdict.first_invalid, outlook.state.data());
  outlook.brake_by = latestBraking(robot, motion, outlook.free_until);
  return outlook;
}
}  // namespace gpu_planning_scene::core
