#include "collision/checkers/cpu_or_gpu.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "model/seconds_since.h"

// Times both checks at a few sizes, takes the fastest of several runs, and interpolates the size at which their times
// are equal. Own method: the size depends on the machine and the scene, so no constant fits.
namespace gpu_planning_scene::core
{
namespace
{
using Clock = std::chrono::steady_clock;

// After a measurement of t seconds, a new scene keeps the threshold for this many times t. So frequent scene changes do
// not cause frequent measurements.
constexpr double kMeasuringPause = 50.0;
// A new scene of similar size keeps it longer. It is measured again in the end, because other programs may have
// disturbed the last measurement.
constexpr double kPauseInSimilarScenes = 2000.0;
constexpr double kLongestPause = 300.0;  // seconds
// Two scenes are similar if neither has more than this many times the pairs of the other.
constexpr std::size_t kSimilar = 2;

// Fewer states of the caller are not representative.
constexpr std::size_t kEnough = 256;

// The timed sizes. When one of the two takes kLong, the sizes in between are left out. The largest size is timed
// nevertheless, unless it would take kTooLong: from small sizes alone, a single disturbance could lead to a wrong
// estimate for large ones.
constexpr std::size_t kSizes[] = {1, 16, 256, kMaxTimed};
constexpr double kLong = 0.005;    // seconds
constexpr double kTooLong = 0.3;   // seconds
constexpr int kRepeats = 3;        // the fastest run counts, because disturbances only slow a run down
constexpr int kConfirmations = 5;  // runs before `bulk` is accepted as faster, even if they are long
// `bulk` must be faster by this factor: a disturbed measurement must not select the slower one until the next
// measurement.
constexpr double kClearly = 1.2;
// Beyond the timed sizes, `bulk` is chosen only if its cost per further item is this many times smaller.
constexpr double kMuchLess = 2.0;

struct Comparison
{
  double size;
  double direct;  // seconds
  double bulk;

