#include "gpu_planning_scene/state_inspector.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>

#include "base/parallel_for.h"
#include "collision/contacts/body_distances.h"
#include "collision/contacts/inspected_group.h"
#include "collision/problem/state_validation.h"
#include "gpu_planning_scene/error.h"

// The public face of this folder: it validates states, prepares each group once, and shares the states among the cores.
namespace gpu_planning_scene::core
{
namespace
{
BodyPair ascending(const BodyPair& bodies)
{
  return {std::min(bodies[0], bodies[1]), std::max(bodies[0], bodies[1])};
}
}  // namespace

struct StateInspector::Impl
{
  Impl(std::shared_ptr<const PlanningScene> the_scene, std::shared_ptr<InspectionTrees> the_trees)
    : scene(std::move(the_scene)), trees(std::move(the_trees))
  {
  }

  const InspectedGroup& inspected(const std::string& group);

  /// Calls work(inspected group, number, state, link poses) for each state, on all cores.
  template <class Work>
  void forEachState(const double* states, std::size_t count, const std::string& group, const Work& work);

  const std::shared_ptr<const PlanningScene> scene;
  const std::shared_ptr<InspectionTrees> trees;
  std::mutex mutex;
  std::map<std::string, InspectedGroup> groups;  // guarded by the mutex; entries are never removed
};

const InspectedGroup& StateInspector::Impl::inspected(const std::string& group)
{
  const std::lock_guard<std::mutex> lock(mutex);
  const auto known = groups.find(group);
  return known != groups.end() ? known->second : groups.try_emplace(group, *scene, group, *trees).first->second;
}

template <class Work>
void StateInspector::Impl::forEachState(const double* states, std::size_t count, const std::string& group,
                                        const Work& work)
{
  const InspectedGroup& prepared = inspected(group);
  const RobotModel& robot = *scene->robot;
  validateStates(robot, states, count);
  parallelFor(count, 1,
              [&, poses = std::vector<Eigen::Isometry3d>(robot.links().size())](std::size_t i, std::size_t) mutable
              {
                const double* state = states + i * robot.variables().size();
                robot.linkPoses(state, poses.data());
                work(prepared, i, state, poses);
              });
}

StateInspector::StateInspector(std::shared_ptr<const PlanningScene> scene, const StateInspector* previous)
{
  requireRobot(scene);
  impl_ =
      std::make_unique<Impl>(std::move(scene), previous ? previous->impl_->trees : std::make_shared<InspectionTrees>());
  impl_->inspected("");
  impl_->trees->convexity()->forgetUnused();
}

StateInspector::~StateInspector() = default;

const std::shared_ptr<const PlanningScene>& StateInspector::scene() const
{
  return impl_->scene;
}

std::vector<Contact> StateInspector::contacts(const double* state, const std::string& group, std::size_t max_contacts,
                                              std::size_t max_per_pair) const
{
  std::vector<Contact> firsts;
  impl_->forEachState(
      state, 1, group,
      [&](const InspectedGroup& inspected, std::size_t, const double*, const std::vector<Eigen::Isometry3d>& poses)
      {
        if (max_contacts == 0)
          return;
        const std::size_t most = std::min({max_contacts, max_per_pair == 0 ? max_contacts : max_per_pair, kMaxOfPair});
        std::vector<Contact> others;
        for (const CollidingPair& pair : inspected.collidingPairs(poses, most))
        {
          firsts.push_back(pair.contacts.front());
          others.insert(others.end(), pair.contacts.begin() + 1, pair.contacts.end());
        }
        const auto is_deeper = [](const Contact& a, const Contact& b) { return a.depth > b.depth; };
        std::stable_sort(firsts.begin(), firsts.end(), is_deeper);
        std::stable_sort(others.begin(), others.end(), is_deeper);
        firsts.insert(firsts.end(), others.begin(), others.end());
        firsts.resize(std::min(firsts.size(), max_contacts));
      });
  return firsts;
}

Clearance StateInspector::clearance(const double* state, const std::string& group) const
{
  return clearances(state, 1, group).front();
}

std::vector<Clearance> StateInspector::clearances(const double* states, std::size_t count,
                                                  const std::string& group) const
{
  std::vector<Clearance> found(count);
  impl_->forEachState(
      states, count, group,
      [&](const InspectedGroup& inspected, std::size_t i, const double*, const std::vector<Eigen::Isometry3d>& poses)
      {
        const NearestOfState nearest = inspected.clearance().find(poses.data());
        found[i] = {nearest.world.clearance, nearest.self.clearance, ascending(nearest.world.bodies),
                    ascending(nearest.self.bodies)};
      });
  return found;
}

std::vector<NearestPairs> StateInspector::nearestPairs(const double* states, std::size_t count,
                                                       const std::string& group) const
{
  std::vector<NearestPairs> found(count);
  impl_->forEachState(
      states, count, group,
      [&](const InspectedGroup& inspected, std::size_t i, const double*, const std::vector<Eigen::Isometry3d>& poses)
      { found[i] = nearestPairsOf(*impl_->scene, inspected, poses); });
  return found;
}

BodyDistances StateInspector::distances(const double* states, std::size_t count, const std::string& group,
                                        const DistanceQuery& query) const
{
  if (!(query.range > 0.0))
    throw Error("the range of distances must be above 0 m");
  const RobotModel& robot = *impl_->scene->robot;
  std::vector<StateDistances> found(count);
  impl_->forEachState(states, count, group,
                      [&](const InspectedGroup& inspected, std::size_t i, const double* state,
                          const std::vector<Eigen::Isometry3d>& poses)
                      { found[i] = distancesOf(robot, inspected, query, state, poses); });
  BodyDistances all;
  all.first.reserve(count + 1);
  for (const StateDistances& each : found)
  {
    all.first.push_back(all.pairs.size());
    all.pairs.insert(all.pairs.end(), each.pairs.begin(), each.pairs.end());
    all.gradients.insert(all.gradients.end(), each.gradients.begin(), each.gradients.end());
  }
  all.first.push_back(all.pairs.size());
  return all;
}
}  // namespace gpu_planning_scene::core
