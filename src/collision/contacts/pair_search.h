#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "collision/contacts/body_contacts.h"
#include "collision/contacts/clearance_search.h"
#include "collision/contacts/convex_trees.h"
#include "collision/exact/cpu_shape_pair.h"
#include "collision/exact/pair_clearance.h"
#include "collision/problem/collision_problem.h"
#include "collision/trees/cpu_forest.h"
#include "collision/trees/object_tree.h"

namespace gpu_planning_scene::core
{
/// Bounds of the distance of two shapes, in metres.
struct DistanceBounds
{
  double lower;
  double upper;

  static constexpr double kMargin = 1e-9;  // metres; exceeds the rounding error of the bounds
};

/// Of the contents of two boxes.
inline DistanceBounds distanceBounds(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b)
{
  const Eigen::Vector3d farthest = (a.max() - b.min()).cwiseAbs().cwiseMax((b.max() - a.min()).cwiseAbs());
  return {a.exteriorDistance(b) - DistanceBounds::kMargin, farthest.norm() + DistanceBounds::kMargin};
}

/// Finds the nearest pairs of one state by branch and bound: a pair is tested only if its boxes may be within its
/// reach. The nearer pairs come first. pair_clearance.cpp does the same within a pair (Larsen, Gottschalk, Lin and
/// Manocha, "Fast Distance Queries with Rectangular Swept Sphere Volumes", 2000).
///
/// `Nearest`, which self() and world() take, keeps the pairs that were found. In its functions, `bodies` begins with a
/// body of the robot; distances are metres beyond the required distance.
/// - reach(body): pairs of this body with the world matter only if they are nearer than this. Below 0: none is nearer.
/// - reach(bodies): this pair of bodies matters only if it is nearer than this.
/// - take(pair): receives a pair whose order() is below its reach.
class PairSearch
{
 public:
  /// `objects` must be built over worldBounds(). `world_bounds`: boxes of the world's instances, without padding.
  /// `link_poses`: in the planning frame. All must outlive the search.
  PairSearch(const CollisionProblem& problem, const std::shared_ptr<const CpuForest>& forest, const ObjectTree& objects,
             const ConvexTrees& convex, const std::vector<Eigen::AlignedBox3d>& world_bounds,
             const Eigen::Isometry3d* link_poses)
    : problem_(problem),
      forest_(*forest),
      pair_(forest),
      objects_(objects),
      convex_(convex),
      world_bounds_(world_bounds)
  {
    for (const ShapeInstance& instance : problem.robot)
    {
      poses_.push_back(placed(instance, link_poses));
      bounds_.push_back(boundsOf(forest_.tree(instance.tree), poses_.back()));
    }
  }

  /// The pairs within the robot.
  template <class Nearest>
  void self(Nearest& nearest)
  {
    std::vector<std::pair<DistanceBounds, InstancePair>> candidates;
    for (const InstancePair& pair : problem_.self_pairs)
      candidates.emplace_back(distanceBounds(bounds_[pair[0]], bounds_[pair[1]]), pair);
    std::sort(candidates.begin(), candidates.end(),
              [](const auto& a, const auto& b) { return a.first.lower < b.first.lower; });
    for (const auto& [bounds, pair] : candidates)
    {
      const ShapeInstance& b = problem_.robot[pair[1]];
      consider(bounds, 0.0, b.body, pair, ShapeWithPose{b.tree, poses_[pair[1]]}, nearest);
    }
  }

  /// The pairs of the robot with the world.
  template <class Nearest>
  void world(Nearest& nearest)
  {
    for (std::uint32_t i = 0; i < problem_.robot.size(); ++i)
    {
      visitObjects(i, nearest);
      for (std::uint32_t k = 0; k < problem_.half_spaces.size(); ++k)
        if (problem_.half_space_pairs[i * problem_.half_spaces.size() + k] != 0)
          considerHalfSpace(i, k, nearest);
    }
  }

 private:
  /// A node of the tree over objects with a lower bound of its distance.
  struct Entry
  {
    double lower;
    std::uint32_t node;
  };

  /// The second shape of a pair.
  struct ShapeWithPose
  {
    std::uint32_t tree;
    const Eigen::Isometry3d& pose;
  };

  /// Visits the tree over objects, the nearer child first. Skips nodes that are out of reach. The boxes of the tree and
  /// of the robot are grown by their padding. A grown box contains all points within the padding of its shape. So the
  /// distance of two grown boxes is at most the clearance of their pair.
  template <class Nearest>
  void visitObjects(std::uint32_t instance, Nearest& nearest)
  {
    if (objects_.nodes().empty())
      return;
    const double padding = problem_.robot[instance].padding;
    const Eigen::AlignedBox3d grown(bounds_[instance].min().array() - padding,
                                    bounds_[instance].max().array() + padding);
    const auto lower = [&](std::uint32_t node)
    { return distanceBounds(grown, boundsOf(objects_.nodes()[node])).lower; };
    stack_.assign(1, {lower(0), 0u});
    while (!stack_.empty())
    {
      const auto [bound, index] = stack_.back();
      stack_.pop_back();
      if (isOutOfReach(bound, nearest.reach(problem_.robot[instance].body)))
        continue;
      const Node& node = objects_.nodes()[index];
      if (node.count != 0)
      {
        considerObject(instance, objects_.order()[node.first], nearest);
        continue;
      }
      Entry near{lower(node.first), node.first};
      Entry far{lower(node.first + 1), node.first + 1};
      if (far.lower < near.lower)
        std::swap(near, far);
      stack_.push_back(far);
      stack_.push_back(near);
    }
  }

