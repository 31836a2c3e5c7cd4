#include "moveit/planner/robot_conversion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <moveit/robot_model/planar_joint_model.h>
#include <moveit/robot_model/prismatic_joint_model.h>
#include <moveit/robot_model/revolute_joint_model.h>

#include "base/math_constants.h"
#include "model/description/robot_parts.h"
#include "moveit/planner/converted_shapes.h"
#include "moveit/planner/refusal.h"
#include "moveit/shapes/collision_shape.h"

// Converts the robot that MoveIt has made from the URDF and the SRDF, instead of reading both again: limits and meshes
// are then those that MoveIt uses, and RobotModel does not keep the texts.
namespace gpu_planning_scene::pipeline
{
namespace
{
using core::JointType;
using moveit::core::JointModel;
using moveit::core::LinkModel;

// Radians or metres: larger than the rounding of a mimic joint's value, and than that of values written as text.
constexpr double kMimicRounding = 1e-9;

JointType typeOf(const JointModel& joint)
{
  switch (joint.getType())
  {
    case JointModel::FIXED:
      return JointType::Fixed;
    case JointModel::REVOLUTE:
      return static_cast<const moveit::core::RevoluteJointModel&>(joint).isContinuous() ? JointType::Continuous
                                                                                        : JointType::Revolute;
    case JointModel::PRISMATIC:
      return JointType::Prismatic;
    case JointModel::PLANAR:
      return JointType::Planar;
    case JointModel::FLOATING:
      return JointType::Floating;
    default:
      throw core::Error("joint '" + joint.getName() + "' has the type '" + joint.getTypeName() +
                        "', which is not supported");
  }
}

Eigen::Vector3d axisOf(const JointModel& joint)
{
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // of planar joints
  if (joint.getType() == JointModel::REVOLUTE)
    axis = static_cast<const moveit::core::RevoluteJointModel&>(joint).getAxis();
  else if (joint.getType() == JointModel::PRISMATIC)
    axis = static_cast<const moveit::core::PrismaticJointModel&>(joint).getAxis();
  if (axis.stableNorm() == 0.0)
    throw core::Error("joint '" + joint.getName() + "' has an axis of zero length");
  return axis.stableNormalized();
}

/// Number of the first variables of a joint that are translations without limits in most robots.
int translationsOf(JointType type)
{
  return type == JointType::Planar ? 2 : type == JointType::Floating ? 3 : 0;
}

class Converter
{
 public:
  Converter(const moveit::core::RobotModel& model, const RobotNeeds& needs) : model_(model), needs_(needs) {}

  core::RobotParts convert()
  {
    parts_.name = model_.getName();
    parts_.planning_frame = model_.getModelFrame();
    for (const JointModel* joint : model_.getJointModels())
      addJoint(*joint);
    for (const JointModel* joint : model_.getJointModels())
      followLeader(*joint);
    for (const LinkModel* link : model_.getLinkModels())
      addLink(*link);
    for (const std::string& link : needs_.carriers)
      addFixedLink(*model_.getLinkModel(link), " (carrier)");
    for (const auto& [name, scale] : needs_.scales)
    {
      const LinkModel& link = *model_.getLinkModel(name);
      addShapesOf(link, scale, addFixedLink(link, " (scaled)"));
    }
    for (const moveit::core::JointModelGroup* group : model_.getJointModelGroups())
      addGroup(*group);
    return std::move(parts_);
  }

 private:
  bool isMimic(const JointModel& joint) const
  {
    return joint.getMimic() && joint.getVariableCount() > 0 && needs_.own_values.count(joint.getName()) == 0;
  }

  void addJoint(const JointModel& model)
  {
    core::Joint joint;
    joint.name = model.getName();
    joint.type = typeOf(model);
    const LinkModel* parent = model.getParentLinkModel();
    joint.parent_link = parent ? RobotConversion::link(*parent) : -1;
    joint.child_link = RobotConversion::link(*model.getChildLinkModel());
    joint.origin = model.getChildLinkModel()->getJointOriginTransform();
    joint.axis = axisOf(model);
    joint.mimic = isMimic(model);
    joint.passive = model.isPassive();
    if (!joint.mimic && model.getVariableCount() > 0)
      addVariables(model, joint);
    parts_.tree.joints.push_back(std::move(joint));
  }

  void addVariables(const JointModel& model, core::Joint& joint)
  {
    const int translations = translationsOf(joint.type);
    joint.first_variable = static_cast<int>(parts_.tree.variables.size());
    for (std::size_t i = 0; i < model.getVariableCount(); ++i)
    {
      const moveit::core::VariableBounds& bounds = model.getVariableBounds()[i];
      core::Variable variable;
      variable.name = model.getVariableNames()[i];
      if (static_cast<int>(i) < translations)
        setRange(bounds, static_cast<int>(i), variable);
      else if (joint.type == JointType::Floating)
        variable.lower = -(variable.upper = 1.0);
      else if (translations > 0 || joint.type == JointType::Continuous)
        variable.lower = -(variable.upper = core::kPi);
      else
        setLimits(model, bounds, variable);
      parts_.tree.variables.push_back(std::move(variable));
    }
  }

