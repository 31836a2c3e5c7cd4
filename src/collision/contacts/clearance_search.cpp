#include "collision/contacts/clearance_search.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "collision/contacts/pair_search.h"

// Three answers of one search, which differ in the pairs that they keep. Own method.
namespace gpu_planning_scene::core
{
namespace
{
/// Keeps the nearest pair of all.
struct NearestOfAll
{
  double reach(std::int32_t /*body*/) const { return found.order(); }
  double reach(const BodyPair& /*bodies*/) const { return found.order(); }
  void take(const NearBodies& pair) { found = pair; }

  NearBodies found = {};
};

/// Keeps all pairs of bodies within a range.
struct PairsWithin
{
  double reach(std::int32_t /*body*/) const { return range; }
  double reach(const BodyPair& bodies) const
  {
    const auto known = found.find(bodies);
    return known == found.end() ? range : known->second.order();
  }
  void take(const NearBodies& pair) { found[pair.bodies] = pair; }

  double range;
  std::map<BodyPair, NearBodies> found = {};
};

/// Keeps the nearest pair of each body of the robot.
struct NearestOfBodies
{
  double reach(std::int32_t body) const
  {
    const auto known = found.find(body);
    return known == found.end() ? range : known->second.order();
  }
  double reach(const BodyPair& bodies) const
  {
    return is_self ? std::max(reach(bodies[0]), reach(bodies[1])) : reach(bodies[0]);
  }
  void take(const NearBodies& pair)
  {
    if (pair.order() < reach(pair.bodies[0]))
      found[pair.bodies[0]] = pair;
    if (is_self && pair.order() < reach(pair.bodies[1]))
    {
      NearBodies& swapped = found[pair.bodies[1]] = pair;
      std::swap(swapped.bodies[0], swapped.bodies[1]);
      std::swap(swapped.points[0], swapped.points[1]);
    }
  }

  double range;
  bool is_self = false;  // both bodies of a pair are the robot's
  std::map<std::int32_t, NearBodies> found = {};
};

template <class Map>
std::vector<NearBodies> valuesOf(const Map& found)
{
  std::vector<NearBodies> values;
  values.reserve(found.size());
  for (const auto& [key, value] : found)
    values.push_back(value);
  return values;
}
}  // namespace

ClearanceSearch::ClearanceSearch(std::shared_ptr<const CollisionProblem> problem,
                                 std::shared_ptr<const CpuForest> forest, std::shared_ptr<const ObjectTree> objects,
                                 const ConvexTrees& convex)
  : problem_(std::move(problem)), forest_(std::move(forest)), objects_(std::move(objects)), convex_(convex)
{
  world_bounds_.reserve(problem_->world.size());
  for (const ShapeInstance& instance : problem_->world)
    world_bounds_.push_back(boundsOf(forest_->tree(instance.tree), instance.pose));
}

NearestOfState ClearanceSearch::find(const Eigen::Isometry3d* link_poses) const
{
  NearestOfAll world;
  NearestOfAll self;
  PairSearch search(*problem_, forest_, *objects_, convex_, world_bounds_, link_poses);
  search.world(world);
  search.self(self);
  return {world.found, self.found};
}

std::vector<NearBodies> ClearanceSearch::pairsWithin(double range, const Eigen::Isometry3d* link_poses) const
{
  PairsWithin pairs{range};
  PairSearch search(*problem_, forest_, *objects_, convex_, world_bounds_, link_poses);
  search.world(pairs);
  search.self(pairs);
  return valuesOf(pairs.found);
}

std::vector<NearBodies> ClearanceSearch::nearestOfBodies(double range, const Eigen::Isometry3d* link_poses) const
{
  NearestOfBodies bodies{range};
  PairSearch search(*problem_, forest_, *objects_, convex_, world_bounds_, link_poses);
  search.world(bodies);
  bodies.is_self = true;
  search.self(bodies);
  return valuesOf(bodies.found);
}
}  // namespace gpu_planning_scene::core