  template <class Nearest>
  void considerObject(std::uint32_t instance, std::uint32_t object, Nearest& nearest)
  {
    if (problem_.world_pairs[instance * problem_.world.size() + object] == 0)
      return;
    const ShapeInstance& b = problem_.world[object];
    const InstancePair pair = {instance, static_cast<std::uint32_t>(problem_.robot.size()) + object};
    consider(distanceBounds(bounds_[instance], world_bounds_[object]), requiredDistance(problem_, pair), b.body, pair,
             ShapeWithPose{b.tree, b.pose}, nearest);
  }

  template <class Nearest>
  void considerHalfSpace(std::uint32_t instance, std::uint32_t index, Nearest& nearest)
  {
    const WorldHalfSpace& half_space = problem_.half_spaces[index];
    const auto first = static_cast<std::uint32_t>(problem_.robot.size() + problem_.world.size());
    const double center = half_space.normal.dot(bounds_[instance].center()) - half_space.offset;
    const double reach = 0.5 * half_space.normal.cwiseAbs().dot(bounds_[instance].sizes()) + DistanceBounds::kMargin;
    const InstancePair pair = {instance, first + index};
    consider({center - reach, center + reach}, requiredDistance(problem_, pair), half_space.body, pair,
             PlacedHalfSpace{half_space.normal, half_space.offset}, nearest);
  }

  /// `other`: the second shape; `body` is its body.
  template <class Other, class Nearest>
  void consider(const DistanceBounds& bounds, double required, std::int32_t body, const InstancePair& pair,
                const Other& other, Nearest& nearest)
  {
    NearBodies found;
    found.bodies = {problem_.robot[pair[0]].body, body};
    const double reach = nearest.reach(found.bodies);
    if (isOutOfReach(bounds.lower - required, reach))
      return;
    found.collides = bounds.lower <= required && collidesWith(other, pair[0], required);
    if (found.collides)
      found.clearance = 0.0;
    else if (reach > 0.0)
      approach(other, pair[0], required, std::min(reach, std::max(0.0, bounds.upper - required)), found);
    if (found.order() < reach)
      nearest.take(found);
  }

  /// Whether a pair with this lower bound of its clearance cannot be below the reach. A pair whose boxes overlap may
  /// collide, which is nearer than any clearance.
  static bool isOutOfReach(double lower, double reach) { return lower > 0.0 ? lower >= reach : reach < 0.0; }

  bool collidesWith(const ShapeWithPose& other, std::uint32_t instance, double required)
  {
    return pair_.collide(problem_.robot[instance].tree, poses_[instance], other.tree, other.pose, required, scratch_);
  }

  bool collidesWith(const PlacedHalfSpace& other, std::uint32_t instance, double required)
  {
    return pair_.collide(problem_.robot[instance].tree, poses_[instance], other, required, scratch_);
  }

  ContactShape shapeOf(std::uint32_t tree, const Eigen::Isometry3d& pose) const
  {
    return {&forest_.tree(tree), pose, convex_.isConvex(tree)};
  }

  /// Sets the clearance and the points of a pair that does not collide; the clearance is `most` if it is not below it.
  void approach(const ShapeWithPose& other, std::uint32_t instance, double required, double most, NearBodies& found)
  {
    const ContactShape a = shapeOf(problem_.robot[instance].tree, poses_[instance]);
    const ContactShape b = shapeOf(other.tree, other.pose);
    if (hasExactSeparation(a, b))
    {
      const ConvexSeparation hulls = hullSeparation(a, b);
      found.clearance = std::clamp(-hulls.depth - required, 0.0, most);
      found.points = {hulls.on_a, hulls.on_b};
      return;
    }
    const PairClearance nearest = pairClearance(*a.tree, a.pose, *b.tree, b.pose, required, most, scratch_);
    found.clearance = nearest.clearance;
    if (nearest.parts)
      found.points = nearestPointsOf(a, b, *nearest.parts);
  }

  void approach(const PlacedHalfSpace& other, std::uint32_t instance, double required, double most, NearBodies& found)
  {
    const auto within = [&](double distance) { return collidesWith(other, instance, required + distance); };
    found.clearance = within(most) ? bisectLeast(0.0, most, within) : most;
    const ContactShape a = shapeOf(problem_.robot[instance].tree, poses_[instance]);
    const Eigen::Vector3d point = contactWithHalfSpace(a, other, 0.0).point;
    found.points = {point, point - (other.normal.dot(point) - other.offset) * other.normal};
  }

  const CollisionProblem& problem_;
  const CpuForest& forest_;
  CpuShapePair pair_;
  const ObjectTree& objects_;
  const ConvexTrees& convex_;
  const std::vector<Eigen::AlignedBox3d>& world_bounds_;
  std::vector<Eigen::Isometry3d> poses_;  // of the robot's instances, in the planning frame
  std::vector<Eigen::AlignedBox3d> bounds_;
  std::vector<Entry> stack_;
  CpuShapePair::Scratch scratch_;
};
}  // namespace gpu_planning_scene::core
