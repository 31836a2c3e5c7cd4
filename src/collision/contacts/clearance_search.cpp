#include "collision/contacts/clearance_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "collision/exact/cpu_shape_pair.h"
#include "collision/exact/exact_checker.h"
#include "collision/exact/pair_clearance.h"

// Branch and bound with bounding boxes: a pair is tested only if its boxes may be nearer than the best clearance so
// far. The nearer pairs come first. pair_clearance.cpp does the same within a pair (Larsen, Gottschalk, Lin and
// Manocha, "Fast Distance Queries with Rectangular Swept Sphere Volumes", 2000).
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

// Distance bounds are widened by this margin, which exceeds their rounding error.
constexpr double kDistanceMargin = 1e-9;  // metres

struct NearestFound
{
  double clearance = std::numeric_limits<double>::infinity();
  BodyPair bodies = kNoPair;
  InstancePair instances = {};

  /// Updates the result with a pair whose clearance lies between `lower` and `upper`. `collides` returns whether the
  /// pair collides. `clearance_of(x)` returns the pair's clearance if it is below x, otherwise x. Neither is called if
  /// `lower` is not below the best clearance so far, as for most pairs.
  template <class Collides, class ClearanceOf>
  void consider(double lower, double upper, const BodyPair& pair, const InstancePair& shapes, const Collides& collides,
                const ClearanceOf& clearance_of)
  {
    if (std::max(0.0, lower) >= clearance)
      return;
    const bool is_first = !std::isfinite(clearance);
    const double most = is_first ? std::max(0.0, upper) : clearance;
    const double found = lower <= 0.0 && collides() ? 0.0 : clearance_of(most);
    if (!is_first && found >= clearance)
      return;
    clearance = found;
    bodies = {std::min(pair[0], pair[1]), std::max(pair[0], pair[1])};
    instances = shapes;
  }
};

/// Lower bound of the distance between the contents of two boxes.
double leastDistance(const AlignedBox3d& a, const AlignedBox3d& b)
{
  return a.exteriorDistance(b) - kDistanceMargin;
}

/// Upper bound of the distance between the contents of two boxes.
double maxDistance(const AlignedBox3d& a, const AlignedBox3d& b)
{
  return (a.max() - b.min()).cwiseAbs().cwiseMax((b.max() - a.min()).cwiseAbs()).norm() + kDistanceMargin;
}

/// The search for one state.
class Search
{
 public:
  Search(const CollisionProblem& problem, std::shared_ptr<const CpuForest> forest, const ObjectTree& objects,
         const std::vector<AlignedBox3d>& world_bounds, const Isometry3d* link_poses)
    : problem_(problem), forest_(std::move(forest)), pair_(forest_), objects_(objects), world_bounds_(world_bounds)
  {
    for (const ShapeInstance& instance : problem.robot)
    {
      poses_.push_back(link_poses[instance.link] * instance.pose);
      bounds_.push_back(boundsOf(forest_->tree(instance.tree), poses_.back()));
    }
  }

