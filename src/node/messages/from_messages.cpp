#include "node/messages/from_messages.h"

#include <algorithm>
#include <set>

#include "base/text/name_list.h"
#include "gpu_planning_scene/error.h"
#include "node/messages/joint_transform.h"
#include "node/messages/object_from_message.h"
#include "node/messages/octomap_messages.h"
#include "scene/frame.h"

namespace gpu_planning_scene::core
{
namespace
{
void requireAsMany(std::size_t values, std::size_t names, const std::string& what)
{
  if (values != names)
    throw Error(what + ": " + std::to_string(values) + " values for " + std::to_string(names) + " names");
}

/// Inserts a value. Throws Error if the map already has the name.
template <class Value>
void insertOnce(std::map<std::string, Value>& map, const std::string& name, const Value& value, const char* what)
{
  if (!map.emplace(name, value).second)
    throw Error(std::string(what) + " of '" + name + "' is given twice");
}

/// Reads the variables of a robot_state, and collects the names of joints that it cannot use.
class StateReader
{
 public:
  StateReader(const RobotModel& robot, StateChange& state) : robot_(robot), state_(state) {}

  void read(const sensor_msgs::JointState& joints)
  {
    requireAsMany(joints.position.size(), joints.name.size(), "robot_state.joint_state");
    for (std::size_t i = 0; i < joints.name.size(); ++i)
      readJoint(joints.name[i], joints.position[i]);
  }

  void read(const sensor_msgs::MultiDOFJointState& joints)
  {
    requireAsMany(joints.transforms.size(), joints.joint_names.size(), "robot_state.multi_dof_joint_state");
    for (std::size_t i = 0; i < joints.joint_names.size(); ++i)
    {
      const int index = robot_.jointIndex(joints.joint_names[i]);
      if (index < 0)
        unknown_.push_back(joints.joint_names[i]);
      else if (const Joint& joint = robot_.joints()[static_cast<std::size_t>(index)]; joint.type == JointType::Fixed)
        fixed_.push_back(joint.name);
      else
        readTransform(joint, joints.header.frame_id, joints.transforms[i]);
    }
  }

  void warn(std::vector<std::string>* warnings) const
  {
    const auto add = [&](const char* reason, const std::vector<std::string>& names)
    {
      if (warnings != nullptr && !names.empty())
        warnings->push_back(std::string("robot_state: joints ignored because ") + reason + ": " + nameList(names));
    };
    add("the robot does not have them", unknown_);
    add("they are fixed", fixed_);
    add("they follow other joints", mimic_);
  }

 private:
  void readJoint(const std::string& name, double position)
  {
    if (robot_.variableIndex(name) >= 0)
    {
      insertOnce(state_.variables, name, position, "robot_state: the position");
      return;
    }
    const int index = robot_.jointIndex(name);
    if (index < 0)
    {
      unknown_.push_back(name);
      return;
    }
    const Joint& joint = robot_.joints()[static_cast<std::size_t>(index)];
    if (!joint.mimic && joint.type != JointType::Fixed)
      throw Error("robot_state: joint '" + name + "' has several variables; name them as '" +
                  robot_.variables()[static_cast<std::size_t>(joint.first_variable)].name +
                  "' and so on, or use multi_dof_joint_state");
    (joint.mimic ? mimic_ : fixed_).push_back(name);
  }

  void readTransform(const Joint& joint, const std::string& frame, const geometry_msgs::Transform& transform)
  {
    const std::string where = "robot_state: multi_dof_joint_state of '" + joint.name + "'";
    auto variable = static_cast<std::size_t>(joint.first_variable);
    for (const double value : variablesOfTransform(robot_, joint, frame, transform, where))
      insertOnce(state_.variables, robot_.variables()[variable++].name, value, "robot_state: the position");
  }

