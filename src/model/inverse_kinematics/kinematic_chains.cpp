#include "model/inverse_kinematics/kinematic_chains.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Whether the limits of a joint leave it a range.
bool canMove(const RobotModel& robot, const Joint& joint)
{
  if (joint.first_variable < 0)
    return false;
  const Variable& variable = robot.variables()[static_cast<std::size_t>(joint.first_variable)];
  return variableCount(joint.type) != 1 || !variable.bounded || variable.lower < variable.upper;
}
}  // namespace

KinematicChains::KinematicChains(std::shared_ptr<const RobotModel> robot, const Group& group,
                                 const std::vector<int>& links)
  : robot_(std::move(robot))
{
  for (const int link : links)
  {
    chains_.push_back(chainTo(link, group));
    if (chains_.back().motions.empty())
      throw Error("group '" + group.name + "' has no joint that moves link '" +
                  robot_->links()[static_cast<std::size_t>(link)].name + "'");
  }
  const auto sort = [](std::vector<int>& indices)
  {
    std::sort(indices.begin(), indices.end());
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  };
  sort(moving_links_);
  sort(variables_);
}

KinematicChains::Chain KinematicChains::chainTo(int link, const Group& group)
{
  std::vector<int> joints;
  for (int at = link; at >= 0;)
  {
    moving_links_.push_back(at);
    const int joint = robot_->links()[static_cast<std::size_t>(at)].parent_joint;
    if (joint < 0)
      break;
    joints.push_back(joint);
    at = robot_->joints()[static_cast<std::size_t>(joint)].parent_link;
  }
  std::reverse(joints.begin(), joints.end());
  Chain chain{link, {}};
  for (const int joint : joints)
  {
    const Joint& each = robot_->joints()[static_cast<std::size_t>(joint)];
    if (!each.passive && canMove(*robot_, each) &&
        std::binary_search(group.variables.begin(), group.variables.end(), each.first_variable))
      addMotions(each, chain.motions);
  }
  return chain;
}

/// The index of a degree of freedom. A mimic joint has that of its leader.
int KinematicChains::addFreedom(int variable, int axis, bool is_turn)
{
  const auto known = std::find_if(freedoms_.begin(), freedoms_.end(),
                                  [variable, axis](const DegreeOfFreedom& freedom)
                                  { return freedom.variable == variable && freedom.axis == axis; });
  if (known != freedoms_.end())
  {
    known->is_turn = known->is_turn && is_turn;
    return static_cast<int>(known - freedoms_.begin());
  }
  const Variable& limits = robot_->variables()[static_cast<std::size_t>(variable)];
  freedoms_.push_back({variable, axis, is_turn, limits.bounded && axis < 0, limits.lower, limits.upper});
  return static_cast<int>(freedoms_.size()) - 1;
}

void KinematicChains::addMotions(const Joint& joint, std::vector<Motion>& motions)
{
  const auto add = [&](int offset, int axis, bool rotates, const Eigen::Vector3d& direction)
  {
    const bool is_turn = rotates && axis < 0 && std::round(joint.multiplier) == joint.multiplier;
    motions.push_back({addFreedom(joint.first_variable + offset, axis, is_turn), joint.parent_link, joint.child_link,
                       rotates, joint.multiplier * direction});
  };
  const Eigen::Matrix3d origin = joint.origin.linear();
  switch (joint.type)
  {
    case JointType::Revolute:
    case JointType::Continuous:
      add(0, -1, true, joint.axis);
      break;
    case JointType::Prismatic:
      add(0, -1, false, origin * joint.axis);
      break;
    case JointType::Planar:
      for (int k = 0; k < 2; ++k)
        add(k, -1, false, origin * planarDirections(joint.axis).col(k));
      add(2, -1, true, joint.axis);
      break;
    case JointType::Floating:
      for (int k = 0; k < 3; ++k)
        add(k, -1, false, origin.col(k));
      for (int k = 0; k < 3; ++k)
        add(3, k, true, Eigen::Vector3d::Unit(k));
      break;
    case JointType::Fixed:
      return;
  }
  for (int k = 0; k < variableCount(joint.type); ++k)
    variables_.push_back(joint.first_variable + k);
}

void KinematicChains::computePoses(const double* state, Workspace& workspace) const
{
  workspace.poses.resize(robot_->links().size());
  workspace.known.resize(robot_->links().size());
  for (const int link : moving_links_)
    workspace.known[static_cast<std::size_t>(link)] = 0;
  for (const Chain& chain : chains_)
    robot_->computeLinkPose(state, chain.link, workspace.poses.data(), workspace.known.data());
}

void KinematicChains::jacobian(int link, const Workspace& workspace, Jacobian& columns) const
{
  columns.setZero(6, static_cast<Eigen::Index>(freedoms_.size()));
  const auto chain =
      std::find_if(chains_.begin(), chains_.end(), [link](const Chain& each) { return each.link == link; });
  const Eigen::Vector3d tip = workspace.poses[static_cast<std::size_t>(link)].translation();
  for (const Motion& motion : chain->motions)
  {
    auto column = columns.col(motion.freedom);
    if (motion.rotates)
    {
      const Eigen::Isometry3d& child = workspace.poses[static_cast<std::size_t>(motion.child)];
      const Eigen::Vector3d axis = child.linear() * motion.axis;
      column.head<3>() += axis.cross(tip - child.translation());
      column.tail<3>() += axis;
    }
    else if (motion.parent < 0)
      column.head<3>() += motion.axis;
    else
      column.head<3>() += workspace.poses[static_cast<std::size_t>(motion.parent)].linear() * motion.axis;
  }
}
}  // namespace gpu_planning_scene::core
