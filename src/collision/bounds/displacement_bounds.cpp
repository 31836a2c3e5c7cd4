#include "collision/bounds/displacement_bounds.h"

#include <algorithm>

#include "collision/bounds/displacement_rounding.h"
#include "collision/bounds/state_box.h"

// A margin of an instance sums up the joints between its link and the root; that of a self pair the joints that move
// only one of the two (Schwarzer, Saha, Latombe 2002).
namespace gpu_planning_scene::core
{
namespace
{
/// The number of steps of a chain below the first link that the other chain has too. The joints above it move both.
std::size_t ownSteps(const LeverChain& chain, const LeverChain& other)
{
  const auto is_shared = [&other](const LeverChain::Step& step)
  {
    return std::any_of(other.steps.begin(), other.steps.end(),
                       [&step](const LeverChain::Step& theirs) { return theirs.link == step.link; });
  };
  return static_cast<std::size_t>(std::find_if(chain.steps.begin(), chain.steps.end(), is_shared) -
                                  chain.steps.begin());
}
}  // namespace

DisplacementBounds::DisplacementBounds(const std::shared_ptr<const RobotModel>& robot, const CollisionProblem& problem,
                                       JointLevers& levers)
  : robot_(robot), ranges_(provenRanges(*robot)), chains_(levers.of(robot, problem))
{
  std::size_t sums = 0;
  for (std::size_t i = 0; i < chains_.size(); ++i)
  {
    moving_.push_back({i, chains_[i]->steps.size(), i, 0});
    first_.push_back(sums);
    sums += chains_[i]->steps.size() + 1;
  }
  for (const auto& [a, b] : problem.self_pairs)
    moving_.push_back({a, ownSteps(*chains_[a], *chains_[b]), b, ownSteps(*chains_[b], *chains_[a])});
  first_.push_back(sums);
}

Margins DisplacementBounds::margins(const JointNeighbourhood& around, const double* states, std::size_t count) const
{
  const std::size_t joints = robot_->joints().size();
  const std::size_t variables = robot_->variables().size();
  const std::size_t rows = joints == 0 ? 0 : around.travel.size() / joints;
  Margins result{this->count(), std::vector<double>(rows * this->count()), around.rows, {}};
  result.within.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    result.within.push_back(withinRanges(ranges_, states + i * variables) ? 1 : 0);
  StateBox box(*robot_);
  std::vector<double> sums(first_.back());  // of the first 0, 1, 2, ... steps of each chain
  for (std::size_t row = 0; row < rows; ++row)
  {
    box.set(around.centers.empty() ? nullptr : around.centers.data() + row * variables,
            around.travel.data() + row * joints, around.spread);
    for (std::size_t i = 0; i < chains_.size(); ++i)
      box.sumSteps(*chains_[i], sums.data() + first_[i]);
    double* const margins = result.values.data() + row * this->count();
    for (std::size_t i = 0; i < moving_.size(); ++i)
    {
      const Moving& moving = moving_[i];
      const double sum =
          sums[first_[moving.chain] + moving.steps] + sums[first_[moving.other_chain] + moving.other_steps];
      margins[i] = sum == 0.0 ? 0.0 : std::min(kLargestMargin, withRounding(sum));
    }
  }
  return result;
}
}  // namespace gpu_planning_scene::core