  /// The range of a translation of a planar or floating joint: its limits and the workspace.
  void setRange(const moveit::core::VariableBounds& bounds, int axis, core::Variable& variable) const
  {
    constexpr double kNoWorkspace = 1.0;  // metres; a request that plans for a joint without limits has a workspace
    const double least = needs_.workspace ? needs_.workspace->min()[axis] : -kNoWorkspace;
    const double most = needs_.workspace ? needs_.workspace->max()[axis] : kNoWorkspace;
    const bool is_limited = hasLimits(bounds);
    variable.lower = !is_limited        ? least
                     : needs_.workspace ? std::max(least, bounds.min_position_)
                                        : bounds.min_position_;
    variable.upper = !is_limited        ? most
                     : needs_.workspace ? std::min(most, bounds.max_position_)
                                        : bounds.max_position_;
  }

  void setLimits(const JointModel& model, const moveit::core::VariableBounds& bounds, core::Variable& variable) const
  {
    if (!hasLimits(bounds))
      throw core::Error("joint '" + model.getName() + "' has no limits; only continuous joints need none");
    if (!(bounds.min_position_ <= bounds.max_position_))
      throw core::Error("joint '" + model.getName() + "' has the limits " + std::to_string(bounds.min_position_) +
                        " to " + std::to_string(bounds.max_position_) + "; they must be in order");
    variable.bounded = true;
    variable.lower = bounds.min_position_;
    variable.upper = bounds.max_position_;
    const auto own = needs_.own_values.find(model.getName());
    if (own == needs_.own_values.end())
      return;
    variable.lower = std::min(variable.lower, own->second);
    variable.upper = std::max(variable.upper, own->second);
  }

  void followLeader(const JointModel& model)
  {
    core::Joint& joint = parts_.tree.joints[model.getJointIndex()];
    if (!joint.mimic)
      return;
    const core::Joint& leader = parts_.tree.joints[model.getMimic()->getJointIndex()];
    if (model.getVariableCount() != 1 || leader.mimic || model.getMimic()->getVariableCount() != 1)
      throw core::Error("joint '" + joint.name + "' mimics '" + leader.name +
                        "'; both must be revolute, continuous or prismatic, and the leader must not mimic a joint");
    joint.first_variable = leader.first_variable;
    joint.multiplier = model.getMimicFactor();
    joint.offset = model.getMimicOffset();
  }

  void addLink(const LinkModel& model)
  {
    core::Link link;
    link.name = model.getName();
    link.parent_joint = model.getParentJointModel()->getJointIndex();
    addShapesOf(model, 1.0, link);
    parts_.tree.links.push_back(std::move(link));
  }

  static void addShapesOf(const LinkModel& model, double scale, core::Link& link)
  {
    for (std::size_t i = 0; i < model.getShapes().size(); ++i)
      addShapes(model.getShapes()[i], model.getCollisionOriginTransforms()[i], scale, Carried::Yes, model.getName(),
                link.shapes);
  }

  /// Adds a link at the place of another one.
  core::Link& addFixedLink(const LinkModel& model, const char* suffix)
  {
    core::Joint joint;
    joint.name = model.getName() + suffix;
    joint.parent_link = RobotConversion::link(model);
    joint.child_link = static_cast<int>(parts_.tree.links.size());
    core::Link link;
    link.name = joint.name;
    link.parent_joint = static_cast<int>(parts_.tree.joints.size());
    parts_.tree.joints.push_back(std::move(joint));
    parts_.tree.links.push_back(std::move(link));
    return parts_.tree.links.back();
  }

  void addGroup(const moveit::core::JointModelGroup& model)
  {
    core::Group group;
    group.name = model.getName();
    for (const JointModel* joint : model.getJointModels())
      if (needs_.own_values.count(joint->getName()) == 0)
        group.joints.push_back(joint->getJointIndex());
    std::set<int> active;  // first variables
    for (const int index : group.joints)
    {
      const core::Joint& joint = parts_.tree.joints[index];
      if (joint.mimic || joint.first_variable < 0)
        continue;
      active.insert(joint.first_variable);
      for (int i = 0; i < core::variableCount(joint.type); ++i)
        group.variables.push_back(joint.first_variable + i);
    }
    // The links that MoveIt checks for the group, and the links that its variables move.
    std::vector<bool> moved(parts_.tree.links.size(), false);
    for (const LinkModel* link : model.getUpdatedLinkModels())
      moved[RobotConversion::link(*link)] = true;
    for (std::size_t i = 0; i < moved.size(); ++i)
    {
      const core::Joint& joint = parts_.tree.joints[parts_.tree.links[i].parent_joint];
      moved[i] = moved[i] || (joint.first_variable >= 0 && active.count(joint.first_variable) != 0) ||
                 (joint.parent_link >= 0 && moved[joint.parent_link]);
      if (moved[i])
        group.moved_links.push_back(static_cast<int>(i));
    }
    parts_.groups.push_back(std::move(group));
  }

