#include "support/fcl_peer.h"

#include <algorithm>
#include <cassert>  // FCL 0.7 uses assert without it
#include <chrono>
#include <limits>

#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include "base/seconds_since.h"
#include "gpu_planning_scene/error.h"
#include "support/fcl_broad_phase.h"
#include "support/inside.h"
#include "support/learned_order.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kNudge = 1e-6;  // metres

/// FCL would solve a different problem, so a comparison would mean nothing.
void refuseUnsupported(const CollisionProblem& problem, FclTree kind)
{
  if (!problem.half_spaces.empty())
    throw Error("the FCL peer does not support half-spaces; use a scene without half-spaces");
  const auto is_padded = [](const ShapeInstance& instance) { return instance.padding > 0.0; };
  if (kind != FclTree::Obbrss && kind != FclTree::Kios &&
      (std::any_of(problem.robot.begin(), problem.robot.end(), is_padded) ||
       std::any_of(problem.world.begin(), problem.world.end(), is_padded)))
    throw Error("FCL finds distances with trees of OBBRSS and kIOS only; compare with a scene without padding");
}
}  // namespace

struct FclPeer::Impl
{
  /// An instance of a shape with its place in the planning frame.
  struct Placed
  {
    std::int32_t body;
    std::uint32_t tree;
    Isometry3d pose;
    AlignedBox3d bounds;
    double padding;
    std::shared_ptr<FclMovedTree> moved;  // for trees that are fitted anew to each pose
  };

  std::shared_ptr<const CollisionProblem> problem;
  FclTree volumes = FclTree::Obbrss;
  std::vector<FclGeometry> geometries;  // one per tree
  std::vector<Placed> robot;
  std::vector<Placed> world;
  std::optional<LearnedOrder> order;           // empty: fixed order
  std::shared_ptr<FclBroadPhase> broad_phase;  // of the world, if the order is learned

  AlignedBox3d boundsOf(std::uint32_t tree, const Isometry3d& pose) const
  {
    const auto& local = geometries[tree]->aabb_local;
    const Vector3d center = pose * local.center();
    const Vector3d half = pose.linear().cwiseAbs() * (0.5 * (local.max_ - local.min_));
    return {center - half, center + half};
  }

  bool hit(const Placed& a, const Placed& b, const Vector3d& shift_of_b = Vector3d::Zero()) const
  {
    Isometry3d pose_b = b.pose;
    pose_b.pretranslate(shift_of_b);
    const fcl::CollisionRequestd request(1, true);
    fcl::CollisionResultd result;
    const auto* model_a = a.moved ? a.moved->at(a.pose) : geometries[a.tree].get();
    const auto* model_b = b.moved ? b.moved->at(pose_b) : geometries[b.tree].get();
    return fcl::collide(model_a, a.moved ? Isometry3d::Identity() : a.pose, model_b,
                        b.moved ? Isometry3d::Identity() : pose_b, request, result) > 0;
  }

  /// FCL stops early when the distance is at least `limit`. The result is then at least `limit`.
  double distance(const Placed& a, const Placed& b, double limit = std::numeric_limits<double>::max()) const
  {
    const fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    result.min_distance = limit;
    return fcl::distance(geometries[a.tree].get(), a.pose, geometries[b.tree].get(), b.pose, request, result);
  }

  static bool boxesAreNear(const Placed& a, const Placed& b, double required)
  {
    return a.bounds.squaredExteriorDistance(b.bounds) <= required * required;
  }

  bool meet(const Placed& a, const Placed& b, double required) const
  {
    if (required == 0.0)
      return hit(a, b);
    return distance(a, b, required * (1.0 + 1e-9)) <= required;
  }

  /// Tests the bounding boxes of a pair, then the pair. `padded`: whether paddings count.
  bool collide(const Placed& a, const Placed& b, bool padded) const
  {
    const double required = padded ? a.padding + b.padding : 0.0;
    return boxesAreNear(a, b, required) && meet(a, b, required);
  }

  /// As collide(). Adds FCL's time to `seconds`; reading the clock takes much less time than FCL.
  bool collideTimed(const Placed& a, const Placed& b, double required, double& seconds) const
  {
    if (!boxesAreNear(a, b, required))
      return false;
    const auto start = std::chrono::steady_clock::now();
    const bool result = meet(a, b, required);
    seconds += secondsSince(start);
    return result;
  }

