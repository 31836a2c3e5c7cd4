#include "gpu_planning_scene/planning/group_state_space.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <ompl/base/ProjectionEvaluator.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/base/spaces/SO2StateSpace.h>
#include <ompl/tools/config/MagicConstants.h>
#include <Eigen/Core>

#include "base/math_constants.h"
#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/interpolation.h"
#include "planning/space/group_space.h"
#include "planning/space/uniform_sampler.h"

// The joints with limits share one space; each other joint has a space of its own. The default projection has the first
// joints with limits, because joints near the root move the robot the most. Planners with a grid of projections use it
// (I. A. Sucan, L. E. Kavraki: Kinodynamic motion planning by interior-exterior cell exploration. WAFR 2008).
namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;

// Radians or metres. OMPL's setup() refuses a space without extent. A single dimension without extent makes the measure
// of the whole space 0, and planners compute radii from this measure.
constexpr double kLeastRange = 1e-9;

// The distances of the joints are added without weights: a radian or a metre counts the same in each joint, as within
// RealVectorStateSpace. Better weights would differ between groups and states.
constexpr double kWeight = 1.0;

// KPIECE and similar planners keep a grid of projections. With more dimensions, its cells would stay empty.
constexpr std::size_t kMaxDefaultJoints = 3;

double rangeOf(const Variable& variable)
{
  return variable.upper - variable.lower;
}

bool hasLimits(const Joint& joint)
{
  return joint.type == JointType::Revolute || joint.type == JointType::Prismatic;
}

bool isPlannedFor(const RobotModel& robot, const Joint& joint)
{
  if (joint.type == JointType::Fixed || joint.mimic || joint.passive)
    return false;
  return !hasLimits(joint) || rangeOf(robot.variables()[joint.first_variable]) >= kLeastRange;
}

/// Number of variables that give a joint's position. They are the first variables of the joint: the translations of
/// planar and floating joints, and the only variable of other joints.
int translationCount(JointType type)
{
  switch (type)
  {
    case JointType::Planar:
      return 2;
    case JointType::Floating:
      return 3;
    default:
      return 1;
  }
}

using Workspace = std::optional<Eigen::AlignedBox3d>;

/// The bounds of each variable of the joint, see GroupStateSpace::ranges.
std::vector<std::pair<double, double>> rangesOf(const RobotModel& robot, const Joint& joint, const Workspace& workspace)
{
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<std::pair<double, double>> ranges;
  for (int i = 0; i < variableCount(joint.type); ++i)
  {
    const Variable& variable = robot.variables()[joint.first_variable + i];
    const bool is_translation =
        !hasLimits(joint) && joint.type != JointType::Continuous && i < translationCount(joint.type);
    std::pair<double, double> range(-kInfinity, kInfinity);
    if (variable.bounded || (is_translation && !workspace))
      range = {variable.lower, variable.upper};
    if (is_translation && workspace)
      range = {std::max(range.first, workspace->min()[i]), std::min(range.second, workspace->max()[i])};
    ranges.push_back(range);
  }
  return ranges;
}

ob::RealVectorBounds translationBounds(const RobotModel& robot, const Joint& joint,
                                       const std::vector<std::pair<double, double>>& ranges)
{
  const int count = translationCount(joint.type);
  ob::RealVectorBounds bounds(count);
  for (int i = 0; i < count; ++i)
  {
    const auto [lower, upper] = ranges[static_cast<std::size_t>(i)];
    const int variable = joint.first_variable + i;
    if (!(upper - lower >= kLeastRange))
      throw Error("joint '" + joint.name + "' cannot be planned for: '" +
                  robot.variables()[static_cast<std::size_t>(variable)].name + "' has no range (" + numberText(lower) +
                  " to " + numberText(upper) + "); give a workspace that has an extent in each " +
                  "direction and meets the joint's limits, or set unbounded_translation above 0");
    bounds.setLow(i, lower);
    bounds.setHigh(i, upper);
  }
  return bounds;
}

/// The space of a joint without limits. Its values are in the order of the joint's variables.
ob::StateSpacePtr spaceOf(const RobotModel& robot, const Joint& joint,
                          const std::vector<std::pair<double, double>>& ranges)
{
  if (joint.type == JointType::Planar)
  {
    const auto space = std::make_shared<ob::SE2StateSpace>();
    space->setBounds(translationBounds(robot, joint, ranges));
    return space;
  }
  if (joint.type == JointType::Floating)
  {
    const auto space = std::make_shared<ob::SE3StateSpace>();
    space->setBounds(translationBounds(robot, joint, ranges));
    return space;
  }
  return std::make_shared<ob::SO2StateSpace>();
}

