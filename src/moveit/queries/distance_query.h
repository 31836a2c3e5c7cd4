#pragma once

#include <limits>

#include <moveit/collision_detection/collision_common.h>

#include "moveit/pairs/exact_pair.h"
#include "moveit/pairs/pair_filter.h"

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

  /// No pair at this distance or farther away changes the result. The limit of a single pair can be smaller, see
  /// limitOf().
  double limit() const;

  /// Measures two shape instances.
  void measure(const ShapeInstance& a, const ShapeInstance& b);

 private:
  double limitOf(const ShapeInstance& a, const ShapeInstance& b) const;
  collision_detection::DistanceResultsData dataOf(const ShapeInstance& a, const ShapeInstance& b, double distance,
                                                  bool collides);
  void add(const ShapeInstance& a, const ShapeInstance& b, const collision_detection::DistanceResultsData& data);

  const collision_detection::DistanceRequest& request_;
  collision_detection::DistanceResult& result_;
  const PairFilter& filter_;
  PairScratch& scratch_;
  bool is_done_ = false;
};

/// Lower bound of the distance of two shape instances, beyond their paddings. Can be negative.
double leastDistance(const ShapeInstance& a, const ShapeInstance& b);
}  // namespace gpu_planning_scene::detector