  NearestFound self()
  {
    struct Candidate
    {
      double lower;
      InstancePair pair;
    };
    std::vector<Candidate> candidates;
    for (const auto& pair : problem_.self_pairs)
      candidates.push_back({leastDistance(bounds_[pair[0]], bounds_[pair[1]]), pair});
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.lower < b.lower; });
    NearestFound nearest;
    for (const auto& [lower, pair] : candidates)
    {
      const auto [i, j] = pair;
      const ShapeInstance& a = problem_.robot[i];
      const ShapeInstance& b = problem_.robot[j];
      nearest.consider(
          lower, maxDistance(bounds_[i], bounds_[j]), {a.body, b.body}, pair,
          [&, i = i, j = j] { return pair_.collide(a.tree, poses_[i], b.tree, poses_[j], 0.0, scratch_); },
          [&, i = i, j = j](double most) {
            return pairClearance(forest_->tree(a.tree), poses_[i], forest_->tree(b.tree), poses_[j], 0.0, most,
                                 scratch_);
          });
    }
    return nearest;
  }

  NearestFound world()
  {
    NearestFound nearest;
    for (std::uint32_t i = 0; i < problem_.robot.size(); ++i)
    {
      considerObjects(i, nearest);
      for (std::uint32_t k = 0; k < problem_.half_spaces.size(); ++k)
        if (problem_.half_space_pairs[i * problem_.half_spaces.size() + k] != 0)
          considerHalfSpace(i, k, nearest);
    }
    return nearest;
  }

 private:
  /// Visits the tree over objects, the nearer child first. Skips nodes that are not nearer than the best clearance so
  /// far. The boxes of the tree and of the robot are grown by their padding. A grown box contains all points within the
  /// padding of its shape. So the distance of two grown boxes is at most the clearance of their pair.
  void considerObjects(std::uint32_t instance, NearestFound& nearest)
  {
    if (objects_.nodes().empty())
      return;
    const double padding = problem_.robot[instance].padding;
    const AlignedBox3d grown(bounds_[instance].min().array() - padding, bounds_[instance].max().array() + padding);
    const auto lower = [&](std::uint32_t node) { return leastDistance(grown, boundsOf(objects_.nodes()[node])); };
    stack_.assign(1, {lower(0), 0u});
    while (!stack_.empty())
    {
      const auto [bound, index] = stack_.back();
      stack_.pop_back();
      if (bound >= nearest.clearance)
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

  void considerObject(std::uint32_t instance, std::uint32_t object, NearestFound& nearest)
  {
    if (problem_.world_pairs[instance * problem_.world.size() + object] == 0)
      return;
    const ShapeInstance& a = problem_.robot[instance];
    const ShapeInstance& b = problem_.world[object];
    const InstancePair pair = {instance, static_cast<std::uint32_t>(problem_.robot.size()) + object};
    const double required = requiredDistance(problem_, pair);
    nearest.consider(
        leastDistance(bounds_[instance], world_bounds_[object]) - required,
        maxDistance(bounds_[instance], world_bounds_[object]) - required, {a.body, b.body}, pair,
        [&] { return pair_.collide(a.tree, poses_[instance], b.tree, b.pose, required, scratch_); },
        [&](double most)
        {
          return pairClearance(forest_->tree(a.tree), poses_[instance], forest_->tree(b.tree), b.pose, required, most,
                               scratch_);
        });
  }

  void considerHalfSpace(std::uint32_t instance, std::uint32_t index, NearestFound& nearest)
  {
    const WorldHalfSpace& half_space = problem_.half_spaces[index];
    const auto first = static_cast<std::uint32_t>(problem_.robot.size() + problem_.world.size());
    const ShapeInstance& a = problem_.robot[instance];
    const InstancePair pair = {instance, first + index};
    const double required = requiredDistance(problem_, pair);
    const double center = half_space.normal.dot(bounds_[instance].center()) - half_space.offset - required;
    const double reach = 0.5 * half_space.normal.cwiseAbs().dot(bounds_[instance].sizes()) + kDistanceMargin;
    const auto collides = [&](double distance)
    {
      return pair_.collide(a.tree, poses_[instance], {half_space.normal, half_space.offset}, required + distance,
                           scratch_);
    };
    nearest.consider(
        center - reach, center + reach, {a.body, half_space.body}, pair, [&] { return collides(0.0); },
        [&](double most) { return collides(most) ? bisectLeast(0.0, most, collides) : most; });
  }

  struct Entry
  {
    double lower;
    std::uint32_t node;
  };

  const CollisionProblem& problem_;
  std::shared_ptr<const CpuForest> forest_;
  CpuShapePair pair_;
  const ObjectTree& objects_;
  const std::vector<AlignedBox3d>& world_bounds_;
  std::vector<Isometry3d> poses_;  // poses of the robot's instances, in the planning frame
  std::vector<AlignedBox3d> bounds_;
  std::vector<Entry> stack_;
  CpuShapePair::Scratch scratch_;
};
}  // namespace

ClearanceSearch::ClearanceSearch(std::shared_ptr<const CollisionProblem> problem,
                                 std::shared_ptr<const CpuForest> forest, std::shared_ptr<const ObjectTree> objects)
  : problem_(std::move(problem)), forest_(std::move(forest)), objects_(std::move(objects))
{
  world_bounds_.reserve(problem_->world.size());
  for (const ShapeInstance& instance : problem_->world)
    world_bounds_.push_back(boundsOf(forest_->tree(instance.tree), instance.pose));
}

NearestInstances ClearanceSearch::find(const Isometry3d* link_poses) const
{
  Search search(*problem_, forest_, *objects_, world_bounds_, link_poses);
  const NearestFound world = search.world();
  const NearestFound self = search.self();
  return {{world.clearance, self.clearance, world.bodies, self.bodies}, world.instances, self.instances};
}
}  // namespace gpu_planning_scene::core
