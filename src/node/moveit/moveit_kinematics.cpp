#include "node/moveit/moveit_kinematics.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <ros/serialization.h>

#include "gpu_planning_scene/error.h"
#include "node/endpoints/topic_warnings.h"
#include "node/messages/object_from_message.h"
#include "node/messages/pose_messages.h"
#include "node/messages/to_messages.h"
#include "node/moveit/mimic_joints.h"

namespace gpu_planning_scene::core
{
namespace
{
using moveit_msgs::MoveItErrorCodes;

/// A request that is refused, with MoveIt's error code.
class Refused : public Error
{
 public:
  Refused(std::int32_t code, const std::string& what) : Error(what), code_(code) {}
  std::int32_t code() const { return code_; }

 private:
  std::int32_t code_;
};

/// A message as another type of the same layout (requireMoveItLayouts).
template <class To, class From>
To sameBytes(const From& from)
{
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(from));
  ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(out, from);
  ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  To to;
  ros::serialization::deserialize(in, to);
  return to;
}

/// Fills the response. An error becomes an error code and a warning in the log.
template <class Response, class Fill>
Response answered(const char* service, const Fill& fill)
{
  static OccasionalWarning warning;
  Response response;
  try
  {
    response.error_code.val = MoveItErrorCodes::SUCCESS;
    fill(response);
  }
  catch (const Refused& refused)
  {
    response = Response();
    response.error_code.val = refused.code();
    warning.log(std::string(service) + ": " + refused.what());
  }
  catch (const std::exception& error)
  {
    response = Response();
    response.error_code.val = MoveItErrorCodes::FAILURE;
    warning.log(std::string(service) + ": " + error.what());
  }
  return response;
}

template <class Response>
void requireSuccess(const Response& response)
{
  if (!response.success)
    throw Refused(MoveItErrorCodes::FAILURE, response.message);
}

bool isEmpty(const moveit_msgs::Constraints& constraints)
{
  return constraints.joint_constraints.empty() && constraints.position_constraints.empty() &&
         constraints.orientation_constraints.empty() && constraints.visibility_constraints.empty();
}

/// The same constraints in the messages of this package.
Constraints oursOf(const moveit_msgs::Constraints& theirs)
{
  if (!theirs.visibility_constraints.empty())
    throw Refused(MoveItErrorCodes::FAILURE, "path constraints of visibility are not evaluated; leave them out");
  Constraints ours;
  ours.name = theirs.name;
  for (const moveit_msgs::JointConstraint& from : theirs.joint_constraints)
  {
    auto& to = ours.joint_constraints.emplace_back();
    to.joint_name = from.joint_name;
    to.position = from.position;
    to.tolerance_above = from.tolerance_above;
    to.tolerance_below = from.tolerance_below;
  }
  for (const moveit_msgs::PositionConstraint& from : theirs.position_constraints)
  {
    if (!from.constraint_region.meshes.empty())
      throw Refused(MoveItErrorCodes::FAILURE, "path constraints: a region is a mesh; use a box or a sphere");
    auto& to = ours.position_constraints.emplace_back();
    to.header = from.header;
    to.link_name = from.link_name;
    to.target_point_offset = from.target_point_offset;
    to.constraint_region.primitives = from.constraint_region.primitives;
    to.constraint_region.primitive_poses = from.constraint_region.primitive_poses;
  }
  for (const moveit_msgs::OrientationConstraint& from : theirs.orientation_constraints)
  {
    auto& to = ours.orientation_constraints.emplace_back();
    to.header = from.header;
    to.orientation = from.orientation;
    to.link_name = from.link_name;
    to.absolute_x_axis_tolerance = from.absolute_x_axis_tolerance;
    to.absolute_y_axis_tolerance = from.absolute_y_axis_tolerance;
    to.absolute_z_axis_tolerance = from.absolute_z_axis_tolerance;
    to.parameterization = from.parameterization;
  }
  return ours;
}

/// Newer versions of MoveIt's message have this field.
template <class Request>
auto cartesianSpeed(const Request& request, int /*preferred*/) -> decltype(request.max_cartesian_speed)
{
  return request.max_cartesian_speed;
}
template <class Request>
double cartesianSpeed(const Request& /*request*/, long /*otherwise*/)
{
  return 0.0;
}

/// A robot state with these values.
moveit_msgs::RobotState stateOf(const RobotModel& robot, const std::vector<std::string>& names, const double* values)
{
  SceneChange change;
  change.is_diff = true;
  for (std::size_t i = 0; i < names.size(); ++i)
    change.state.variables[names[i]] = values[i];
  return sameBytes<moveit_msgs::RobotState>(messageOf(change, robot).robot_state);
}
}  // namespace

void MoveItKinematics::requireGroup(const std::string& group) const
{
  const std::vector<Group>& groups = store_.snapshot().scene->robot->groups();
  if (std::none_of(groups.begin(), groups.end(), [&group](const Group& each) { return each.name == group; }))
    throw Refused(MoveItErrorCodes::INVALID_GROUP_NAME, "the robot has no group '" + group + "'");
}