/// Wraps an angle to [-pi, pi).
double wrapped(double angle)
{
  const double rest = std::remainder(angle, 2.0 * kPi);
  return rest == kPi ? -kPi : rest;
}

/// Normalises a quaternion as forward kinematics does; zero length becomes the identity.
void makeUnit(double* quaternion)
{
  Eigen::Map<Eigen::Vector4d> coefficients(quaternion);
  const double largest = coefficients.cwiseAbs().maxCoeff();
  if (largest == 0.0)
    coefficients = Eigen::Vector4d::UnitW();
  else
    coefficients = Eigen::Vector4d(coefficients / largest).normalized();
}

/// The joints to plan for, in the order of their values: joints with limits, continuous, planar, floating. Throws Error
/// if there is none.
std::vector<const Joint*> jointsByType(const RobotModel& robot, const Group& group)
{
  std::vector<const Joint*> joints;
  for (const int index : group.joints)
    if (isPlannedFor(robot, robot.joints()[index]))
      joints.push_back(&robot.joints()[index]);
  requireHolonomic(robot, group);
  for (const Joint* joint : joints)
    if (joint->type == JointType::Continuous && !isPeriodic(robot, *joint))
      throw Error(
          "continuous joint '" + joint->name + "' of group '" + group.name +
          "' cannot be planned for: a joint that mimics it is prismatic or has a multiplier that is not a whole " +
          "number, so a whole turn leads to another state; give it limits");
  if (joints.empty())
    throw Error("group '" + group.name + "' has no joint to plan for: each joint is fixed, mimic or passive, or its " +
                "limits are equal");
  const auto rank = [](const Joint* joint)
  {
    switch (joint->type)
    {
      case JointType::Continuous:
        return 1;
      case JointType::Planar:
        return 2;
      case JointType::Floating:
        return 3;
      default:
        return 0;
    }
  };
  std::stable_sort(joints.begin(), joints.end(), [&](const Joint* a, const Joint* b) { return rank(a) < rank(b); });
  return joints;
}

/// The joints of the default projection: see GroupStateSpace::projectOnto. `joints`: from jointsByType().
std::vector<std::string> defaultProjection(const std::vector<const Joint*>& joints)
{
  std::vector<std::string> names;
  for (const Joint* joint : joints)
    if (hasLimits(*joint) && names.size() < kMaxDefaultJoints)
      names.push_back(joint->name);
  if (!names.empty())
    return names;
  const auto earlier = [](const Joint* a, const Joint* b)
  {
    const bool a_turns = a->type == JointType::Continuous;
    const bool b_turns = b->type == JointType::Continuous;
    return a_turns == b_turns ? a->first_variable < b->first_variable : b_turns;
  };
  return {(*std::min_element(joints.begin(), joints.end(), earlier))->name};
}

/// A projection onto some values of a state.
class ValueProjection : public ob::ProjectionEvaluator
{
 public:
  ValueProjection(const ob::StateSpace* space, std::vector<ob::StateSpace::ValueLocation> values,
                  const ob::RealVectorBounds& ranges)
    : ob::ProjectionEvaluator(space), values_(std::move(values))
  {
    setBounds(ranges);
  }

  unsigned int getDimension() const override { return static_cast<unsigned int>(values_.size()); }

  void project(const ob::State* state, Eigen::Ref<Eigen::VectorXd> projection) const override
  {
    for (std::size_t i = 0; i < values_.size(); ++i)
      projection[static_cast<Eigen::Index>(i)] = *space_->getValueAddressAtLocation(state, values_[i]);
  }

  void defaultCellSizes() override
  {
    cellSizes_ = bounds_.getDifference();
    for (double& size : cellSizes_)
      size /= ompl::magic::PROJECTION_DIMENSION_SPLITS;
  }

 private:
  std::vector<ob::StateSpace::ValueLocation> values_;
};
}  // namespace

