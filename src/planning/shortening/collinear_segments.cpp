#include "planning/shortening/collinear_segments.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

// A run of motions is straight if its length is the distance between its ends. Then one motion can replace it, and the
// length of the path stays the same. Own method.
namespace gpu_planning_scene::core
{
using ompl::geometric::PathGeometric;

namespace
{
/// Finds straight runs of several motions. Returns the first and the last vertex of each run.
std::vector<std::pair<std::size_t, std::size_t>> collinearRuns(const PathGeometric& path)
{
  // Tolerance, as a fraction of the run's length: larger than rounding errors, and too small to matter.
  constexpr double kCollinear = 1e-9;
  const auto distance = [&](std::size_t from, std::size_t to)
  {
    return path.getSpaceInformation()->distance(path.getState(static_cast<unsigned int>(from)),
                                                path.getState(static_cast<unsigned int>(to)));
  };
  std::vector<std::pair<std::size_t, std::size_t>> runs;
  for (std::size_t begin = 0; begin + 1 < path.getStateCount();)
  {
    std::size_t end = begin + 1;
    double length = distance(begin, end);
    for (; end + 1 < path.getStateCount(); ++end)
    {
      const double longer = length + distance(end, end + 1);
      if (distance(begin, end + 1) < (1.0 - kCollinear) * longer)
        break;
      length = longer;
    }
    if (end > begin + 1)
      runs.emplace_back(begin, end);
    begin = end;
  }
  return runs;
}
}  // namespace

void mergeCollinearSegments(PathGeometric& path, const MotionValidator& validator,
                            const ompl::base::PlannerTerminationCondition& ptc)
{
  const auto runs = collinearRuns(path);
  std::vector<MotionValidator::Motion> motions;
  for (const auto& [begin, end] : runs)
    motions.emplace_back(path.getState(static_cast<unsigned int>(begin)),
                         path.getState(static_cast<unsigned int>(end)));
  const std::vector<std::uint8_t> valid = validator.validateMotions(motions, ptc);
  std::vector<std::uint8_t> is_kept(path.getStateCount(), 1);
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (std::size_t vertex = runs[i].first + 1; valid[i] != 0 && vertex < runs[i].second; ++vertex)
      is_kept[vertex] = 0;
  PathGeometric joined(path.getSpaceInformation());
  for (std::size_t vertex = 0; vertex < is_kept.size(); ++vertex)
    if (is_kept[vertex] != 0)
      joined.append(path.getState(static_cast<unsigned int>(vertex)));
  path = joined;
}
}  // namespace gpu_planning_scene::core
