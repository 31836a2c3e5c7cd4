#include "model/inverse_kinematics/descent.h"

#include <algorithm>

#include <Eigen/Cholesky>

// Damped least squares. The damping is the squared error, so it vanishes at a solution, where convergence is quadratic,
// and keeps steps short far from it and at singularities: T. Sugihara: Solvability-unconcerned inverse kinematics by
// the Levenberg-Marquardt method. IEEE Transactions on Robotics 27(5), 2011. A variable whose step would leave its
// limits stops at the limit, and the step of the others is computed again without it.
namespace gpu_planning_scene::core
{
namespace
{
// A descent that finds a solution rarely takes longer.
constexpr int kMaxSteps = 60;

// A descent ends if its least squared error has not fallen to this part within this number of steps.
constexpr double kProgress = 0.5;
constexpr int kStepsOfProgress = 6;

// Keeps the matrix regular where the error is almost 0 at a singularity.
constexpr double kLeastDamping = 1e-12;
}  // namespace

void Descent::computeStep(const double* state)
{
  auto derivatives = rows_.derivatives();
  step_.setZero(static_cast<Eigen::Index>(freedoms_.size()));
  const double damping = 0.5 * squared_error_ + kLeastDamping;
  rest_ = rows_.errors();  // without the motion of the variables that stop at a limit
  for (bool stops = true; stops;)
  {
    matrix_.noalias() = derivatives.lazyProduct(derivatives.transpose());
    matrix_.diagonal().array() += damping;
    const Eigen::VectorXd dual = matrix_.ldlt().solve(rest_);
    stops = false;
    for (std::size_t i = 0; i < freedoms_.size(); ++i)
    {
      const DegreeOfFreedom& freedom = freedoms_[i];
      auto column = derivatives.col(static_cast<Eigen::Index>(i));
      if (column.isZero(0.0))
        continue;
      double& step = step_[static_cast<Eigen::Index>(i)];
      step = column.dot(dual);
      if (!freedom.bounded)
        continue;
      const double value = state[freedom.variable] + step;
      const double within = std::clamp(value, freedom.lower, freedom.upper);
      if (within == value)
        continue;
      step = within - state[freedom.variable];
      rest_ -= step * column;
      column.setZero();
      stops = true;
    }
  }
}

bool Descent::run(double* state, double share)
{
  double least = std::numeric_limits<double>::infinity();
  int since = 0;
  bool is_within = false;
  for (int i = 0; i < kMaxSteps; ++i)
  {
    chains_.computePoses(state, workspace_);
    is_within = rows_.compute(workspace_, share);
    squared_error_ = rows_.errors().squaredNorm();
    if (is_within)
      return true;
    if (squared_error_ < kProgress * least)
    {
      least = squared_error_;
      since = 0;
    }
    else if (++since > kStepsOfProgress)
      return false;
    computeStep(state);
    advance(freedoms_, step_, state);
  }
  return false;
}
}  // namespace gpu_planning_scene::core