  /// Lead of `direct` in seconds, with the time of `bulk` weighted by kClearly.
  double ahead() const { return kClearly * bulk - direct; }
  double longest() const { return std::max(direct, bulk); }
};

Comparison compareAt(std::size_t size, const TimedWork& direct, const TimedWork& bulk)
{
  Comparison times{static_cast<double>(size), direct(size), bulk(size)};
  const auto more = [&times](int runs)
  { return times.ahead() <= 0.0 ? runs < kConfirmations : runs < kRepeats && times.longest() < kLong; };
  for (int runs = 1; more(runs); ++runs)
  {
    times.direct = std::min(times.direct, direct(size));
    times.bulk = std::min(times.bulk, bulk(size));
  }
  return times;
}

/// The time of a larger size, by a line through the times of the last two sizes.
double expectedSeconds(const std::vector<Comparison>& made, std::size_t size)
{
  const Comparison& a = made[made.size() - 2];
  const Comparison& b = made.back();
  const double growth = std::max(0.0, b.longest() - a.longest()) / (b.size - a.size);
  return b.longest() + growth * (static_cast<double>(size) - b.size);
}

std::vector<Comparison> compare(const TimedWork& direct, const TimedWork& bulk)
{
  direct(1);  // untimed: the first call may do work that later calls need not do
  bulk(1);
  std::vector<Comparison> made;
  for (const std::size_t size : kSizes)
  {
    const bool is_short = made.size() < 2 || made.back().longest() < kLong;
    if (is_short || (size == kMaxTimed && expectedSeconds(made, size) < kTooLong))
      made.push_back(compareAt(size, direct, bulk));
  }
  // A smaller batch does not take longer than a larger one. If it seems to, it was disturbed.
  for (std::size_t i = made.size() - 1; i-- > 0;)
    made[i].bulk = std::min(made[i].bulk, made[i + 1].bulk);
  return made;
}

/// kMaxTimed states: those of the caller, repeated as needed, if there are enough of them; otherwise random states.
std::vector<double> sampleOf(const RobotModel& robot, const CollisionProblem& problem, const double* states,
                             std::size_t count)
{
  const std::size_t width = robot.variables().size();
  std::vector<double> sample(kMaxTimed * width);
  const std::vector<double> base = robot.defaultState();
  std::mt19937_64 generator;
  for (std::size_t i = 0; i < kMaxTimed; ++i)
  {
    double* row = sample.data() + i * width;
    const double* own = states + (count == 0 ? 0 : i % count) * width;
    if (count >= kEnough && isValidFor(problem, own))
      std::copy(own, own + width, row);
    else
      robot.randomState(generator, base.data(), row);
  }
  return sample;
}
}  // namespace

bool CpuOrGpu::Threshold::holdsFor(const std::shared_ptr<const PlanningScene>& other, std::size_t other_pairs) const
{
  if (scene.lock() == other)
    return true;
  const bool is_similar = other_pairs <= kSimilar * pairs && pairs <= kSimilar * other_pairs;
  const double pause = (is_similar ? kPauseInSimilarScenes : kMeasuringPause) * seconds;
  return secondsSince(measured_at) < std::min(pause, kLongestPause);
}

CpuOrGpu::Choice CpuOrGpu::choose(const std::string& group, const std::shared_ptr<const PlanningScene>& scene,
                                  const CollisionProblem& problem, const double* states, std::size_t count,
                                  ProofStage proofs, const Checks& checks)
{
  if (problem.always_colliding)
    return {true, std::nullopt};
  const std::size_t least = threshold(group, scene, problem, states, count, proofs, checks);
  return {count < least, least};
}

std::size_t CpuOrGpu::threshold(const std::string& group, const std::shared_ptr<const PlanningScene>& scene,
                                const CollisionProblem& problem, const double* states, std::size_t count,
                                ProofStage proofs, const Checks& checks)
{
  if (fixed_)
    return *fixed_;
  const auto known = thresholds_.find(group);
  const bool enough = count >= kEnough;
  if (known != thresholds_.end() && proofs <= known->second.proofs && (known->second.by_own_states || !enough) &&
      known->second.holdsFor(scene, instancePairs(problem)))
    return known->second.states;
  const Clock::time_point start = Clock::now();
  const std::vector<double> sample = sampleOf(*scene->robot, problem, states, count);
  const auto timed = [&sample](const Check& check)
  {
    return [&sample, &check](std::size_t size)
    {
      const Clock::time_point begin = Clock::now();
      check(sample.data(), size);
      return secondsSince(begin);
    };
  };
  const std::size_t measured = breakEven(timed(checks.cpu), timed(checks.gpu));
  thresholds_.insert_or_assign(
      group, Threshold{measured, scene, instancePairs(problem), Clock::now(), secondsSince(start), proofs, enough});
  return measured;
}

/// The lead of `direct` is interpolated linearly between two sizes, and extrapolated from the last two sizes. Only the
/// last sizes are used because small batches leave lanes or cores idle: their time grows more slowly.
std::size_t breakEven(const TimedWork& direct, const TimedWork& bulk)
{
  const std::vector<Comparison> made = compare(direct, bulk);
  std::size_t last = made.size();
  while (last > 0 && made[last - 1].ahead() <= 0.0)
    --last;
  if (last == 0)
    return 0;
  const bool beyond = last == made.size();
  const std::size_t after = std::max<std::size_t>(1, std::min(last, made.size() - 1));
  const Comparison& a = made[after - 1];
  const Comparison& b = made[after];
  if (beyond && kMuchLess * (b.bulk - a.bulk) >= b.direct - a.direct)
    return kNoBatch;
  const double lost = (a.ahead() - b.ahead()) / (b.size - a.size);  // lead that is lost per item
  const double size = a.size + a.ahead() / lost;
  return lost > 0.0 && size < 1e9 ? static_cast<std::size_t>(std::ceil(size)) : kNoBatch;
}
}  // namespace gpu_planning_scene::core
