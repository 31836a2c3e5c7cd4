#include "node/planning/rehearsal.h"

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <ompl/util/Exception.h>
#include <ompl/util/Time.h>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/planning/group_state_space.h"
#include "gpu_planning_scene/planning/plan_motion.h"
#include "planning/space/group_space.h"
#include "planning/validity/counted_checker.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kStates = 512;  // as in a round of the batch planner

// A rehearsal ends after this many checked states. After 20,000, the checker asks for proofs of the robot, and if none
// are stored, they are made on all cores for seconds.
constexpr std::uint64_t kMostStates = 12'000;

constexpr double kSecondsOfPlan = 0.01;
constexpr double kSecondsOfPlans = 0.1;

/// A group, and random states of it that are free.
struct Rehearsed
{
  std::string group;
  std::vector<std::vector<double>> free;  // rows
};

/// Rows whose variables outside the space have the values of the scene's state.
std::vector<double> randomRows(const PlanningScene& scene, const GroupStateSpace& space)
{
  const std::vector<double> base = referenceState(scene);
  std::vector<double> rows;
  std::vector<double> random(base.size());
  std::mt19937_64 generator(1);
  for (std::size_t i = 0; i < kStates; ++i)
  {
    scene.robot->randomState(generator, random.data());
    const std::size_t begin = rows.size();
    rows.insert(rows.end(), base.begin(), base.end());
    for (const int variable : space.variables())
      rows[begin + static_cast<std::size_t>(variable)] = random[static_cast<std::size_t>(variable)];
  }
  return rows;
}

/// Checks states of a group. Throws Error if it cannot be planned for.
Rehearsed checkStates(const std::shared_ptr<const PlanningScene>& scene, StateChecker& checker,
                      const std::string& group)
{
  const std::vector<double> rows = randomRows(*scene, GroupStateSpace(scene->robot, group));
  const BatchResult result = checker.check(rows.data(), kStates, group);
  // The second check finds the bounds of motions.
  const JointNeighbourhood unmoved{std::vector<JointTravel>(scene->robot->joints().size()),
                                   std::vector<std::uint32_t>(kStates)};
  checker.check(rows.data(), kStates, group, &unmoved);
  Rehearsed rehearsed{group, {}};
  const auto width = static_cast<std::ptrdiff_t>(rows.size() / kStates);
  for (std::size_t i = 0; i < kStates; ++i)
    if (result.valid[i] != 0)
    {
      const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(i) * width;
      rehearsed.free.emplace_back(begin, begin + width);
    }
  return rehearsed;
}

/// Plans between two free states of a group, until `stop` returns true.
void planMotionOf(const std::shared_ptr<const PlanningScene>& scene, const std::shared_ptr<StateChecker>& checker,
                  const Rehearsed& rehearsed, std::size_t number, const MotionCheckerOptions& motions,
                  const PlannerFactory& factory, const std::function<bool()>& stop)
{
  PlanningQuery query;
  query.group = rehearsed.group;
  query.start = rehearsed.free[2 * number];
  query.goals = {rehearsed.free[2 * number + 1]};
  query.seconds = kSecondsOfPlan;
  query.simplify = false;
  query.motions = motions;
  planMotion(scene, checker, query, factory, stop);
}

/// Leaves out what a group cannot do; a request says why.
void attempt(const std::function<void()>& part)
{
  try
  {
    part();
  }
  catch (const Error&)
  {
  }
  catch (const ompl::Exception&)
  {
  }
}
}  // namespace

void rehearsePlans(const std::shared_ptr<const PlanningScene>& scene, const std::shared_ptr<StateChecker>& checker,
                   const MotionCheckerOptions& motions, const PlannerFactory& factory,
                   const std::function<bool()>& stop)
{
  const auto counted = std::make_shared<CountedChecker>(checker);
  const auto is_over = [&] { return counted->states() >= kMostStates || stop(); };
  std::vector<Rehearsed> all;
  for (const Group& group : scene->robot->groups())
    if (!is_over())
      attempt([&] { all.push_back(checkStates(scene, *counted, group.name)); });
  const ompl::time::point begin = ompl::time::now();
  const auto has_ended = [&] { return ompl::time::seconds(ompl::time::now() - begin) > kSecondsOfPlans || is_over(); };
  for (std::size_t number = 0; number < kStates / 2; ++number)
    for (const Rehearsed& rehearsed : all)
      if (2 * number + 1 < rehearsed.free.size() && !has_ended())
        attempt([&] { planMotionOf(scene, counted, rehearsed, number, motions, factory, has_ended); });
}
}  // namespace gpu_planning_scene::core
