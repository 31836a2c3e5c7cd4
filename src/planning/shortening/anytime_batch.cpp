#include "gpu_planning_scene/planning/anytime_batch.h"

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "gpu_planning_scene/planning/batch_rrt_connect.h"
#include "gpu_planning_scene/planning/path_optimizer.h"
#include "planning/validity/bulk_validator.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;
using ompl::geometric::PathGeometric;
}  // namespace

AnytimeBatch::AnytimeBatch(const ob::SpaceInformationPtr& information)
  : ob::Planner(information, "AnytimeBatch"),
    search_(std::make_shared<BatchRrtConnect>(information)),
    best_length_(std::numeric_limits<double>::infinity())
{
  specs_.recognizedGoal = ob::GOAL_SAMPLEABLE_REGION;
  specs_.directed = true;
  specs_.approximateSolutions = true;
  specs_.optimizingPaths = true;
  declareParam<unsigned int>("searches", search_.get(), &BatchRrtConnect::setSearches, &BatchRrtConnect::getSearches,
                             "0:1:64");
  addPlannerProgressProperty("best cost REAL", [this] { return std::to_string(best_length_.load()); });
}

AnytimeBatch::~AnytimeBatch() = default;

void AnytimeBatch::setProblemDefinition(const ob::ProblemDefinitionPtr& definition)
{
  Planner::setProblemDefinition(definition);
  clear();
}

void AnytimeBatch::setKnownPaths(std::vector<PathGeometric> paths)
{
  search_->setKnownPaths(std::move(paths));
}

void AnytimeBatch::setup()
{
  Planner::setup();
  bulkValidatorOf(*si_, getName().c_str());
}

void AnytimeBatch::clear()
{
  Planner::clear();
  search_->clear();
  searched_.reset();
  best_.reset();
  best_length_ = std::numeric_limits<double>::infinity();
}

void AnytimeBatch::take(const PathGeometric& path)
{
  best_ = std::make_shared<PathGeometric>(path);
  best_length_ = best_->length();
  const auto callback = pdef_->getIntermediateSolutionCallback();
  if (!callback)
    return;
  std::vector<const ob::State*> states;
  for (unsigned int i = 0; i < best_->getStateCount(); ++i)
    states.push_back(best_->getState(i));
  callback(this, states, ob::Cost(best_length_));
}

ob::PlannerStatus AnytimeBatch::solve(const ob::PlannerTerminationCondition& ptc)
{
  checkValidity();
  if (!searched_)
  {
    searched_ = std::make_shared<ob::ProblemDefinition>(si_);
    for (unsigned int i = 0; i < pdef_->getStartStateCount(); ++i)
      searched_->addStartState(pdef_->getStartState(i));
    searched_->setGoal(pdef_->getGoal());
    search_->setProblemDefinition(searched_);
    search_->setup();
  }
  if (!best_)
  {
    const ob::PlannerStatus status = search_->solve(ptc);
    if (status == ob::PlannerStatus::APPROXIMATE_SOLUTION)
      pdef_->addSolutionPath(searched_->getSolutionPath(), true, searched_->getSolutionDifference(), getName());
    if (status != ob::PlannerStatus::EXACT_SOLUTION)
      return status;
    take(*searched_->getSolutionPath()->as<PathGeometric>());
  }
  PathGeometric path(*best_);
  PathOptimizer(si_, pdef_->getGoal()).improve(path, ptc, [this](const PathGeometric& shorter) { take(shorter); });
  pdef_->addSolutionPath(best_, false, 0.0, getName());
  return ob::PlannerStatus::EXACT_SOLUTION;
}

void AnytimeBatch::getPlannerData(ob::PlannerData& data) const
{
  search_->getPlannerData(data);
}
}  // namespace gpu_planning_scene::core
