#include "gpu_planning_scene/state_inspector.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include "base/parallel_for.h"
#include "collision/bounds/problem_maker.h"
#include "collision/contacts/body_contacts.h"
#include "collision/contacts/body_pairs.h"
#include "collision/contacts/clearance_search.h"
#include "collision/exact/exact_checker.h"
#include "collision/exact/forest_cache.h"
#include "collision/problem/state_validation.h"

// The exact checker finds the colliding pairs of instances. They are grouped by their bodies, because a contact
// separates whole bodies. Own method.
namespace gpu_planning_scene::core
{
namespace
{
// If several contact points of a pair are within this distance of each other, only the deepest is reported.
constexpr double kSamePoint = 1e-6;  // metres

/// Trees of shapes. Scenes that have the same shapes share them.
struct Models
{
  /// See isConvexSolid. The answer for a mesh is kept.
  bool isConvex(const std::shared_ptr<const CpuTree>& tree)
  {
    if (!tree->mesh)
      return true;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      const auto known = convex.find(tree);
      if (known != convex.end())
        return known->second;
    }
    const bool is_convex = isConvexSolid(*tree);
    const std::lock_guard<std::mutex> lock(mutex);
    return convex[tree] = is_convex;
  }

  void forgetUnused()
  {
    for (auto entry = convex.begin(); entry != convex.end();)
      entry = entry->first.expired() ? convex.erase(entry) : std::next(entry);
  }

  std::mutex mutex;  // guards all members below
  ProblemMaker maker{optionsWithAllPairs()};
  ForestCache forests;
  std::map<std::weak_ptr<const CpuTree>, bool, std::owner_less<>> convex;
};

/// The prepared data of one group.
struct Inspected
{
  std::shared_ptr<const CollisionProblem> problem;
  std::shared_ptr<const CpuForest> forest;
  std::unique_ptr<const ExactChecker> exact;
  std::unique_ptr<const ClearanceSearch> clearance;
  std::unique_ptr<const BodyPairs> pairs;
};

/// Finds points that are nearer to each other than kSamePoint. Two such points are in the same cell of a grid or in
/// adjacent cells.
class NearPoints
{
 public:
  /// Adds the point unless another point is near. Returns whether it was added.
  bool add(const Eigen::Vector3d& point)
  {
    const Cell center = {{cellOf(point.x()), cellOf(point.y()), cellOf(point.z())}};
    for (int i = 0; i < 27; ++i)
    {
      const auto found = cells_.find({{center[0] + i % 3 - 1, center[1] + i / 3 % 3 - 1, center[2] + i / 9 - 1}});
      if (found == cells_.end())
        continue;
      for (const Eigen::Vector3d& other : found->second)
        if ((other - point).norm() < kSamePoint)
          return false;
    }
    cells_[center].push_back(point);
    return true;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  /// Coordinates beyond a bound share one cell, because the resolution of double is coarser than kSamePoint there.
  static std::int64_t cellOf(double coordinate)
  {
    constexpr double kFarthest = 1e18;
    return static_cast<std::int64_t>(std::clamp(std::floor(coordinate / kSamePoint), -kFarthest, kFarthest));
  }

  std::map<Cell, std::vector<Eigen::Vector3d>> cells_;
};

bool isDeeper(const Contact& a, const Contact& b)
{
  return a.depth > b.depth;
}

/// At most `most` contacts, the deepest first. Of contacts at the same place only the deepest is kept.
std::vector<Contact> deepest(std::vector<Contact> contacts, std::size_t most)
{
  std::stable_sort(contacts.begin(), contacts.end(), isDeeper);
  NearPoints points;
  std::vector<Contact> kept;
  for (const Contact& contact : contacts)
  {
    if (kept.size() == most)
      break;
    if (points.add(contact.point))
      kept.push_back(contact);
  }
  return kept;
}

/// The colliding pairs of instances of two bodies.
struct CollidingBodies
{
  std::vector<InstancePair> shapes;
  std::vector<InstancePair> half_spaces;  // the second index counts the half-spaces
};
}  // namespace

struct StateInspector::Impl
{
  Impl(std::shared_ptr<const PlanningScene> the_scene, std::shared_ptr<Models> the_models)
    : scene(std::move(the_scene)), models(std::move(the_models))
  {
  }

