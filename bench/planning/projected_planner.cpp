#include "planning/projected_planner.h"

#include <ompl/base/ConstrainedSpaceInformation.h>
#include <ompl/base/Constraint.h>
#include <ompl/base/goals/GoalStates.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/constraint/ProjectedStateSpace.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>

#include "benchmark/statistics.h"
#include "gpu_planning_scene/inverse_kinematics.h"
#include "model/inverse_kinematics/constraint_values.h"
#include "model/inverse_kinematics/kinematic_chains.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
namespace ob = ompl::base;
namespace og = ompl::geometric;

/// The variables of a group in a row of all variables.
struct Rows
{
  std::vector<int> variables;
  std::vector<double> reference;

  std::vector<double> rowOf(const Eigen::Ref<const Eigen::VectorXd>& x) const
  {
    std::vector<double> row = reference;
    for (std::size_t i = 0; i < variables.size(); ++i)
      row[static_cast<std::size_t>(variables[i])] = x[static_cast<Eigen::Index>(i)];
    return row;
  }
};

/// The excess of the two tilt angles of one orientation constraint; its third angle is free.
class Tilt : public ob::Constraint
{
 public:
  Tilt(const InverseKinematics& kinematics, const Rows& rows)
    : ob::Constraint(static_cast<unsigned int>(rows.variables.size()), 2), kinematics_(kinematics), rows_(rows)
  {
  }

  void function(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> out) const override
  {
    const OrientationConstraint& orientation = kinematics_.constraints().orientations.front();
    const OrientationValues values = valuesAt(x);
    for (int axis = 0; axis < 2; ++axis)
    {
      const double excess = std::abs(values.angles[axis]) - orientation.tolerance[axis];
      out[axis] = excess > 0.0 ? std::copysign(excess, values.angles[axis]) : 0.0;
    }
  }

  void jacobian(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::MatrixXd> out) const override
  {
    const OrientationConstraint& orientation = kinematics_.constraints().orientations.front();
    const OrientationValues values = valuesAt(x);
    KinematicChains::Jacobian jacobian;
    kinematics_.chains().jacobian(orientation.link, workspace_, jacobian);
    for (int axis = 0; axis < 2; ++axis)
      if (std::abs(values.angles[axis]) > orientation.tolerance[axis])
        out.row(axis) = values.rates.row(axis) * jacobian.bottomRows<3>();
      else
        out.row(axis).setZero();
  }

 private:
  OrientationValues valuesAt(const Eigen::Ref<const Eigen::VectorXd>& x) const
  {
    const OrientationConstraint& orientation = kinematics_.constraints().orientations.front();
    kinematics_.chains().computePoses(rows_.rowOf(x).data(), workspace_);
    return orientationValues(orientation, workspace_.poses[static_cast<std::size_t>(orientation.link)]);
  }

  const InverseKinematics& kinematics_;
  const Rows& rows_;
  mutable KinematicChains::Workspace workspace_;
};

Eigen::VectorXd valuesOf(const Rows& rows, const std::vector<double>& row)
{
  Eigen::VectorXd x(static_cast<Eigen::Index>(rows.variables.size()));
  for (std::size_t i = 0; i < rows.variables.size(); ++i)
    x[static_cast<Eigen::Index>(i)] = row[static_cast<std::size_t>(rows.variables[i])];
  return x;
}
}  // namespace

ProjectedPath planProjected(const std::shared_ptr<const PlanningScene>& scene,
                            const std::shared_ptr<StateChecker>& checker, const std::string& group,
                            const KinematicConstraints& constraints, const std::vector<double>& start,
                            const std::vector<std::vector<double>>& goals, double seconds)
{
  constexpr double kDelta = 0.05;  // the largest step of OMPL's traversal: its own default
  const Rows rows{scene->robot->group(group).variables, start};
  const InverseKinematics kinematics(scene->robot, group, constraints);
  const auto real = std::make_shared<ob::RealVectorStateSpace>(static_cast<unsigned int>(rows.variables.size()));
  for (std::size_t i = 0; i < rows.variables.size(); ++i)
  {
    const Variable& variable = scene->robot->variables()[static_cast<std::size_t>(rows.variables[i])];
    ob::RealVectorBounds bounds = real->getBounds();
    bounds.setLow(static_cast<unsigned int>(i), variable.lower);
    bounds.setHigh(static_cast<unsigned int>(i), variable.upper);
    real->setBounds(bounds);
  }
  const auto space = std::make_shared<ob::ProjectedStateSpace>(real, std::make_shared<Tilt>(kinematics, rows));
  const auto information = std::make_shared<ob::ConstrainedSpaceInformation>(space);
  og::SimpleSetup setup(information);
  space->setDelta(kDelta);
  setup.setStateValidityChecker(
      [&](const ob::State* state)
      {
        const auto& x = *state->as<ob::ConstrainedStateSpace::StateType>();
        const std::vector<double> row = rows.rowOf(x);
        return checker->check(row.data(), 1, group).valid.front() != 0;
      });
  const auto state_of = [&](const std::vector<double>& row)
  {
    ob::ScopedState<ob::ConstrainedStateSpace> state(space);
    state->copy(valuesOf(rows, row));
    return state;
  };
  setup.addStartState(state_of(start));
  const auto goal = std::make_shared<ob::GoalStates>(information);
  for (const std::vector<double>& row : goals)
    goal->addState(state_of(row));
  setup.setGoal(goal);
  setup.setPlanner(std::make_shared<og::RRTConnect>(information));
  setup.setup();
  ProjectedPath path;
  const Stopwatch watch;
  path.is_solved = setup.solve(seconds) == ob::PlannerStatus::EXACT_SOLUTION;
  path.seconds = watch.seconds();
  if (!path.is_solved)
    return path;
  og::PathGeometric solution = setup.getSolutionPath();
  solution.interpolate();
  for (const ob::State* state : solution.getStates())
    path.rows.push_back(rows.rowOf(*state->as<ob::ConstrainedStateSpace::StateType>()));
  return path;
}
}  // namespace gpu_planning_scene::core::benchmark
