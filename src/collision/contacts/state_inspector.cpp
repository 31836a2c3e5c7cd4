#include "gpu_planning_scene/state_inspector.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include "collision/bounds/problem_maker.h"
#include "collision/contacts/clearance_search.h"
#include "collision/contacts/fcl_contacts.h"
#include "collision/exact/cpu_traversal.h"
#include "collision/exact/forest_cache.h"
#include "collision/parallel_for.h"
#include "collision/problem/state_validation.h"

// The exact checker finds the colliding pairs of instances. FCL computes their contacts. The deepest contacts of each
// pair of bodies are kept. Own method.
namespace gpu_planning_scene::core
{
namespace
{
// If several contact points of a pair are within this distance of each other, only the deepest is reported.
constexpr double kSamePoint = 1e-6;  // metres

/// Trees and FCL geometries of shapes. Scenes that have the same shapes share them.
struct Models
{
  FclGeometry modelOf(const CollisionProblem& problem, std::uint32_t tree)
  {
    FclGeometry& model = fcl[problem.tessellations[tree].mesh];
    if (!model)
      model = makeFclSolid(problem.shapes[tree], problem.tessellations[tree]);
    return model;
  }

  void forgetUnused()
  {
    for (FclModels* models : {&fcl, &triangles})
      for (auto entry = models->begin(); entry != models->end();)
        entry = entry->first.expired() ? models->erase(entry) : std::next(entry);
  }

  /// The triangles of a shape, for nearest points where FCL fails for the shape itself.
  FclGeometry trianglesOf(const CollisionProblem& problem, std::uint32_t tree)
  {
    FclGeometry& model = triangles[problem.tessellations[tree].mesh];
    if (!model)
      model = makeFclSolid(problem.tessellations[tree].mesh, problem.tessellations[tree]);
    return model;
  }

  std::mutex mutex;  // guards all members below
  ProblemMaker maker{optionsWithAllPairs()};
  ForestCache forests;
  // Key: tessellation; shared by equal shapes.
  using FclModels = std::map<std::weak_ptr<const Mesh>, FclGeometry, std::owner_less<>>;
  FclModels fcl;
  FclModels triangles;
};

/// The prepared data of one group.
struct Inspected
{
  std::shared_ptr<const CollisionProblem> problem;
  std::shared_ptr<const CpuForest> forest;
  std::unique_ptr<const CpuTraversal> traversal;
  std::unique_ptr<const ClearanceSearch> clearance;
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

/// At most `max_contacts` contacts, the deepest first. Of contacts at the same place only the deepest is kept.
std::vector<Contact> deepest(std::vector<Contact> contacts, std::size_t max_contacts)
{
  std::stable_sort(contacts.begin(), contacts.end(),
                   [](const Contact& a, const Contact& b) { return a.depth > b.depth; });
  NearPoints points;
  std::vector<Contact> kept;
  for (const Contact& contact : contacts)
  {
    if (kept.size() == max_contacts)
      break;
    if (points.add(contact.point))
      kept.push_back(contact);
  }
  return kept;
}
}  // namespace

struct StateInspector::Impl
{
  Impl(std::shared_ptr<const PlanningScene> the_scene, std::shared_ptr<Models> the_models)
    : scene(std::move(the_scene)), models(std::move(the_models))
  {
  }

