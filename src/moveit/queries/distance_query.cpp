#include "moveit/queries/distance_query.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "moveit/pairs/pair_contacts.h"
#include "moveit/shapes/log.h"

// The distance of a pair is that of the exact tests: the least x for which the pair collides with its paddings plus x.
namespace gpu_planning_scene::detector
{
namespace
{
using collision_detection::DistanceRequest;
using collision_detection::DistanceRequestType;
using collision_detection::DistanceResult;
using collision_detection::DistanceResultsData;

// Exceeds the rounding of the bounds.
constexpr double kBoundsMargin = 1e-9;  // metres

/// Upper bound of the distance of two shape instances with limits.
double mostDistance(const ShapeInstance& a, const ShapeInstance& b)
{
  const Eigen::Vector3d reach =
      (a.bounds.max() - b.bounds.min()).cwiseAbs().cwiseMax((b.bounds.max() - a.bounds.min()).cwiseAbs());
  const double most = reach.norm() + kBoundsMargin;
  return std::isfinite(most) ? most : 4.0 * core::kLargestLength;
}

bool isNearer(const DistanceResultsData& a, const DistanceResultsData& b)
{
  return a.distance < b.distance;
}
}  // namespace

double leastDistance(const ShapeInstance& a, const ShapeInstance& b)
{
  const double distance = a.bounds.exteriorDistance(b.bounds) - kBoundsMargin;
  return std::isfinite(distance) ? distance : -kBoundsMargin;
}

DistanceQuery::DistanceQuery(const DistanceRequest& request, DistanceResult& result, const PairFilter& filter,
                             PairScratch& scratch)
  : request_(request), result_(result), filter_(filter), scratch_(scratch)
{
}

double DistanceQuery::limit() const
{
  return request_.type == DistanceRequestType::GLOBAL
             ? std::min(request_.distance_threshold, result_.minimum_distance.distance)
             : request_.distance_threshold;
}

double DistanceQuery::limitOf(const ShapeInstance& a, const ShapeInstance& b) const
{
  const auto known = result_.distances.find(keyOf(a, b));
  if (request_.type == DistanceRequestType::GLOBAL || known == result_.distances.end() || known->second.empty())
    return limit();
  if (request_.type == DistanceRequestType::SINGLE)
    return std::min(limit(), known->second.front().distance);
  if (request_.type == DistanceRequestType::LIMITED && known->second.size() >= request_.max_contacts_per_body)
    return std::min(limit(), known->second.back().distance);
  return limit();
}

void DistanceQuery::measure(const ShapeInstance& a, const ShapeInstance& b)
{
  if (sameBody(a.body, b.body) || (!filter_.isActive(a.body) && !filter_.isActive(b.body)))
    return;
  // A pair that collides can still be nearer than another colliding pair, by its depth.
  const double lower = leastDistance(a, b);
  const double limit = limitOf(a, b);
  if ((lower > 0.0 || (limit <= 0.0 && !request_.enable_signed_distance)) && lower >= limit)
    return;
  if (filter_.rule(a.body, b.body) == PairFilter::Rule::Skip)
    return;
  const bool collides = lower <= 0.0 && collide(a, b, scratch_);
  const double most = std::min(limit, mostDistance(a, b));
  const double distance = collides ? 0.0 : most <= 0.0 ? limit : clearance(a, b, most, scratch_);
  // A pair that is not nearer than `most` has no distance that was measured.
  if (collides || distance < most)
    add(a, b, dataOf(a, b, distance, collides));
}

DistanceResultsData DistanceQuery::dataOf(const ShapeInstance& a, const ShapeInstance& b, double distance,
                                          bool collides)
{
  DistanceResultsData data;
  data.distance = distance;
  data.link_names[0] = *a.body.name;
  data.link_names[1] = *b.body.name;
  data.body_types[0] = a.body.type;
  data.body_types[1] = b.body.type;
  if (collides && (request_.enable_signed_distance || request_.enable_nearest_points || request_.compute_gradient))
  {
    const core::ShapeContact deepest = contactsOf(a, b, 1, scratch_).front();
    if (request_.enable_signed_distance)
      data.distance = -deepest.depth;
    data.nearest_points[0] = data.nearest_points[1] = deepest.point;
    data.normal = deepest.normal;
  }
  else if (request_.enable_nearest_points || request_.compute_gradient)
  {
    const NearestPoints points = nearestPointsOf(a, b, distance, scratch_);
    data.nearest_points[0] = points.on_a;
    data.nearest_points[1] = points.on_b;
    data.normal = (points.on_b - points.on_a).normalized();
  }
  return data;
}

void DistanceQuery::add(const ShapeInstance& a, const ShapeInstance& b, const DistanceResultsData& data)
{
  if (request_.verbose)
    ROS_INFO_STREAM_NAMED(
        kLogName, "'" << data.link_names[0] << "' is " << data.distance << " m from '" << data.link_names[1] << "'");
  if (data.distance < result_.minimum_distance.distance)
    result_.minimum_distance = data;
  if (data.distance <= 0.0)
    result_.collision = true;
  if (request_.type == DistanceRequestType::GLOBAL)
  {
    is_done_ = result_.collision && !request_.enable_signed_distance;
    return;
  }
  std::vector<DistanceResultsData>& known = result_.distances[keyOf(a, b)];
  known.insert(std::upper_bound(known.begin(), known.end(), data, isNearer), data);
  const std::size_t most = request_.type == DistanceRequestType::SINGLE ? 1
                           : request_.type == DistanceRequestType::LIMITED
                               ? std::max<std::size_t>(1, request_.max_contacts_per_body)
                               : known.size();
  known.resize(std::min(known.size(), most));
}
}  // namespace gpu_planning_scene::detector