  const moveit::core::RobotModel& model_;
  const RobotNeeds& needs_;
  core::RobotParts parts_;
};
}  // namespace

bool hasLimits(const moveit::core::VariableBounds& bounds)
{
  return bounds.position_bounded_ && std::isfinite(bounds.min_position_) && std::isfinite(bounds.max_position_);
}

RobotConversion::RobotConversion(const moveit::core::RobotModelConstPtr& model, const RobotNeeds& needs)
  : model_(model), needs_(needs), robot_(core::makeRobot(Converter(*model, needs).convert()))
{
  for (const JointModel* joint : model->getJointModels())
  {
    const core::Joint& converted = robot_->joints()[joint->getJointIndex()];
    for (std::size_t i = 0; i < joint->getVariableCount(); ++i)
      variables_.push_back(
          {converted.first_variable + static_cast<int>(i), converted.multiplier, converted.offset, converted.mimic});
  }
  int next = static_cast<int>(model->getLinkModels().size());
  for (const std::string& link : needs.carriers)
    carriers_[link] = next++;
  for (const auto& [link, scale] : needs.scales)
    scaled_[link] = next++;
}

int RobotConversion::carrier(const LinkModel& its_link) const
{
  const auto found = carriers_.find(its_link.getName());
  return found == carriers_.end() ? link(its_link) : found->second;
}

std::optional<int> RobotConversion::scaledLink(const LinkModel& its_link) const
{
  const auto found = scaled_.find(its_link.getName());
  return found == scaled_.end() ? std::nullopt : std::optional<int>(found->second);
}

std::vector<double> RobotConversion::row(const moveit::core::RobotState& state) const
{
  std::vector<double> row(robot_->variables().size());
  for (std::size_t i = 0; i < variables_.size(); ++i)
    if (!variables_[i].mimic)
      row[static_cast<std::size_t>(variables_[i].index)] = state.getVariablePosition(static_cast<int>(i));
  return row;
}

void RobotConversion::setVariables(const double* row, moveit::core::RobotState& state) const
{
  std::vector<double> values;
  for (const MoveitVariable& variable : variables_)
    values.push_back(variable.multiplier * row[variable.index] + variable.offset);
  state.setVariablePositions(values);
}

bool RobotConversion::serves(const moveit::core::RobotModelConstPtr& model, const RobotNeeds& needs) const
{
  if (model != model_ || needs.carriers != needs_.carriers || needs.scales != needs_.scales ||
      needs.own_values.size() != needs_.own_values.size() ||
      needs.workspace.has_value() != needs_.workspace.has_value())
    return false;
  if (needs.workspace &&
      (needs.workspace->min() != needs_.workspace->min() || needs.workspace->max() != needs_.workspace->max()))
    return false;
  return std::all_of(needs.own_values.begin(), needs.own_values.end(),
                     [this](const auto& own)
                     {
                       if (needs_.own_values.count(own.first) == 0)
                         return false;
                       const core::Variable& variable =
                           robot_->variables()[static_cast<std::size_t>(robot_->variableIndex(own.first))];
                       return !variable.bounded || (own.second >= variable.lower && own.second <= variable.upper);
                     });
}

std::map<std::string, double> ownMimicValues(const moveit::core::RobotState& state)
{
  std::map<std::string, double> values;
  for (const JointModel* joint : state.getRobotModel()->getMimicJointModels())
  {
    if (joint->getVariableCount() != 1)
      continue;
    const double value = state.getVariablePosition(joint->getFirstVariableIndex());
    const double leader = state.getVariablePosition(joint->getMimic()->getFirstVariableIndex());
    if (!(std::abs(value - (joint->getMimicFactor() * leader + joint->getMimicOffset())) <= kMimicRounding))
      values[joint->getName()] = value;
  }
  return values;
}

void requirePlannable(const moveit::core::JointModelGroup& group)
{
  for (const JointModel* joint : group.getActiveJointModels())
  {
    if (joint->getType() != JointModel::PLANAR)
      continue;
    const auto& planar = static_cast<const moveit::core::PlanarJointModel&>(*joint);
    if (planar.getMotionModel() != moveit::core::PlanarJointModel::HOLONOMIC)
      throw Refusal(MoveItErrorCodes::PLANNING_FAILED,
                    "joint '" + joint->getName() +
                        "' turns before it drives (diff_drive); only holonomic planar joints are planned for");
    if (joint->getVariableBounds()[2].position_bounded_)
      throw Refusal(MoveItErrorCodes::PLANNING_FAILED, "the angle of the planar joint '" + joint->getName() +
                                                           "' has limits; it is planned for only without limits");
  }
}
}  // namespace gpu_planning_scene::pipeline
