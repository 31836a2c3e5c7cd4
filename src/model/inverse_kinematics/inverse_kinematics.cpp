#include "gpu_planning_scene/inverse_kinematics.h"

#include <algorithm>
#include <utility>

#include "gpu_planning_scene/error.h"
#include "model/inverse_kinematics/descent.h"
#include "model/inverse_kinematics/ik_search.h"
#include "model/inverse_kinematics/kinematic_chains.h"

namespace gpu_planning_scene::core
{
namespace
{
// A projection aims inside the tolerances, so that rounding cannot leave its result outside of them.
constexpr double kShareOfProjection = 0.9;
}  // namespace

int tipOf(const RobotModel& robot, const Group& group)
{
  int tip = -1;
  for (const int index : group.joints)
  {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(index)];
    if (joint.mimic)
      continue;
    // The joint must lie below the last one.
    int above = joint.parent_link;
    while (tip >= 0 && above >= 0 && above != tip)
    {
      const int parent = robot.links()[static_cast<std::size_t>(above)].parent_joint;
      above = parent < 0 ? -1 : robot.joints()[static_cast<std::size_t>(parent)].parent_link;
    }
    if (tip >= 0 && above != tip)
      throw Error("the joints of group '" + group.name + "' are not one chain ('" + joint.name +
                  "' is on another branch); name the link whose pose is wanted");
    tip = joint.child_link;
  }
  if (tip < 0)
    throw Error("group '" + group.name + "' has no joint");
  return tip;
}

InverseKinematics::InverseKinematics(std::shared_ptr<const RobotModel> robot, const std::string& group,
                                     KinematicConstraints constraints)
  : constraints_(std::move(constraints))
{
  constraints_.validate(*robot, "the list of constraints");
  const Group& of = robot->group(group);
  for (const JointConstraint& range : constraints_.joints)
    if (!std::binary_search(of.variables.begin(), of.variables.end(), range.variable))
      throw Error("the list of constraints has a range of joint '" +
                  robot->variables()[static_cast<std::size_t>(range.variable)].name + "', which group '" + group +
                  "' does not move");
  chains_ = std::make_unique<const KinematicChains>(std::move(robot), of, constraints_.links());
}

InverseKinematics::~InverseKinematics() = default;

IkSolutions InverseKinematics::solve(const double* state, const IkOptions& options,
                                     const std::function<bool()>& stop) const
{
  IkSearch search(*this, state, options);
  IkSolutions found;
  while (auto solution = search.next(stop))
    found.states.push_back(std::move(*solution));
  found.attempts = search.attempts();
  if (found.states.empty())
    found.nearest = search.nearest();
  return found;
}

bool InverseKinematics::project(double* state) const
{
  const DegreesOfFreedom freedoms = narrowed(chains_->degreesOfFreedom(), constraints_.joints);
  clampToLimits(freedoms, state);
  constraints_.clampJoints(state);
  return Descent(constraints_, *chains_, freedoms).run(state, kShareOfProjection);
}

ConstraintViolation InverseKinematics::violation(const double* state) const
{
  KinematicChains::Workspace workspace;
  chains_->computePoses(state, workspace);
  return violationOf(constraints_, workspace.poses.data(), state);
}

const std::vector<int>& InverseKinematics::variables() const
{
  return chains_->variables();
}
}  // namespace gpu_planning_scene::core
