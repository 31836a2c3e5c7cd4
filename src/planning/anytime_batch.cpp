#include "gpu_planning_scene/planning/anytime_batch.h"

#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/planning/batch_rrt_connect.h"
#include "gpu_planning_scene/planning/path_optimizer.h"
#include "planning/bulk_validator.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;
using ompl::geometric::PathGeometric;
}  // namespace

AnytimeBatch::AnytimeBatch(const ob::SpaceInformationPtr& information)
  : ob::Planner(information, "AnytimeBatch"), search_(std::make_shared<BatchRrtConnect>(information))
{
  specs_.recognizedGoal = ob::GOAL_SAMPLEABLE_REGION;
  specs_.directed = true;
  specs_.approximateSolutions = true;
  specs_.optimizingPaths = true;
  addPlannerProgressProperty("best cost REAL", [this] { return best_ ? std::to_string(best_->length()) : "inf"; });
}

AnytimeBatch::~AnytimeBatch() = default;

void AnytimeBatch::setup()
{
  Planner::setup();
  bulkValidatorOf(*si_, getName().c_str());
  search_->setProblemDefinition(pdef_);
  search_->setup();
}

void AnytimeBatch::clear()
{
  Planner::clear();
  search_->clear();
  best_.reset();
}

ob::PlannerStatus AnytimeBatch::solve(const ob::PlannerTerminationCondition& ptc)
{
  checkValidity();
  if (!best_)
  {
    const ob::PlannerStatus status = search_->solve(ptc);
    if (status != ob::PlannerStatus::EXACT_SOLUTION)
      return status;
    best_ = pdef_->getSolutionPath();
  }
  const auto callback = pdef_->getIntermediateSolutionCallback();
  const auto found = [&](const PathGeometric& path)
  {
    best_ = std::make_shared<PathGeometric>(path);
    if (!callback)
      return;
    std::vector<const ob::State*> states;
    for (unsigned int i = 0; i < path.getStateCount(); ++i)
      states.push_back(path.getState(i));
    callback(this, states, ob::Cost(path.length()));
  };
  PathGeometric path(*best_->as<PathGeometric>());
  PathOptimizer(si_, pdef_->getGoal()).improve(path, ptc, found);
  pdef_->clearSolutionPaths();
  pdef_->addSolutionPath(best_, false, 0.0, getName());
  return ob::PlannerStatus::EXACT_SOLUTION;
}

void AnytimeBatch::getPlannerData(ob::PlannerData& data) const
{
  search_->getPlannerData(data);
}
}  // namespace gpu_planning_scene::core