  const Inspected& inspected(const std::string& group);
  std::vector<Eigen::Isometry3d> linkPoses(const double* state) const;
  ContactShape shapeOf(const Inspected& group, std::size_t instance, const std::vector<Eigen::Isometry3d>& link_poses);
  std::vector<Contact> contactsOfBodies(const Inspected& group, const BodyPair& bodies,
                                        const CollidingBodies& colliding,
                                        const std::vector<Eigen::Isometry3d>& link_poses, std::size_t most);
  std::vector<ShapeContact> contactsOfShapes(const Inspected& group, const BodyPair& bodies,
                                             const std::vector<InstancePair>& colliding,
                                             const std::vector<Eigen::Isometry3d>& link_poses, std::size_t most);
  std::array<Eigen::Vector3d, 2> nearestPoints(const Inspected& group, const InstancePair& pair, const BodyPair& bodies,
                                               double clearance, const std::vector<Eigen::Isometry3d>& link_poses);

  const std::shared_ptr<const PlanningScene> scene;
  const std::shared_ptr<Models> models;
  std::map<std::string, Inspected> groups;  // guarded by the mutex of `models`; entries are never removed
};

const Inspected& StateInspector::Impl::inspected(const std::string& group)
{
  const std::lock_guard<std::mutex> lock(models->mutex);
  const auto known = groups.find(group);
  if (known != groups.end())
    return known->second;
  Inspected made;
  made.problem = std::make_shared<const CollisionProblem>(models->maker.make(*scene, group, nullptr));
  made.exact = models->forests.exactCheckerOf(made.problem);
  made.forest = models->forests.forest();
  made.clearance = std::make_unique<const ClearanceSearch>(made.problem, made.forest, models->forests.objects());
  made.pairs = std::make_unique<const BodyPairs>(*made.problem);
  return groups.emplace(group, std::move(made)).first->second;
}

std::vector<Eigen::Isometry3d> StateInspector::Impl::linkPoses(const double* state) const
{
  validateStates(*scene->robot, state, 1);
  std::vector<Eigen::Isometry3d> poses(scene->robot->links().size());
  scene->robot->linkPoses(state, poses.data());
  return poses;
}

/// The index counts the instances of the robot, then those of the world.
ContactShape StateInspector::Impl::shapeOf(const Inspected& group, std::size_t instance,
                                           const std::vector<Eigen::Isometry3d>& link_poses)
{
  const CollisionProblem& problem = *group.problem;
  const bool is_robot = instance < problem.robot.size();
  const ShapeInstance& shape = is_robot ? problem.robot[instance] : problem.world[instance - problem.robot.size()];
  const Eigen::Isometry3d pose = is_robot ? link_poses[static_cast<std::size_t>(shape.link)] * shape.pose : shape.pose;
  return {&group.forest->tree(shape.tree), pose, models->isConvex(group.forest->shared(shape.tree))};
}

std::vector<ShapeContact> StateInspector::Impl::contactsOfShapes(const Inspected& group, const BodyPair& bodies,
                                                                 const std::vector<InstancePair>& colliding,
                                                                 const std::vector<Eigen::Isometry3d>& link_poses,
                                                                 std::size_t most)
{
  const CollisionProblem& problem = *group.problem;
  const CpuShapePair exact(group.forest);
  CpuShapePair::Scratch scratch;
  double reach = 0.0;  // the diagonal of the first body
  for (const InstancePair& pair : colliding)
    reach += 2.0 * group.forest->tree(problem.robot[pair[0]].tree).half.norm();
  while (true)
  {
    std::vector<ContactPair> pairs;
    std::vector<std::size_t> numbers;
    group.pairs->visit(
        problem, bodies,
        [&](const InstancePair& pair)
        {
          ContactPair found = {shapeOf(group, pair[0], link_poses), shapeOf(group, pair[1], link_poses),
                               requiredDistance(problem, pair)};
          const double distance =
              boundsOf(*found.a.tree, found.a.pose).exteriorDistance(boundsOf(*found.b.tree, found.b.pose));
          if (distance > reach + found.required)
            return;
          if (bodyOf(problem, pair[0]) != bodies[0])
            std::swap(found.a, found.b);
          if (std::find(colliding.begin(), colliding.end(), pair) != colliding.end())
            numbers.push_back(pairs.size());
          pairs.push_back(found);
        });
    std::vector<ShapeContact> contacts = contactsOf(pairs, numbers, exact, scratch, most);
    // Shapes that were left out are farther away than the translation.
    if (contacts.front().depth < reach || std::isinf(reach))
      return contacts;
    reach = std::numeric_limits<double>::infinity();
  }
}

std::vector<Contact> StateInspector::Impl::contactsOfBodies(const Inspected& group, const BodyPair& bodies,
                                                            const CollidingBodies& colliding,
                                                            const std::vector<Eigen::Isometry3d>& link_poses,
                                                            std::size_t most)
{
  const CollisionProblem& problem = *group.problem;
  std::vector<Contact> contacts;
  if (!colliding.shapes.empty())
    for (const ShapeContact& found : contactsOfShapes(group, bodies, colliding.shapes, link_poses, most))
      contacts.push_back({bodies, found.point, found.normal, found.depth});
  for (const auto& [instance, number] : colliding.half_spaces)
  {
    const WorldHalfSpace& half_space = problem.half_spaces[number];
    const ShapeContact found =
        contactWithHalfSpace(shapeOf(group, instance, link_poses), {half_space.normal, half_space.offset},
                             problem.robot[instance].padding + half_space.padding);
    const bool swapped = problem.robot[instance].body != bodies[0];
    contacts.push_back({bodies, found.point, swapped ? Eigen::Vector3d(-found.normal) : found.normal, found.depth});
  }
  return deepest(std::move(contacts), most);
}

/// The points in the order of `bodies`.
std::array<Eigen::Vector3d, 2> StateInspector::Impl::nearestPoints(const Inspected& group, const InstancePair& pair,
                                                                   const BodyPair& bodies, double clearance,
                                                                   const std::vector<Eigen::Isometry3d>& link_poses)
{
  const CollisionProblem& problem = *group.problem;
  const std::size_t robots = problem.robot.size();
  const ContactShape a = shapeOf(group, pair[0], link_poses);
  std::array<Eigen::Vector3d, 2> points;
  if (pair[1] >= robots + problem.world.size())
  {
    const WorldHalfSpace& b = problem.half_spaces[pair[1] - robots - problem.world.size()];
    points[0] = contactWithHalfSpace(a, {b.normal, b.offset}, 0.0).point;
    points[1] = points[0] - (b.normal.dot(points[0]) - b.offset) * b.normal;
  }
  else
  {
    points = nearestPointsOf(a, shapeOf(group, pair[1], link_poses), clearance + requiredDistance(problem, pair));
  }
  if (problem.robot[pair[0]].body != bodies[0])
    std::swap(points[0], points[1]);
  return points;
}

StateInspector::StateInspector(std::shared_ptr<const PlanningScene> scene, const StateInspector* previous)
{
  requireRobot(scene);
  impl_ = std::make_unique<Impl>(std::move(scene), previous ? previous->impl_->models : std::make_shared<Models>());
  impl_->inspected("");
  const std::lock_guard<std::mutex> lock(impl_->models->mutex);
  impl_->models->forgetUnused();
}

StateInspector::~StateInspector() = default;

const std::shared_ptr<const PlanningScene>& StateInspector::scene() const
{
  return impl_->scene;
}

std::vector<Contact> StateInspector::contacts(const double* state, const std::string& group, std::size_t max_contacts,
                                              std::size_t max_per_pair) const
{
  const Inspected& inspected = impl_->inspected(group);
  const std::vector<Eigen::Isometry3d> poses = impl_->linkPoses(state);
  if (max_contacts == 0)
    return {};
  ExactChecker::Scratch scratch;
  std::map<BodyPair, CollidingBodies> by_bodies;
  const CollisionProblem& problem = *inspected.problem;
  const std::size_t first_half_space = problem.robot.size() + problem.world.size();
  for (const InstancePair& pair : inspected.exact->collidingInstances(poses.data(), scratch))
  {
    CollidingBodies& colliding = by_bodies[bodiesOf(problem, pair)];
    if (pair[1] < first_half_space)
      colliding.shapes.push_back(pair);
    else
      colliding.half_spaces.push_back({pair[0], static_cast<std::uint32_t>(pair[1] - first_half_space)});
  }
  const std::size_t most = std::min({max_contacts, max_per_pair == 0 ? max_contacts : max_per_pair, kMaxOfPair});
  std::vector<Contact> firsts;
  std::vector<Contact> others;
  for (const auto& [bodies, colliding] : by_bodies)
  {
    const std::vector<Contact> found = impl_->contactsOfBodies(inspected, bodies, colliding, poses, most);
    firsts.push_back(found.front());
    others.insert(others.end(), found.begin() + 1, found.end());
  }
  std::stable_sort(firsts.begin(), firsts.end(), isDeeper);
  std::stable_sort(others.begin(), others.end(), isDeeper);
  firsts.insert(firsts.end(), others.begin(), others.end());
  firsts.resize(std::min(firsts.size(), max_contacts));
  return firsts;
}

Clearance StateInspector::clearance(const double* state, const std::string& group) const
{
  return clearances(state, 1, group).front();
}

std::vector<Clearance> StateInspector::clearances(const double* states, std::size_t count,
                                                  const std::string& group) const
{
  const Inspected& inspected = impl_->inspected(group);
  const RobotModel& robot = *impl_->scene->robot;
  validateStates(robot, states, count);
  std::vector<Clearance> found(count);
  parallelFor(count, 1,
              [&, poses = std::vector<Eigen::Isometry3d>(robot.links().size())](std::size_t i, std::size_t) mutable
              {
                robot.linkPoses(states + i * robot.variables().size(), poses.data());
                found[i] = inspected.clearance->find(poses.data()).clearance;
              });
  return found;
}

std::vector<NearestPairs> StateInspector::nearestPairs(const double* states, std::size_t count,
                                                       const std::string& group) const
{
  const Inspected& inspected = impl_->inspected(group);
  const PlanningScene& scene = *impl_->scene;
  const RobotModel& robot = *scene.robot;
  validateStates(robot, states, count);
  // Links and attached objects are the robot's bodies.
  const auto is_world = [first = static_cast<std::int32_t>(robot.links().size()),
                         count = static_cast<std::int32_t>(scene.objects.size())](std::int32_t body)
  { return body >= first && body < first + count; };
  std::vector<NearestPairs> found(count);
  parallelFor(count, 1,
              [&, poses = std::vector<Eigen::Isometry3d>(robot.links().size())](std::size_t i, std::size_t) mutable
              {
                const double* state = states + i * robot.variables().size();
                robot.linkPoses(state, poses.data());
                const NearestInstances nearest = inspected.clearance->find(poses.data());
                const auto fill =
                    [&](double clearance, const BodyPair& bodies, const InstancePair& pair, NearestPair& to)
                {
                  to.bodies = bodies;
                  to.distance = clearance;
                  if (bodies != kNoPair && clearance > 0.0)
                    to.points = impl_->nearestPoints(inspected, pair, bodies, clearance, poses);
                };
                NearestPairs& pairs = found[i];
                fill(nearest.clearance.world, nearest.clearance.nearest_world, nearest.world, pairs.world);
                fill(nearest.clearance.self, nearest.clearance.nearest_self, nearest.self, pairs.self);
                if (pairs.world.distance > 0.0 && pairs.self.distance > 0.0)
                  return;
                const auto take = [](const Contact& contact, NearestPair& to)
                {
                  if (to.distance != 0.0)
                    return;  // free, or already the deepest contact
                  to.bodies = contact.bodies;
                  to.distance = -std::max(0.0, contact.depth);
                  to.points = {contact.point, contact.point};
                };
                // The deepest contact of each pair comes first.
                for (const Contact& contact : contacts(state, group, std::numeric_limits<std::size_t>::max(), 1))
                  take(contact, is_world(contact.bodies[0]) || is_world(contact.bodies[1]) ? pairs.world : pairs.self);
              });
  return found;
}
}  // namespace gpu_planning_scene::core
