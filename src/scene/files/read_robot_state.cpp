#include <algorithm>

#include "base/text/name_list.h"
#include "gpu_planning_scene/error.h"
#include "model/full_states.h"
#include "model/joint_limits.h"
#include "model/virtual_joint.h"
#include "scene/files/scene_keys.h"
#include "scene/files/scene_reader.h"
#include "scene/frame.h"
#include "scene/message_values.h"

namespace gpu_planning_scene::core
{
namespace
{
/// The values that were read so far, and the names of joints in the file that are not used.
struct GivenState
{
  std::vector<double> values;
  std::vector<bool> given;
  std::vector<std::string> unknown_joints;
  std::vector<std::string> fixed_joints;
  std::vector<std::string> mimic_joints;

  void set(int variable, double value)
  {
    values[variable] = value;
    given[variable] = true;
  }
  /// Whether the file names any joint. Joints that are ignored count.
  bool hasJoints() const
  {
    return std::find(given.begin(), given.end(), true) != given.end() || !unknown_joints.empty() ||
           !fixed_joints.empty() || !mimic_joints.empty();
  }
};

void readJointState(const YamlValue& value, const SceneReader& reader, GivenState& state)
{
  checkKeys(value, SceneMap::JointState, reader.warnings);
  frameOf(value.find("header"));  // joint values have no frame
  const YamlValue* names = value.find("name");
  const YamlValue* positions = value.find("position");
  const std::size_t name_count = names ? names->items().size() : 0;
  const std::size_t position_count = positions ? positions->items().size() : 0;
  if (name_count != position_count)
    value.fail(std::to_string(position_count) + " positions for " + std::to_string(name_count) + " joint names");
  for (std::size_t i = 0; i < name_count; ++i)
  {
    const std::string& name = names->items()[i].text();
    const double position = positions->items()[i].number();
    const int variable = reader.robot.variableIndex(name);
    if (variable >= 0)
    {
      if (state.given[variable])
        names->items()[i].fail("joint '" + name + "' is given twice");
      state.set(variable, position);
      continue;
    }
    const int joint = reader.robot.jointIndex(name);
    if (joint < 0)
      state.unknown_joints.push_back(name);
    else if (reader.robot.joints()[joint].mimic)
      state.mimic_joints.push_back(name);
    else if (reader.robot.joints()[joint].type == JointType::Fixed)
      state.fixed_joints.push_back(name);
    else
      names->items()[i].fail("joint '" + name + "' has several variables; name them as '" +
                             reader.robot.variables()[reader.robot.joints()[joint].first_variable].name +
                             "' and so on, or use multi_dof_joint_state");
  }
}

void setTransform(const YamlValue& where, const Joint& joint, const Eigen::Isometry3d& pose, GivenState& state)
{
  try
  {
    int variable = joint.first_variable;
    for (const double value : variablesAt(joint, pose))
      state.set(variable++, value);
  }
  catch (const Error& error)
  {
    where.fail(error.what());
  }
}

void readMultiDofState(const YamlValue& value, const SceneReader& reader, GivenState& state)
{
  checkKeys(value, SceneMap::MultiDofJointState, reader.warnings);
  const YamlValue* names = value.find("joint_names");
  const YamlValue* transforms = value.find("transforms");
  const std::size_t name_count = names ? names->items().size() : 0;
  const std::size_t transform_count = transforms ? transforms->items().size() : 0;
  if (name_count != transform_count)
    value.fail(std::to_string(transform_count) + " transforms for " + std::to_string(name_count) + " joint_names");
  if (name_count == 0)
    return;
  const YamlValue* frame = frameOf(value.find("header"));
  if (frame && !frame->text().empty() && !isPlanningFrame(reader.robot, frame->text()))
    frame->fail("multi_dof_joint_state is given in frame '" + frame->text() + "'; it must be the planning frame '" +
                reader.robot.planningFrame() +
                "' or empty, because the transform is the motion of the joint from its origin");
  for (std::size_t i = 0; i < name_count; ++i)
  {
    const std::string& name = names->items()[i].text();
    const Eigen::Isometry3d pose = readTransform(transforms->items()[i]);
    const int index = reader.robot.jointIndex(name);
    const Joint* joint = index < 0 ? nullptr : &reader.robot.joints()[index];
    if (!joint)
      state.unknown_joints.push_back(name);
    else if (joint->type == JointType::Fixed)
      state.fixed_joints.push_back(name);
    else if (joint->type != JointType::Planar && joint->type != JointType::Floating)
      names->items()[i].fail("joint '" + name + "' is neither planar nor floating; give its position in joint_state");
    else
      setTransform(transforms->items()[i], *joint, pose, state);
  }
}

void readNamedState(const YamlValue& name, const SceneReader& reader, GivenState& state)
{
  NamedState named;
  const std::string& text = name.text();
  try
  {
    named = reader.robot.namedState(text);
  }
  catch (const Error& error)
  {
    name.fail(std::string("named_state: ") + error.what());
  }
  for (std::size_t i = 0; i < named.variables.size(); ++i)
  {
    const int variable = named.variables[i];
    if (state.given[variable])
      name.fail("named_state: '" + text + "' sets '" + reader.robot.variables()[variable].name +
                "', which another state of the list has set");
    state.set(variable, named.values[i]);
  }
}

/// One or several states that the SRDF names, but no joint values beside them, as in CheckStates.srv.
void readNamedStates(const YamlValue& value, const SceneReader& reader, GivenState& state)
{
  if (state.hasJoints())
    value.fail("named_state is given, but the robot state has joint values too; give one of the two");
  if (value.kind() != YamlValue::Kind::Sequence)
    return readNamedState(value, reader, state);
  for (const YamlValue& name : value.items())
    readNamedState(name, reader, state);
}
}  // namespace

std::vector<double> readRobotState(const YamlValue& value, SceneReader& reader)
{
  checkKeys(value, SceneMap::RobotState, reader.warnings);
  GivenState state;
  state.values = reader.robot.defaultState();
  state.given.assign(state.values.size(), false);
  if (const YamlValue* joints = value.find("joint_state"))
    readJointState(*joints, reader, state);
  if (const YamlValue* joints = value.find("multi_dof_joint_state"))
    readMultiDofState(*joints, reader, state);
  if (const YamlValue* name = value.find("named_state"))
    readNamedStates(*name, reader, state);

  const std::string start = value.where() + ": robot_state: ";
  if (!state.unknown_joints.empty())
    reader.warn(start + "joints ignored because the robot does not have them: " + nameList(state.unknown_joints));
  if (!state.fixed_joints.empty())
    reader.warn(start + "joints ignored because they are fixed: " + nameList(state.fixed_joints));
  if (!state.mimic_joints.empty())
    reader.warn(start + "joints ignored because they follow other joints: " + nameList(state.mimic_joints));

  if (std::find(state.given.begin(), state.given.end(), true) == state.given.end())
    return {};
  // The virtual joint is not in the URDF. Scene files often leave it out, and then mean its default, or that of tf.
  const std::vector<bool> may_be_missing = PartialState(reader.robot).known;
  std::vector<std::string> missing;
  std::vector<int> columns;
  std::vector<double> values;
  const std::vector<int> of_virtual_joint = virtualVariables(reader.robot);
  reader.leaves_out_base =
      !of_virtual_joint.empty() && std::none_of(of_virtual_joint.begin(), of_virtual_joint.end(),
                                                [&state](int variable) { return state.given[variable]; });
  for (std::size_t i = 0; i < state.given.size(); ++i)
    if (state.given[i])
    {
      columns.push_back(static_cast<int>(i));
      values.push_back(state.values[i]);
    }
    else if (!may_be_missing[i])
      missing.push_back(reader.robot.variables()[i].name);
  if (!missing.empty())
    reader.warn(start + "joints without a value get their default: " + nameList(missing));
  if (const auto outside = findDoubtfulValue(reader.robot, columns, values.data(), 1))
    reader.warn(start + outside->text);
  return state.values;
}
}  // namespace gpu_planning_scene::core