  /// One check, numbered as in ExactChecker: a number below robot.size() is a robot instance that is checked against
  /// the world. Larger numbers are self pairs.
  bool check(std::uint32_t number, double margin, double& seconds, std::optional<BodyPair>& found) const
  {
    if (number >= robot.size())
    {
      const auto [first, second] = problem->self_pairs[number - robot.size()];
      if (collideTimed(robot[first], robot[second], margin, seconds))
        found = BodyPair{robot[first].body, robot[second].body};
      return found.has_value();
    }
    const Placed& link = robot[number];
    const double padding = link.padding + margin;
    const Vector3d grown = Vector3d::Constant(padding);
    for (const std::uint32_t k : broad_phase->near({link.bounds.min() - grown, link.bounds.max() + grown}))
      if (problem->world_pairs[number * world.size() + k] != 0 &&
          collideTimed(link, world[k], padding + world[k].padding, seconds))
      {
        found = BodyPair{link.body, world[k].body};
        return true;
      }
    return false;
  }

  /// `margins`: as for ExactChecker; null if there are none.
  std::optional<BodyPair> firstInLearnedOrder(const double* margins)
  {
    std::optional<BodyPair> found;
    order->any([&](std::uint32_t number, double& seconds)
               { return check(number, margins ? margins[number] : 0.0, seconds, found); });
    return found;
  }

  /// Makes a copy of the data that queries change. Each peer needs its own.
  void copyMutableState()
  {
    if (order)
    {
      std::vector<AlignedBox3d> boxes;
      for (const Placed& placed : world)
      {
        const Vector3d grown = Vector3d::Constant(placed.padding);
        boxes.emplace_back(placed.bounds.min() - grown, placed.bounds.max() + grown);
      }
      broad_phase = std::make_shared<FclBroadPhase>(boxes);
    }
    for (std::vector<Placed>* all : {&robot, &world})
      for (Placed& placed : *all)
        placed.moved = makeFclMovedTree(problem->shapes[placed.tree], problem->tessellations[placed.tree], volumes);
  }

  /// Calls visit(a, b, whether the pair is padded) for the checked pairs of instances until it returns true.
  template <class Visit>
  void visitPairs(const Visit& visit) const
  {
    for (std::size_t i = 0; i < robot.size(); ++i)
    {
      for (std::size_t k = 0; k < world.size(); ++k)
        if (problem->world_pairs[i * world.size() + k] != 0 && visit(robot[i], world[k], true))
          return;
    }
    for (const auto& [first, second] : problem->self_pairs)
      if (visit(robot[first], robot[second], false))
        return;
  }

  /// As visitPairs() for the checked pairs of instances of two bodies, without an early end.
  template <class Visit>
  void visitPairsOf(const BodyPair& pair, const Visit& visit) const
  {
    visitPairs(
        [&](const Placed& a, const Placed& b, bool padded)
        {
          if (BodyPair{a.body, b.body} == pair || BodyPair{b.body, a.body} == pair)
            visit(a, b, padded);
          return false;
        });
  }
};

FclPeer::FclPeer(std::shared_ptr<const CollisionProblem> problem, FclTree tree, FclOrder order)
  : impl_(std::make_unique<Impl>())
{
  refuseUnsupported(*problem, tree);
  impl_->problem = std::move(problem);
  impl_->volumes = tree;
  const CollisionProblem& p = *impl_->problem;
  for (std::size_t i = 0; i < p.tessellations.size(); ++i)
    impl_->geometries.push_back(makeFclGeometry(p.shapes[i], p.tessellations[i], tree));
  for (const ShapeInstance& instance : p.robot)
    impl_->robot.push_back({instance.body, instance.tree, instance.pose, {}, instance.padding, nullptr});
  for (const ShapeInstance& instance : p.world)
  {
    impl_->world.push_back({instance.body, instance.tree, instance.pose, impl_->boundsOf(instance.tree, instance.pose),
                            instance.padding, nullptr});
  }
  if (order == FclOrder::Learned)
    impl_->order.emplace(p.robot.size() + p.self_pairs.size());
  impl_->copyMutableState();
}

FclPeer::FclPeer(const FclPeer& other) : impl_(std::make_unique<Impl>(*other.impl_))
{
  impl_->copyMutableState();
}

FclPeer::~FclPeer() = default;

