#include "collision/break_even.h"

#include <algorithm>
#include <cmath>

namespace gpu_planning_scene
{
namespace
{
// Growing, as long as the last one took less than kLong; the second is timed in any case.
constexpr std::size_t kSizes[] = {1, 64, 256, 1024};
constexpr double kLong = 0.005;  // seconds

struct Line
{
  double fixed;     // seconds
  double per_item;  // seconds
};

/// Through the two largest sizes that were timed: small batches leave lanes or cores idle, so time grows more slowly at
/// first.
Line fit(const TimedWork& work)
{
  work(1);  // what is only done the first time
  Line line{};
  std::size_t last_size = 0;
  double last = 0.0;
  for (const std::size_t size : kSizes)
  {
    double seconds = work(size);
    if (seconds < kLong)  // what disturbs only makes slower
      seconds = std::min(seconds, work(size));
    if (last_size != 0)
      line.per_item = std::max(0.0, (seconds - last) / static_cast<double>(size - last_size));
    line.fixed = std::max(0.0, seconds - line.per_item * static_cast<double>(size));
    if (last_size != 0 && seconds >= kLong)
      break;
    last_size = size;
    last = seconds;
  }
  return line;
}
}  // namespace

std::size_t breakEven(const TimedWork& direct, const TimedWork& bulk)
{
  const Line a = fit(direct);
  const Line b = fit(bulk);
  if (b.fixed <= a.fixed && b.per_item <= a.per_item)
    return 0;
  if (b.per_item >= a.per_item)
    return kNoBatch;
  const double size = std::max(0.0, (b.fixed - a.fixed) / (a.per_item - b.per_item));
  return size < 1e9 ? static_cast<std::size_t>(std::ceil(size)) : kNoBatch;
}
}  // namespace gpu_planning_scene
