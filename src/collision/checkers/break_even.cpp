#include "collision/checkers/break_even.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace gpu_planning_scene::core
{
namespace
{
// Growing, until one of the two takes kLong; two of them in any case.
constexpr std::size_t kSizes[] = {1, 16, 64, 256, kMostTimed};
constexpr double kLong = 0.005;    // seconds
constexpr int kRepeats = 3;        // of which the fastest counts: what disturbs only makes slower
constexpr int kConfirmations = 5;  // before the bulk way is believed to be the faster one, however long it takes
// What is not clearly faster is not chosen: a measurement that was disturbed must not be a loss for as long as it
// holds.
constexpr double kClearly = 1.2;
// Beyond what was timed, only a much smaller cost of each further item is believed.
constexpr double kMuchLess = 2.0;

struct Comparison
{
  double size;
  double direct;  // seconds
  double bulk;

  /// By how many seconds the direct way was faster, with what it is granted.
  double ahead() const { return kClearly * bulk - direct; }
  double longest() const { return std::max(direct, bulk); }
};

std::vector<Comparison> compare(const TimedWork& direct, const TimedWork& bulk)
{
  direct(1);  // what is only done the first time
  bulk(1);
  std::vector<Comparison> made;
  for (const std::size_t size : kSizes)
  {
    Comparison times{static_cast<double>(size), direct(size), bulk(size)};
    const auto more = [&times](int runs)
    { return times.ahead() <= 0.0 ? runs < kConfirmations : runs < kRepeats && times.longest() < kLong; };
    for (int runs = 1; more(runs); ++runs)
    {
      times.direct = std::min(times.direct, direct(size));
      times.bulk = std::min(times.bulk, bulk(size));
    }
    made.push_back(times);
    if (made.size() > 1 && times.longest() >= kLong)
      break;
  }
  return made;
}
}  // namespace

/// Between two sizes the lead is taken to be linear, and beyond the last as between the last two: small batches leave
/// lanes or cores idle, so that time grows more slowly at first.
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
  const double lost = (a.ahead() - b.ahead()) / (b.size - a.size);  // of the lead, for each item
  const double size = a.size + a.ahead() / lost;
  return lost > 0.0 && size < 1e9 ? static_cast<std::size_t>(std::ceil(size)) : kNoBatch;
}
}  // namespace gpu_planning_scene::core