/// The scene with the robot's state of a request. As for check_state_validity, joints that it does not name keep their
/// current values.
PlanningSceneMessage MoveItKinematics::changeOf(const moveit_msgs::RobotState& state) const
{
  PlanningSceneMessage change;
  change.is_diff = true;
  change.robot_state = sameBytes<RobotState>(state);
  const Snapshot now = store_.snapshot();
  if (const std::string fault = mimicFault(change, *now.scene->robot, now.state); !fault.empty())
    throw Refused(MoveItErrorCodes::INVALID_ROBOT_STATE, fault);
  return withoutMimicJoints(std::move(change), *now.scene->robot);
}

moveit_msgs::GetPositionIK::Response MoveItKinematics::ik(const moveit_msgs::GetPositionIK::Request& request) const
{
  using Response = moveit_msgs::GetPositionIK::Response;
  return answered<Response>(
      "compute_ik",
      [&](Response& response)
      {
        const moveit_msgs::PositionIKRequest& wanted = request.ik_request;
        requireGroup(wanted.group_name);
        if (!isEmpty(wanted.constraints))
          throw Refused(MoveItErrorCodes::FAILURE,
                        "constraints are not evaluated; leave them empty, or plan to "
                        "goal_constraints with ~plan");
        if (wanted.ik_link_names.size() > 1 || wanted.pose_stamped_vector.size() > 1)
          throw Refused(MoveItErrorCodes::FAILURE, "poses of several links are not solved; give one link");
        ComputeIk::Request ours;
        ours.group = wanted.group_name;
        ours.link = wanted.ik_link_names.empty() ? wanted.ik_link_name : wanted.ik_link_names.front();
        ours.poses = {wanted.pose_stamped_vector.empty() ? wanted.pose_stamped : wanted.pose_stamped_vector.front()};
        ours.ignore_collisions = wanted.avoid_collisions == 0;
        ours.scene_diff = changeOf(wanted.robot_state);
        const ComputeIk::Response found = kinematics_.computeIk(ours);
        requireSuccess(found);
        if (found.pose_status.front() != ComputeIk::Response::SOLVED)
          throw Refused(MoveItErrorCodes::NO_IK_SOLUTION, found.faults.front());
        response.solution = stateOf(*store_.snapshot().scene->robot, found.joint_names, found.solutions.data());
      });
}

moveit_msgs::GetPositionFK::Response MoveItKinematics::fk(const moveit_msgs::GetPositionFK::Request& request) const
{
  using Response = moveit_msgs::GetPositionFK::Response;
  return answered<Response>(
      "compute_fk",
      [&](Response& response)
      {
        if (request.fk_link_names.empty())
          throw Refused(MoveItErrorCodes::INVALID_LINK_NAME, "fk_link_names is empty; name at least one link");
        ComputeFk::Request ours;
        ours.frames = request.fk_link_names;
        const bool is_in_frame = !request.header.frame_id.empty();
        if (is_in_frame)
          ours.frames.push_back(request.header.frame_id == store_.snapshot().scene->robot->planningFrame()
                                    ? ""
                                    : request.header.frame_id);
        ours.scene_diff = changeOf(request.robot_state);
        const ComputeFk::Response found = kinematics_.computeFk(ours);
        requireSuccess(found);
        for (std::size_t i = 0; i < request.fk_link_names.size(); ++i)
        {
          response.pose_stamped.push_back(found.poses[i]);
          if (!is_in_frame)
            continue;
          geometry_msgs::PoseStamped& pose = response.pose_stamped.back();
          pose.header = request.header;
          pose.pose = poseOf(isometryOf(found.poses.back().pose).inverse() * isometryOf(pose.pose));
        }
        response.fk_link_names = request.fk_link_names;
      });
}

moveit_msgs::GetCartesianPath::Response MoveItKinematics::lines(
    const moveit_msgs::GetCartesianPath::Request& request) const
{
  using Response = moveit_msgs::GetCartesianPath::Response;
  return answered<Response>(
      "compute_cartesian_path",
      [&](Response& response)
      {
        requireGroup(request.group_name);
        if (!(request.max_step > 0.0))
          throw Refused(MoveItErrorCodes::FAILURE, "max_step must be above 0");
        if (cartesianSpeed(request, 0) > 0.0)
          throw Refused(MoveItErrorCodes::FAILURE,
                        "max_cartesian_speed is not supported; leave it 0, and scale the trajectory's times");
        ComputeCartesianPath::Request ours;
        ours.group = request.group_name;
        ours.link = request.link_name;
        for (const geometry_msgs::Pose& pose : request.waypoints)
        {
          ours.waypoints.emplace_back();
          ours.waypoints.back().header = request.header;
          ours.waypoints.back().pose = pose;
        }
        ours.max_step = request.max_step;
        for (const double threshold : {request.revolute_jump_threshold, request.prismatic_jump_threshold})
          if (threshold > 0.0)
            ours.max_joint_step = ours.max_joint_step > 0.0 ? std::min(ours.max_joint_step, threshold) : threshold;
        ours.ignore_collisions = request.avoid_collisions == 0;
        ours.path_constraints = oursOf(request.path_constraints);
        ours.scene_diff = changeOf(request.start_state);
        ours.times = 1;
        const ComputeCartesianPath::Response found = kinematics_.computeCartesianPath(ours);
        requireSuccess(found);
        response.start_state = stateOf(*store_.snapshot().scene->robot, found.trajectory.joint_names,
                                       found.trajectory.points.front().positions.data());
        response.solution.joint_trajectory = found.trajectory;
        response.fraction = found.fraction;
      });
}
}  // namespace gpu_planning_scene::core
