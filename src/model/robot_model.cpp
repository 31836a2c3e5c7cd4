#include "gpu_planning_scene/robot_model.h"

#include <algorithm>
#include <cmath>

#include "gpu_planning_scene/error.h"
#include "model/kinematics.h"

namespace gpu_planning_scene::core
{
namespace
{
int find(const std::unordered_map<std::string, int>& indices, const std::string& name)
{
  const auto found = indices.find(name);
  return found == indices.end() ? -1 : found->second;
}

// Uniform in [0, 1), with the same numbers from every standard library.
double uniform(std::mt19937_64& generator)
{
  return static_cast<double>(generator() >> 11) * 0x1.0p-53;
}

double randomValue(const Variable& variable, std::mt19937_64& generator)
{
  const double u = uniform(generator);
  // This form cannot overflow, even for wide limits. The clamp removes rounding errors.
  return std::clamp((1.0 - u) * variable.lower + u * variable.upper, variable.lower, variable.upper);
}

// Uniform over the rotations: draws points in the four-dimensional unit ball by rejection and normalises them.
void randomQuaternion(std::mt19937_64& generator, double* coefficients)
{
  Eigen::Map<Eigen::Vector4d> quaternion(coefficients);
  double squared_norm;
  do
  {
    for (int i = 0; i < 4; ++i)
      quaternion[i] = 2.0 * uniform(generator) - 1.0;
    squared_norm = quaternion.squaredNorm();
  } while (squared_norm > 1.0 || squared_norm < 1e-6);
  quaternion /= std::sqrt(squared_norm);
}
}  // namespace

int variableCount(JointType type)
{
  switch (type)
  {
    case JointType::Fixed:
      return 0;
    case JointType::Planar:
      return 3;
    case JointType::Floating:
      return 7;
    default:
      return 1;
  }
}

int RobotModel::linkIndex(const std::string& name) const
{
  return find(link_indices_, name);
}

int RobotModel::jointIndex(const std::string& name) const
{
  return find(joint_indices_, name);
}

int RobotModel::variableIndex(const std::string& name) const
{
  return find(variable_indices_, name);
}

const Group& RobotModel::group(const std::string& name) const
{
  std::string names;
  for (const Group& group : groups_)
  {
    if (group.name == name)
      return group;
    names += (names.empty() ? "" : ", ") + group.name;
  }
  throw Error((name.empty() ? "give group, the name of a planning group of robot '" + name_ + "'; "
                            : "robot '" + name_ + "' has no group '" + name + "'; ") +
              (names.empty() ? "it has no groups (groups come from an SRDF)" : "its groups: " + names));
}

/// Adjacent links touch at the joint between them, so their collisions say nothing. This holds for one revolute,
/// continuous or prismatic joint, also if it mimics another one. Several joints, a planar joint and a floating joint
/// let two links meet elsewhere too.
std::vector<std::pair<int, int>> RobotModel::adjacentLinks() const
{
  /// The nearest link with shapes, upwards from a link itself, and the degrees of freedom between the two.
  struct Nearest
  {
    int link = -1;  // -1: none
    int freedoms = 0;
  };
  std::vector<std::pair<int, int>> pairs;
  std::vector<Nearest> nearest(links_.size());
  for (std::size_t i = 0; i < links_.size(); ++i)
  {
    const int link = static_cast<int>(i);
    Nearest above;
    if (const int joint = links_[i].parent_joint; joint >= 0 && joints_[joint].parent_link >= 0)
    {
      above = nearest[joints_[joint].parent_link];
      above.freedoms += variableCount(joints_[joint].type);
    }
    nearest[i] = links_[i].shapes.empty() ? above : Nearest{link, 0};
    if (nearest[i].link == link && above.link >= 0 && above.freedoms <= 1)
      pairs.emplace_back(above.link, link);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

void RobotModel::linkPoses(const double* state, Eigen::Isometry3d* poses) const
{
  kinematics_->linkPoses(state, poses);
}

void RobotModel::computeLinkPose(const double* state, int link, Eigen::Isometry3d* poses, std::uint8_t* known) const
{
  kinematics_->computeLinkPose(state, link, poses, known);
}

void RobotModel::randomState(std::mt19937_64& generator, double* state) const
{
  for (std::size_t i = 0; i < variables_.size(); ++i)
    state[i] = randomValue(variables_[i], generator);
  for (const Joint& joint : joints_)
    if (joint.type == JointType::Floating)
      randomQuaternion(generator, state + joint.first_variable + 3);
}

void RobotModel::randomState(std::mt19937_64& generator, const double* base, double* state) const
{
  std::copy_n(base, variables_.size(), state);
  for (const Joint& joint : joints_)
    if (variableCount(joint.type) == 1 && !joint.mimic)
      state[joint.first_variable] = randomValue(variables_[static_cast<std::size_t>(joint.first_variable)], generator);
}

std::vector<double> RobotModel::defaultState() const
{
  std::vector<double> state(variables_.size(), 0.0);
  for (std::size_t i = 0; i < variables_.size(); ++i)
    if (variables_[i].lower > 0.0 || variables_[i].upper < 0.0)
      state[i] = 0.5 * variables_[i].lower + 0.5 * variables_[i].upper;
  for (const Joint& joint : joints_)
    if (joint.type == JointType::Floating)
      state[joint.first_variable + 6] = 1.0;
  return state;
}

std::size_t RobotModel::triangleCount() const
{
  std::size_t count = 0;
  for (const Link& link : links_)
  {
    for (const PlacedShape& placed : link.shapes)
      if (const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&placed.shape))
        count += (*mesh)->triangles.size();
  }
  return count;
}
}  // namespace gpu_planning_scene::core