  const RobotModel& robot_;
  StateChange& state_;
  std::vector<std::string> unknown_;
  std::vector<std::string> fixed_;
  std::vector<std::string> mimic_;
};

StateChange stateFrom(const RobotState& message, const RobotModel& robot, InlineMeshes& meshes,
                      std::vector<std::string>* warnings)
{
  StateChange state;
  StateReader reader(robot, state);
  reader.read(message.joint_state);
  reader.read(message.multi_dof_joint_state);
  reader.warn(warnings);
  for (const AttachedCollisionObject& attached : message.attached_collision_objects)
    state.attached.push_back(attachedChangeFrom(attached, meshes));
  state.is_diff = message.is_diff;
  return state;
}

void readFixedFrames(const PlanningSceneMessage& message, const RobotModel& robot, SceneChange& change)
{
  for (const geometry_msgs::TransformStamped& frame : message.fixed_frame_transforms)
  {
    const std::optional<std::string> name =
        fixedFrameName(frame.header.frame_id, frame.child_frame_id, robot.planningFrame());
    if (!name)
      throw Error("the fixed frame between '" + frame.header.frame_id + "' and '" + frame.child_frame_id +
                  "': one of them must be the planning frame '" + robot.planningFrame() + "'");
    insertOnce(change.fixed_frames, *name, isometryOf(frame.transform.translation, frame.transform.rotation),
               "the fixed frame");
  }
}

/// Checks the limits before memory is allocated for the matrix. The matrix repeats each name in the entries of all
/// other names, so long names count more.
void requireLimits(const AllowedCollisionMatrixMessage& message, const SceneLimits& limits)
{
  constexpr std::size_t kBytesOfAnEntry = 64;
  std::size_t entries = 0;
  const auto count = [&](const std::vector<std::string>& names, std::size_t entries_of_each)
  {
    for (const std::string& name : names)
    {
      if (limits.name_length != 0 && name.size() > limits.name_length)
        throw Error("allowed_collision_matrix: a name of " + std::to_string(name.size()) + " bytes; at most " +
                    std::to_string(limits.name_length) + " are allowed (limits/name_length)");
      entries += entries_of_each * (1 + name.size() / kBytesOfAnEntry);
    }
  };
  count(message.entry_names, message.entry_names.size());
  count(message.default_entry_names, 1);
  if (limits.matrix_entries != 0 && entries > limits.matrix_entries)
    throw Error("allowed_collision_matrix: " + std::to_string(entries) + " entries (each " +
                std::to_string(kBytesOfAnEntry) + " bytes of a name count as one); at most " +
                std::to_string(limits.matrix_entries) + " are allowed (limits/matrix_entries)");
}
}  // namespace

AllowedCollisionMatrix matrixFrom(const AllowedCollisionMatrixMessage& message, const SceneLimits& limits)
{
  requireLimits(message, limits);
  const std::vector<std::string>& names = message.entry_names;
  const auto& rows = message.entry_values;
  requireAsMany(rows.size(), names.size(), "allowed_collision_matrix.entry_values");
  requireAsMany(message.default_entry_values.size(), message.default_entry_names.size(),
                "allowed_collision_matrix.default_entry_values");
  std::set<std::string> seen;
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    requireAsMany(rows[i].enabled.size(), names.size(), "allowed_collision_matrix: the row of '" + names[i] + "'");
    if (!seen.insert(names[i]).second)
      throw Error("allowed_collision_matrix: '" + names[i] + "' is in entry_names twice");
  }
  AllowedCollisionMatrix matrix;
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t j = i + 1; j < names.size(); ++j)
    {
      if ((rows[i].enabled[j] != 0) != (rows[j].enabled[i] != 0))
        throw Error("allowed_collision_matrix: it is not symmetric for '" + names[i] + "' and '" + names[j] + "'");
      matrix.setEntry(names[i], names[j], rows[i].enabled[j] != 0);
    }
  for (std::size_t i = 0; i < message.default_entry_names.size(); ++i)
    matrix.setDefault(message.default_entry_names[i], message.default_entry_values[i] != 0);
  return matrix;
}

ObjectChange objectChangeFrom(const CollisionObject& message)
{
  InlineMeshes meshes;
  return objectChangeFrom(message, meshes);
}

AttachedChange attachedChangeFrom(const AttachedCollisionObject& message)
{
  InlineMeshes meshes;
  return attachedChangeFrom(message, meshes);
}

SolidRule solidRuleFrom(const BodySolid& message)
{
  switch (message.solid)
  {
    case BodySolid::AUTO:
      return SolidRule::Auto;
    case BodySolid::SURFACE:
      return SolidRule::Surface;
    case BodySolid::FILLED:
      return SolidRule::Filled;
    default:
      throw Error("solids: the rule of '" + message.id + "' is " + std::to_string(static_cast<int>(message.solid)) +
                  "; known are AUTO (0), SURFACE (1) and FILLED (2)");
  }
}

SceneChange changeFrom(const PlanningSceneMessage& message, const RobotModel& robot, const SceneLimits& limits,
                       std::vector<std::string>* warnings)
{
  InlineMeshes meshes;
  SceneChange change;
  change.is_diff = message.is_diff;
  change.name = message.name;
  change.robot_model_name = message.robot_model_name;
  readFixedFrames(message, robot, change);
  change.state = stateFrom(message.robot_state, robot, meshes, warnings);
  const AllowedCollisionMatrixMessage& matrix = message.allowed_collision_matrix;
  const bool has_defaults_alone =
      matrix.entry_names.empty() && matrix.entry_values.empty() && !matrix.default_entry_names.empty();
  if (message.is_diff && has_defaults_alone)
  {
    if (warnings != nullptr)
      warnings->push_back(
          "allowed_collision_matrix: ignored: a difference with only default entries changes nothing "
          "(as in MoveIt); give entry_names and entry_values too");
  }
  else if (!matrix.entry_names.empty() || !matrix.entry_values.empty() || !matrix.default_entry_names.empty() ||
           !matrix.default_entry_values.empty())
    change.matrix = matrixFrom(matrix, limits);
  for (const LinkPadding& padding : message.link_padding)
    insertOnce(change.link_padding, padding.link_name, padding.padding, "the padding");
  for (const LinkScale& scale : message.link_scale)
    insertOnce(change.link_scale, scale.link_name, scale.scale, "the scale");
  for (const ObjectColor& color : message.object_colors)
    insertOnce(change.colors, color.id, Color{color.color.r, color.color.g, color.color.b, color.color.a}, "the color");
  for (const BodySolid& solid : message.solids)
    insertOnce(change.solids, solid.id, solidRuleFrom(solid), "the solid");
  for (const CollisionObject& object : message.world.collision_objects)
    change.objects.push_back(objectChangeFrom(object, meshes));
  if (std::optional<ObjectChange> octomap = octomapChangeFrom(message.world.octomap, limits.voxels))
    change.objects.push_back(std::move(*octomap));
  return change;
}
}  // namespace gpu_planning_scene::core