void FclPeer::setState(const Isometry3d* link_poses)
{
  for (std::size_t i = 0; i < impl_->robot.size(); ++i)
  {
    Impl::Placed& placed = impl_->robot[i];
    const ShapeInstance& instance = impl_->problem->robot[i];
    placed.pose = link_poses[instance.link] * instance.pose;
    placed.bounds = impl_->boundsOf(placed.tree, placed.pose);
  }
}

std::optional<BodyPair> FclPeer::firstCollision()
{
  if (impl_->order)
    return impl_->firstInLearnedOrder(nullptr);
  std::optional<BodyPair> found;
  impl_->visitPairs(
      [&](const Impl::Placed& a, const Impl::Placed& b, bool padded)
      {
        if (impl_->collide(a, b, padded))
          found = BodyPair{a.body, b.body};
        return found.has_value();
      });
  return found;
}

std::optional<BodyPair> FclPeer::firstNear(const double* margins)
{
  return impl_->firstInLearnedOrder(margins);
}

std::vector<BodyPair> FclPeer::allCollisions() const
{
  std::vector<BodyPair> found;
  impl_->visitPairs(
      [&](const Impl::Placed& a, const Impl::Placed& b, bool padded)
      {
        if (impl_->collide(a, b, padded))
          found.push_back({a.body, b.body});
        return false;
      });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

bool FclPeer::collides(const BodyPair& pair) const
{
  bool hit = false;
  impl_->visitPairsOf(pair, [&](const Impl::Placed& a, const Impl::Placed& b, bool padded)
                      { hit = hit || impl_->collide(a, b, padded); });
  return hit;
}

bool FclPeer::freeWhenMovedApart(const BodyPair& pair) const
{
  Vector3d between = Vector3d::UnitX();
  impl_->visitPairsOf(pair, [&](const Impl::Placed& a, const Impl::Placed& b, bool /*padded*/)
                      { between = (b.bounds.center() - a.bounds.center()).normalized(); });
  const std::array<Vector3d, 7> directions = {between,           Vector3d::UnitX(),  -Vector3d::UnitX(),
                                              Vector3d::UnitY(), -Vector3d::UnitY(), Vector3d::UnitZ(),
                                              -Vector3d::UnitZ()};
  return std::any_of(directions.begin(), directions.end(),
                     [&](const Vector3d& direction)
                     {
                       bool hit = false;
                       impl_->visitPairsOf(pair, [&](const Impl::Placed& a, const Impl::Placed& b, bool /*padded*/)
                                           { hit = hit || impl_->hit(a, b, kNudge * direction); });
                       return !hit;
                     });
}

bool FclPeer::within(const BodyPair& pair, double distance) const
{
  bool found = false;
  impl_->visitPairsOf(pair, [&](const Impl::Placed& a, const Impl::Placed& b, bool /*padded*/)
                      { found = found || impl_->distance(a, b) <= distance; });
  return found;
}

double FclPeer::clearance(double limit) const
{
  impl_->visitPairs(
      [&](const Impl::Placed& a, const Impl::Placed& b, bool padded)
      {
        const double required = padded ? a.padding + b.padding : 0.0;
        if (a.bounds.exteriorDistance(b.bounds) < limit + required)
          limit = std::min(limit, impl_->distance(a, b, limit + required) - required);
        return false;
      });
  return limit;
}

std::map<BodyPair, double> FclPeer::distances() const
{
  std::map<BodyPair, double> found;
  impl_->visitPairs(
      [&](const Impl::Placed& a, const Impl::Placed& b, bool padded)
      {
        const double distance = impl_->distance(a, b) - (padded ? a.padding + b.padding : 0.0);
        const auto known = found.emplace(BodyPair{std::min(a.body, b.body), std::max(a.body, b.body)}, distance).first;
        known->second = std::min(known->second, distance);
        return false;
      });
  return found;
}

bool FclPeer::oneInsideTheOther(const BodyPair& pair) const
{
  bool found = false;
  impl_->visitPairsOf(pair,
                      [&](const Impl::Placed& a, const Impl::Placed& b, bool /*padded*/)
                      {
                        const auto& shapes = impl_->problem->shapes;
                        const auto& trees = impl_->problem->tessellations;
                        const Isometry3d b_in_a = a.pose.inverse() * b.pose;
                        found = found || hasVertexInside(*trees[b.tree].mesh, b_in_a, shapes[a.tree]) ||
                                hasVertexInside(*trees[a.tree].mesh, b_in_a.inverse(), shapes[b.tree]);
                      });
  return found;
}
}  // namespace gpu_planning_scene::core
