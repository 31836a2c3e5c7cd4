#include "moveit/planner/request.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <moveit/robot_state/conversions.h>

#include "moveit/planner/refusal.h"

// MoveIt's conversion of a start state logs the parts that it cannot use, and leaves them out. Here the request is
// refused, because without these parts it would be planned for another start.
namespace gpu_planning_scene::pipeline
{
namespace
{
using moveit::core::JointModel;
using moveit::core::RobotState;

[[noreturn]] void refuseStart(const std::string& fault)
{
  throw Refusal(MoveItErrorCodes::INVALID_ROBOT_STATE, "start_state: " + fault);
}

bool isConstrained(const moveit_msgs::Constraints& constraints)
{
  return !constraints.joint_constraints.empty() || !constraints.position_constraints.empty() ||
         !constraints.orientation_constraints.empty() || !constraints.visibility_constraints.empty();
}

bool isFinite(const geometry_msgs::Transform& transform)
{
  const geometry_msgs::Vector3& translation = transform.translation;
  const geometry_msgs::Quaternion& rotation = transform.rotation;
  return std::isfinite(translation.x) && std::isfinite(translation.y) && std::isfinite(translation.z) &&
         std::isfinite(rotation.x) && std::isfinite(rotation.y) && std::isfinite(rotation.z) &&
         std::isfinite(rotation.w);
}

bool knowsFrame(const planning_scene::PlanningScene& scene, const RobotState& state, const std::string& frame)
{
  return state.knowsFrameTransform(frame) || scene.getTransforms().canTransform(frame);
}

void validateJoints(const moveit_msgs::RobotState& message, const planning_scene::PlanningScene& scene)
{
  const moveit::core::RobotModel& model = *scene.getRobotModel();
  if (message.joint_state.name.size() != message.joint_state.position.size())
    refuseStart("joint_state has " + std::to_string(message.joint_state.name.size()) + " names and " +
                std::to_string(message.joint_state.position.size()) + " positions; give one position per name");
  for (std::size_t i = 0; i < message.joint_state.name.size(); ++i)
    if (!std::isfinite(message.joint_state.position[i]))
      refuseStart("the position of joint '" + message.joint_state.name[i] + "' is not finite");
  const sensor_msgs::MultiDOFJointState& joints = message.multi_dof_joint_state;
  if (joints.joint_names.size() != joints.transforms.size())
    refuseStart("multi_dof_joint_state has " + std::to_string(joints.joint_names.size()) + " names and " +
                std::to_string(joints.transforms.size()) + " transforms; give one transform per name");
  for (std::size_t i = 0; i < joints.joint_names.size(); ++i)
    if (!model.hasJointModel(joints.joint_names[i]))
      refuseStart("multi_dof_joint_state names joint '" + joints.joint_names[i] + "', which the robot does not have");
    else if (!isFinite(joints.transforms[i]))
      refuseStart("the transform of joint '" + joints.joint_names[i] + "' is not finite");
  if (!joints.joint_names.empty() &&
      !moveit::core::Transforms::sameFrame(joints.header.frame_id, model.getModelFrame()) &&
      !scene.getTransforms().canTransform(joints.header.frame_id))
    throw Refusal(MoveItErrorCodes::FRAME_TRANSFORM_FAILURE, "start_state: multi_dof_joint_state is in the frame '" +
                                                                 joints.header.frame_id +
                                                                 "', which the scene does not know");
}

/// Whether MoveIt has made the attached object that the message describes.
void validateAttached(const moveit_msgs::AttachedCollisionObject& message, const planning_scene::PlanningScene& scene,
                      const RobotState& state)
{
  const std::string where = "attached object '" + message.object.id + "' ";
  if (message.object.operation == moveit_msgs::CollisionObject::REMOVE)
    return;
  if (message.object.operation != moveit_msgs::CollisionObject::ADD)
    refuseStart(where + "has an operation other than ADD and REMOVE");
  if (!state.getRobotModel()->hasLinkModel(message.link_name))
    refuseStart(where + "is attached to link '" + message.link_name + "', which the robot does not have");
  const std::string& frame = message.object.header.frame_id;
  if (!moveit::core::Transforms::sameFrame(frame, message.link_name) && !knowsFrame(scene, state, frame))
    throw Refusal(MoveItErrorCodes::FRAME_TRANSFORM_FAILURE,
                  "start_state: " + where + "is in the frame '" + frame + "', which the scene does not know");
  const moveit::core::AttachedBody* body = state.getAttachedBody(message.object.id);
  const std::size_t shapes =
      message.object.primitives.size() + message.object.meshes.size() + message.object.planes.size();
  if (!body || shapes == 0 || body->getShapes().size() != shapes)
    refuseStart(where + "has no shape, a shape that is not valid, or not one pose for each shape");
  const auto is_finite = [](const Eigen::Isometry3d& pose) { return pose.matrix().allFinite(); };
  if (!is_finite(body->getPose()) ||
      !std::all_of(body->getShapePoses().begin(), body->getShapePoses().end(), is_finite))
    refuseStart(where + "has a pose that is not finite");
}

/// The scene's current state can have such values too.
void requireFinite(const RobotState& state)
{
  for (const std::string& name : state.getVariableNames())
    if (!std::isfinite(state.getVariablePosition(name)))
      throw Refusal(MoveItErrorCodes::INVALID_ROBOT_STATE,
                    "the start: the position of joint '" + name + "' is not finite");
}

bool hasTranslationWithoutLimits(const moveit::core::JointModelGroup& group)
{
  for (const JointModel* joint : group.getActiveJointModels())
  {
    const int translations = joint->getType() == JointModel::PLANAR     ? 2
                             : joint->getType() == JointModel::FLOATING ? 3
                                                                        : 0;
    for (int i = 0; i < translations; ++i)
      if (!hasLimits(joint->getVariableBounds()[static_cast<std::size_t>(i)]))
        return true;
  }
  return false;
}

bool hasTranslation(const moveit::core::JointModelGroup& group)
{
  for (const JointModel* joint : group.getActiveJointModels())
    if (joint->getType() == JointModel::PLANAR || joint->getType() == JointModel::FLOATING)
      return true;
  return false;
}
}  // namespace

void requireSupported(const planning_interface::MotionPlanRequest& request, const moveit::core::RobotModel& model)
{
  if (!model.hasJointModelGroup(request.group_name))
    throw Refusal(MoveItErrorCodes::INVALID_GROUP_NAME, "the robot has no group '" + request.group_name + "'");
  if (!request.path_constraints.visibility_constraints.empty())
    throw Refusal(MoveItErrorCodes::PLANNING_FAILED,
                  "path constraints of visibility are not planned for; use another pipeline");
  if (!request.trajectory_constraints.constraints.empty())
    throw Refusal(MoveItErrorCodes::PLANNING_FAILED,
                  "trajectory constraints are not planned for; use another pipeline");
  if (request.goal_constraints.empty())
    throw Refusal(MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS, "there is no goal; give goal_constraints");
  for (const moveit_msgs::Constraints& goal : request.goal_constraints)
  {
    if (!isConstrained(goal))
      throw Refusal(MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS, "a goal has no constraint");
    if (!goal.visibility_constraints.empty())
      throw Refusal(MoveItErrorCodes::UNRECOGNIZED_GOAL_TYPE,
                    "goals of visibility constraints are not planned for; use another pipeline");
  }
  requirePlannable(*model.getJointModelGroup(request.group_name));
}

RobotState startOf(const planning_interface::MotionPlanRequest& request, const planning_scene::PlanningScene& scene)
{
  RobotState state = scene.getCurrentState();
  const moveit_msgs::RobotState& message = request.start_state;
  const bool is_empty = message.joint_state.name.empty() && message.joint_state.position.empty() &&
                        message.multi_dof_joint_state.joint_names.empty() &&
                        message.multi_dof_joint_state.transforms.empty();
  if (message.is_diff || !is_empty)
  {
    validateJoints(message, scene);
    // MoveIt keeps an object of the same name if the new one is not valid. It must not pass for the new one.
    for (const moveit_msgs::AttachedCollisionObject& attached : message.attached_collision_objects)
      if (attached.object.operation == moveit_msgs::CollisionObject::ADD)
        state.clearAttachedBody(attached.object.id);
    try
    {
      if (!moveit::core::robotStateMsgToRobotState(scene.getTransforms(), message, state))
        refuseStart("MoveIt cannot convert it");
    }
    catch (const std::runtime_error& error)
    {
      refuseStart(error.what());
    }
    state.update();
    for (const moveit_msgs::AttachedCollisionObject& attached : message.attached_collision_objects)
      validateAttached(attached, scene, state);
  }
  else if (!message.attached_collision_objects.empty())
    refuseStart("it has attached objects, but no joints; set is_diff to add the objects to the current state");
  requireFinite(state);
  state.update();
  return state;
}

std::optional<Eigen::AlignedBox3d> workspaceOf(const planning_interface::MotionPlanRequest& request,
                                               const planning_scene::PlanningScene& scene,
                                               const moveit::core::JointModelGroup& group)
{
  if (!hasTranslation(group))
    return std::nullopt;
  const moveit_msgs::WorkspaceParameters& parameters = request.workspace_parameters;
  Eigen::AlignedBox3d box(Eigen::Vector3d(parameters.min_corner.x, parameters.min_corner.y, parameters.min_corner.z),
                          Eigen::Vector3d(parameters.max_corner.x, parameters.max_corner.y, parameters.max_corner.z));
  if (box.min().isZero(0.0) && box.max().isZero(0.0))
  {
    if (!hasTranslationWithoutLimits(group))
      return std::nullopt;
    throw Refusal(MoveItErrorCodes::PLANNING_FAILED,
                  "group '" + group.getName() +
                      "' has a planar or floating joint without limits; set workspace_parameters, the range in which "
                      "it is planned for");
  }
  if (!box.min().allFinite() || !box.max().allFinite() || (box.min().array() > box.max().array()).any())
    throw Refusal(MoveItErrorCodes::PLANNING_FAILED,
                  "workspace_parameters: the corners must be finite, and min_corner must not be above max_corner");
  const std::string& frame = parameters.header.frame_id;
  if (frame.empty() || moveit::core::Transforms::sameFrame(frame, scene.getPlanningFrame()))
    return box;
  if (!scene.knowsFrameTransform(frame))
    throw Refusal(MoveItErrorCodes::FRAME_TRANSFORM_FAILURE,
                  "workspace_parameters are in the frame '" + frame + "', which the scene does not know");
  const Eigen::Isometry3d& pose = scene.getFrameTransform(frame);
  if (!pose.linear().isIdentity(1e-9))
    throw Refusal(MoveItErrorCodes::FRAME_TRANSFORM_FAILURE, "workspace_parameters are in the frame '" + frame +
                                                                 "', which is rotated; give them in the frame '" +
                                                                 scene.getPlanningFrame() + "'");
  return box.translate(pose.translation());
}
}  // namespace gpu_planning_scene::pipeline