GroupStateSpace::GroupStateSpace(std::shared_ptr<const RobotModel> robot, const std::string& group,
                                 const std::optional<Eigen::AlignedBox3d>& workspace)
  : robot_(std::move(robot)), group_(&robot_->group(group))
{
  setName(group);
  const auto limits = std::make_shared<ob::RealVectorStateSpace>(0);
  limits->setName(group + "/joints");  // different from every joint's name, so that the subspaces have distinct names
  const std::vector<const Joint*> joints = jointsByType(*robot_, *group_);
  for (const Joint* joint : joints)
    if (hasLimits(*joint))
    {
      const Variable& variable = robot_->variables()[joint->first_variable];
      limits->addDimension(joint->name, variable.lower, variable.upper);
    }
  if (limits->getDimension() > 0)
  {
    limits->setStateSamplerAllocator([](const ob::StateSpace* space)
                                     { return std::make_shared<UniformSampler>(space); });
    addSubspace(limits, kWeight);
  }
  for (const Joint* joint : joints)
  {
    for (int i = 0; i < variableCount(joint->type); ++i)
      variables_.push_back(joint->first_variable + i);
    const std::vector<std::pair<double, double>> ranges = rangesOf(*robot_, *joint, workspace);
    ranges_.insert(ranges_.end(), ranges.begin(), ranges.end());
    if (hasLimits(*joint))
      continue;
    const ob::StateSpacePtr space = spaceOf(*robot_, *joint, ranges);
    space->setName(joint->name);
    addSubspace(space, kWeight);
  }
  lock();
  CompoundStateSpace::computeLocations();
  for (std::size_t i = 0; i < valueLocationsInOrder_.size(); ++i)
  {
    const ValueLocation& location = valueLocationsInOrder_[i];
    const int type = location.stateLocation.space->getType();
    if (type == ob::STATE_SPACE_SO2)
      angles_.push_back(i);
    else if (type == ob::STATE_SPACE_SO3 && location.index == 0)
      rotations_.push_back(i);
  }
  projected_ = projectedValues(defaultProjection(joints));
}

void GroupStateSpace::copyToRow(const ob::State* state, double* row) const
{
  for (std::size_t i = 0; i < variables_.size(); ++i)
    row[variables_[i]] = *getValueAddressAtLocation(state, valueLocationsInOrder_[i]);
}

void GroupStateSpace::copyFromRow(const double* row, ob::State* state) const
{
  const auto value = [&](std::size_t i) { return getValueAddressAtLocation(state, valueLocationsInOrder_[i]); };
  for (std::size_t i = 0; i < variables_.size(); ++i)
    *value(i) = row[variables_[i]];
  for (const std::size_t i : angles_)
    *value(i) = wrapped(*value(i));
  for (const std::size_t i : rotations_)
    makeUnit(value(i));
}

std::vector<std::size_t> GroupStateSpace::projectedValues(const std::vector<std::string>& joints) const
{
  if (joints.empty())
    throw Error("the projection of group '" + group_->name + "' names no joint");
  std::vector<std::size_t> values;
  for (const std::string& name : joints)
  {
    const int index = robot_->jointIndex(name);
    const auto first = index < 0 || robot_->joints()[index].mimic
                           ? variables_.end()
                           : std::find(variables_.begin(), variables_.end(), robot_->joints()[index].first_variable);
    if (first == variables_.end())
      throw Error("the projection of group '" + group_->name + "' names joint '" + name +
                  "', which is not a joint to plan for in this group");
    for (int i = 0; i < translationCount(robot_->joints()[index].type); ++i)
      values.push_back(static_cast<std::size_t>(first - variables_.begin() + i));
  }
  return values;
}

void GroupStateSpace::projectOnto(const std::vector<std::string>& joints)
{
  projected_ = projectedValues(joints);
  // setup() would keep an earlier projection if a user had set its cell sizes.
  registerProjections();
}

void GroupStateSpace::registerProjections()
{
  std::vector<ValueLocation> values;
  ob::RealVectorBounds ranges(static_cast<unsigned int>(projected_.size()));
  for (std::size_t i = 0; i < projected_.size(); ++i)
  {
    const Variable& variable = robot_->variables()[variables_[projected_[i]]];
    values.push_back(valueLocationsInOrder_[projected_[i]]);
    ranges.low[i] = variable.lower;
    ranges.high[i] = variable.upper;
  }
  registerDefaultProjection(std::make_shared<ValueProjection>(this, std::move(values), ranges));
}

void GroupStateSpace::interpolate(const ob::State* from, const ob::State* to, double t, ob::State* state) const
{
  CompoundStateSpace::interpolate(from, to, t, state);
  for (const std::size_t i : angles_)
    if (double& angle = *getValueAddressAtLocation(state, valueLocationsInOrder_[i]); angle == kPi)
      angle = -kPi;
}
}  // namespace gpu_planning_scene::core