  const Inspected& inspected(const std::string& group);
  std::vector<Eigen::Isometry3d> linkPoses(const double* state) const;
  void addContacts(const Inspected& group, const InstancePair& pair, const CpuTraversal::Scratch& placed,
                   CpuShapePair::Scratch& scratch, std::map<BodyPair, std::vector<Contact>>& contacts);
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
  made.traversal = models->forests.traversalOf(made.problem);
  made.forest = models->forests.forest();
  made.clearance = std::make_unique<const ClearanceSearch>(made.problem, made.forest, models->forests.objects());
  return groups.emplace(group, std::move(made)).first->second;
}

std::vector<Eigen::Isometry3d> StateInspector::Impl::linkPoses(const double* state) const
{
  validateStates(*scene->robot, state, 1);
  std::vector<Eigen::Isometry3d> poses(scene->robot->links().size());
  scene->robot->linkPoses(state, poses.data());
  return poses;
}

void StateInspector::Impl::addContacts(const Inspected& group, const InstancePair& pair,
                                       const CpuTraversal::Scratch& placed, CpuShapePair::Scratch& scratch,
                                       std::map<BodyPair, std::vector<Contact>>& contacts)
{
  const CollisionProblem& problem = *group.problem;
  const ShapeInstance& a = problem.robot[pair[0]];
  const Eigen::Isometry3d& pose = placed.poses[pair[0]];
  const std::size_t robots = problem.robot.size();
  std::vector<ShapeContact> found;
  if (pair[1] >= robots + problem.world.size())
  {
    const WorldHalfSpace& b = problem.half_spaces[pair[1] - robots - problem.world.size()];
    found.push_back(contactOf(pose, group.forest->tree(a.tree).shape, b, a.padding + b.padding));
  }
  else
  {
    const bool self = pair[1] < robots;
    const ShapeInstance& b = self ? problem.robot[pair[1]] : problem.world[pair[1] - robots];
    FclShape shape_a{a.tree, pose, nullptr};
    FclShape shape_b{b.tree, self ? placed.poses[pair[1]] : b.pose, nullptr};
    {
      const std::lock_guard<std::mutex> lock(models->mutex);
      shape_a.model = models->modelOf(problem, a.tree);
      shape_b.model = models->modelOf(problem, b.tree);
    }
    found = contactsOf(shape_a, shape_b, self ? 0.0 : a.padding + b.padding, *group.forest, CpuShapePair(group.forest),
                       scratch);
  }
  const std::int32_t first = a.body;
  const std::int32_t second = bodyOf(problem, pair[1]);
  for (const ShapeContact& contact : found)
  {
    const bool swapped = second < first;
    const BodyPair bodies = swapped ? BodyPair{second, first} : BodyPair{first, second};
    contacts[bodies].push_back(
        {bodies, contact.point, swapped ? Eigen::Vector3d(-contact.normal) : contact.normal, contact.depth});
  }
}

/// The points in the order of `bodies`.
std::array<Eigen::Vector3d, 2> StateInspector::Impl::nearestPoints(const Inspected& group, const InstancePair& pair,
                                                                   const BodyPair& bodies, double clearance,
                                                                   const std::vector<Eigen::Isometry3d>& link_poses)
{
  // Triangles of a curved solid are off by their sagitta, on both sides: up to 1e-4 m. It is larger for solids such as
  // spheres with a radius above half a metre: then FCL's points may be refused, and the answer has none.
  constexpr double kTriangleTolerance = 3e-4;  // metres
  const CollisionProblem& problem = *group.problem;
  const ShapeInstance& a = problem.robot[pair[0]];
  const Eigen::Isometry3d pose = link_poses[static_cast<std::size_t>(a.link)] * a.pose;
  const std::size_t robots = problem.robot.size();
  std::array<Eigen::Vector3d, 2> points;
  if (pair[1] >= robots + problem.world.size())
  {
    const WorldHalfSpace& b = problem.half_spaces[pair[1] - robots - problem.world.size()];
    points[0] = contactOf(pose, group.forest->tree(a.tree).shape, b, 0.0).point;
    points[1] = points[0] - (b.normal.dot(points[0]) - b.offset) * b.normal;
  }
  else
  {
    const bool is_self = pair[1] < robots;
    const ShapeInstance& b = is_self ? problem.robot[pair[1]] : problem.world[pair[1] - robots];
    const double distance = clearance + (is_self ? 0.0 : a.padding + b.padding);
    FclShape shape_a{a.tree, pose, nullptr};
    FclShape shape_b{b.tree, is_self ? link_poses[static_cast<std::size_t>(b.link)] * b.pose : b.pose, nullptr};
    const auto set_models = [&](FclGeometry (Models::*model_of)(const CollisionProblem&, std::uint32_t))
    {
      const std::lock_guard<std::mutex> lock(models->mutex);
      shape_a.model = (*models.*model_of)(problem, a.tree);
      shape_b.model = (*models.*model_of)(problem, b.tree);
    };
    set_models(&Models::modelOf);
    auto found = fclNearestPoints(shape_a, shape_b, distance);
    if (!found)
    {
      set_models(&Models::trianglesOf);
      found = fclNearestPoints(shape_a, shape_b, distance, kTriangleTolerance);
    }
    if (!found)
    {
      const Eigen::Vector3d none = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
      return {none, none};
    }
    points = *found;
  }
  if (a.body != bodies[0])
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
  CpuTraversal::Scratch placed;
  CpuShapePair::Scratch scratch;
  std::map<BodyPair, std::vector<Contact>> by_pair;
  for (const auto& pair : inspected.traversal->collidingInstances(poses.data(), placed))
    impl_->addContacts(inspected, pair, placed, scratch, by_pair);
  std::vector<Contact> firsts;
  std::vector<Contact> others;
  for (const auto& [bodies, contacts] : by_pair)
  {
    const std::vector<Contact> kept =
        deepest(contacts, max_per_pair == 0 ? max_contacts : std::min(max_contacts, max_per_pair));
    firsts.push_back(kept.front());
    others.insert(others.end(), kept.begin() + 1, kept.end());
  }
  const auto deeper = [](const Contact& a, const Contact& b) { return a.depth > b.depth; };
  std::stable_sort(firsts.begin(), firsts.end(), deeper);
  std::stable_sort(others.begin(), others.end(), deeper);
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
