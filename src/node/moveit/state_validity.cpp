#include "node/moveit/state_validity.h"

#include <algorithm>

#include "gpu_planning_scene/error.h"
#include "node/endpoints/topic_warnings.h"
#include "node/moveit/mimic_joints.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kContactsPerPair = 1;  // as in MoveIt

void requireNoConstraints(const moveit_msgs::Constraints& constraints)
{
  if (!constraints.joint_constraints.empty() || !constraints.position_constraints.empty() ||
      !constraints.orientation_constraints.empty() || !constraints.visibility_constraints.empty())
    throw Error("constraints cannot be evaluated; leave them empty");
}

/// Elsewhere, unknown joints are left out with a warning. Here the answer would be that of another state.
void requireKnownJoints(const RobotState& state, const RobotModel& robot)
{
  const auto require = [&robot](const std::string& name)
  {
    if (robot.variableIndex(name) < 0 && robot.jointIndex(name) < 0)
      throw Error("robot_state names '" + name + "', which is no joint of the robot");
  };
  for (const std::string& name : state.joint_state.name)
    require(name);
  for (const std::string& name : state.multi_dof_joint_state.joint_names)
    require(name);
}

moveit_msgs::ContactInformation moveItContact(const ContactInformation& ours)
{
  moveit_msgs::ContactInformation contact;
  contact.header.frame_id = ours.header.frame_id;
  contact.header.stamp = ros::Time::now();
  contact.position = ours.position;
  contact.normal = ours.normal;
  contact.depth = ours.depth;
  contact.contact_body_1 = ours.contact_body_1;
  contact.body_type_1 = ours.body_type_1;
  contact.contact_body_2 = ours.contact_body_2;
  contact.body_type_2 = ours.body_type_2;
  return contact;
}
}  // namespace

StateValidity::StateValidity(const SceneStore& store, const SceneServices& changes, CheckServices& checks,
                             std::size_t max_contacts)
  : store_(store), changes_(changes), checks_(checks), max_contacts_(max_contacts)
{
}

MoveItStateValidity::Response StateValidity::answer(const StateValidityRequest& request) const
{
  requireNoConstraints(request.constraints);
  const Snapshot now = store_.snapshot();
  requireKnownJoints(request.robot_state, *now.scene->robot);
  PlanningSceneMessage message;
  message.is_diff = true;
  message.robot_state = request.robot_state;
  if (const std::string fault = mimicFault(message, *now.scene->robot, now.state); !fault.empty())
    throw Error(fault);
  message = withoutMimicJoints(std::move(message), *now.scene->robot);
  const SceneChange change = changes_.changeOf(message);
  const std::map<std::string, double>& variables = change.state.variables;
  const bool replaces_attached = !change.state.is_diff && !variables.empty() && !now.scene->attached.empty();

  const std::size_t bodies = now.scene->robot->links().size() + now.scene->objects.size() + now.scene->attached.size() +
                             change.state.attached.size();
  CheckStates::Request check;
  check.group = request.group_name;
  check.max_contacts = static_cast<std::uint32_t>(std::min(bodies * bodies, max_contacts_));
  check.max_contacts_per_pair = kContactsPerPair;
  if (change.state.attached.empty() && !replaces_attached)
    for (const auto& [name, value] : variables)
    {
      check.joint_names.push_back(name);
      check.positions.push_back(value);
    }
  else
    check.scene_diff = message;
  const CheckStates::Response checked = checks_.checkStates(check);
  if (!checked.success)
    throw Error(checked.message);
  if (!checked.message.empty())
    warnOfMessage({"check_state_validity: " + checked.message});
  MoveItStateValidity::Response response;
  response.valid = checked.valid.front();
  std::transform(checked.contacts.begin(), checked.contacts.end(), std::back_inserter(response.contacts),
                 moveItContact);
  return response;
}
}  // namespace gpu_planning_scene::core
