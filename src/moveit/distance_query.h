#pragma once

#include <limits>

#include <moveit/collision_detection/collision_common.h>

#include "moveit/exact_pair.h"
#include "moveit/pair_filter.h"

namespace gpu_planning_scene::detector
{
/// One call of distanceSelf or distanceRobot: measures pairs and writes the result. As in MoveIt's detectors, the
/// result is not cleared first.
class DistanceQuery
{
 public:
  /// The arguments must outlive the query.
  DistanceQuery(const collision_detection::DistanceRequest& request, collision_detection::DistanceResult& result,
                const PairFilter& filter, PairScratch& scratch);

  /// Whether nothing can change the result any more.
  bool isDone() const { return is_done_; }

  /// No pair at this distance or farther away changes the result. Infinite if only the pair itself tells.
  double limit() const;

  /// Measures two parts.
  void measure(const Part& a, const Part& b);

 private:
  double limitOf(const Part& a, const Part& b) const;
  collision_detection::DistanceResultsData dataOf(const Part& a, const Part& b, double distance, bool collides);
  void add(const Part& a, const Part& b, const collision_detection::DistanceResultsData& data);

  const collision_detection::DistanceRequest& request_;
  collision_detection::DistanceResult& result_;
  const PairFilter& filter_;
  PairScratch& scratch_;
  bool is_done_ = false;
};

/// Lower bound of the distance of two parts, beyond their paddings. Can be negative.
double leastDistance(const Part& a, const Part& b);
}  // namespace gpu_planning_scene::detector
