#include "collision/contacts/body_distances.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "model/point_rates.h"

// A pair that does not collide has its nearest points. A pair that collides has its deepest contact: the search for
// clearances finds that it collides, and contacts are computed once for the state. The distance changes as the points
// move along the normal (for example R. Featherstone, Rigid Body Dynamics Algorithms, 2008, chapter 11; J. Schulman et
// al., "Motion planning with sequential convex optimization and convex collision checking", 2014).
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

constexpr double kLeastLength = 1e-9;  // metres; points that are nearer to each other have no direction

Vector3d directionFrom(const Vector3d& from, const Vector3d& to)
{
  const double length = (to - from).norm();
  return length > kLeastLength ? Vector3d((to - from) / length)
                               : Vector3d(Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
}

/// The colliding pairs of a state, which are computed when they are first needed.
class Collisions
{
 public:
  Collisions(const InspectedGroup& group, const std::vector<Eigen::Isometry3d>& link_poses)
    : group_(group), link_poses_(link_poses)
  {
  }

  /// The deepest pair that `wanted` selects; null if there is none.
  template <class Wanted>
  const CollidingPair* deepest(const Wanted& wanted)
  {
    if (!pairs_)
      pairs_ = group_.collidingPairs(link_poses_, 1);
    const CollidingPair* found = nullptr;
    for (const CollidingPair& pair : *pairs_)
      if (wanted(pair.bodies) && (!found || pair.contacts.front().depth > found->contacts.front().depth))
        found = &pair;
    return found;
  }

 private:
  const InspectedGroup& group_;
  const std::vector<Eigen::Isometry3d>& link_poses_;
  std::optional<std::vector<CollidingPair>> pairs_;
};

/// The distance of a pair that collides, seen from its body `first`.
BodyDistance distanceFrom(std::int32_t first, const CollidingPair& pair, double depth_at_least)
{
  const Contact& contact = pair.contacts.front();
  const bool swapped = contact.bodies[0] != first;
  BodyDistance found;
  found.bodies = {contact.bodies[swapped ? 1 : 0], contact.bodies[swapped ? 0 : 1]};
  found.collides = true;
  found.distance = -contact.depth;
  found.depth_at_least = depth_at_least;
  found.points = {contact.point, contact.point};
  found.normal = swapped ? Vector3d(-contact.normal) : contact.normal;
  return found;
}

/// The distance of a pair without its contact.
BodyDistance distanceOf(const NearBodies& pair)
{
  BodyDistance found;
  found.bodies = pair.bodies;
  found.distance = pair.clearance;
  found.collides = pair.collides;
  found.points = pair.points;
  found.normal = directionFrom(pair.points[0], pair.points[1]);
  return found;
}
}  // namespace

NearestPairs nearestPairsOf(const PlanningScene& scene, const InspectedGroup& group,
                            const std::vector<Eigen::Isometry3d>& link_poses)
{
  // Links and attached objects are the robot's bodies.
  const auto is_world = [first = static_cast<std::int32_t>(scene.robot->links().size()),
                         count = static_cast<std::int32_t>(scene.objects.size())](std::int32_t body)
  { return body >= first && body < first + count; };
  const NearestOfState nearest = group.clearance().find(link_poses.data());
  Collisions collisions(group, link_poses);
  const auto pair_of = [&](const NearBodies& near, bool of_world) -> NearestPair
  {
    if (near.bodies == kNoPair)
      return {};
    const CollidingPair* deepest =
        !near.collides ? nullptr
                       : collisions.deepest([&](const BodyPair& pair)
                                            { return (is_world(pair[0]) || is_world(pair[1])) == of_world; });
    if (deepest)
    {
      const Contact& contact = deepest->contacts.front();
      return {contact.bodies, -contact.depth, {contact.point, contact.point}};
    }
    if (near.bodies[0] < near.bodies[1])
      return {near.bodies, near.clearance, near.points};
    return {{near.bodies[1], near.bodies[0]}, near.clearance, {near.points[1], near.points[0]}};
  };
  return {pair_of(nearest.world, true), pair_of(nearest.self, false)};
}

StateDistances distancesOf(const RobotModel& robot, const InspectedGroup& group, const DistanceQuery& query,
                           const double* state, const std::vector<Eigen::Isometry3d>& link_poses)
{
  StateDistances found;
  Collisions collisions(group, link_poses);
  const ClearanceSearch& search = group.clearance();
  for (const NearBodies& near : query.nearest_of_each_body ? search.nearestOfBodies(query.range, link_poses.data())
                                                           : search.pairsWithin(query.range, link_poses.data()))
  {
    const auto is_wanted = [&](const BodyPair& pair)
    {
      const std::int32_t first = near.bodies[0];
      return query.nearest_of_each_body
                 ? pair[0] == first || pair[1] == first
                 : pair == BodyPair{std::min(first, near.bodies[1]), std::max(first, near.bodies[1])};
    };
    const CollidingPair* colliding = query.signed_distance && near.collides ? collisions.deepest(is_wanted) : nullptr;
    found.pairs.push_back(colliding ? distanceFrom(near.bodies[0], *colliding, group.leastDepth(*colliding, link_poses))
                                    : distanceOf(near));
  }
  if (!query.gradients)
    return found;
  const std::size_t width = robot.variables().size();
  found.gradients.assign(found.pairs.size() * width, 0.0);
  for (std::size_t i = 0; i < found.pairs.size(); ++i)
  {
    const BodyDistance& pair = found.pairs[i];
    double* gradient = &found.gradients[i * width];
    if (pair.normal.hasNaN())
    {
      std::fill_n(gradient, width, std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    for (const std::size_t end : {0, 1})
      if (const int link = group.linkOf(pair.bodies[end]); link >= 0)
        addPointRates(robot, state, link_poses.data(), link, pair.points[end], pair.normal, end == 0 ? -1.0 : 1.0,
                      gradient);
  }
  return found;
}
}  // namespace gpu_planning_scene::core
