#include <optional>
#include <string>

#include "base/text/nearest_key.h"
#include "gpu_planning_scene/error.h"
#include "model/full_states.h"
#include "node/endpoints/respond.h"
#include "node/kinematics/kinematics_services.h"
#include "node/messages/pose_messages.h"
#include "node/messages/requested_states.h"
#include "scene/frame.h"
#include "service/service_errors.h"

// The service ~compute_fk.
namespace gpu_planning_scene::core
{
namespace
{
std::vector<LocatedFrame> requestedFrames(const PlanningScene& scene, const std::vector<std::string>& names)
{
  if (names.empty())
    throw Error("frames is empty; name at least one link, object or OBJECT/SUBFRAME");
  std::vector<LocatedFrame> frames;
  for (const std::string& name : names)
  {
    const std::optional<LocatedFrame> frame = locateFrame(scene, name);
    if (!frame)
    {
      const std::string near = didYouMean(name, frameNames(scene));
      throw Error("the scene has no frame '" + name + "'" +
                  (near.empty() ? "; name a link, an object, OBJECT/SUBFRAME, or a fixed frame" : near));
    }
    frames.push_back(*frame);
  }
  return frames;
}
}  // namespace

ComputeFk::Response KinematicsServices::computeFk(const ComputeFk::Request& request) const
{
  return respond<ComputeFk::Response>(
      [&](ComputeFk::Response& response)
      {
        memory_.require();
        const RequestedScene requested = requestedScene(store_, others_.pose, request.scene_diff, {});
        const Snapshot& now = requested.now;
        const RobotModel& robot = *now.scene->robot;
        const std::vector<LocatedFrame> frames = requestedFrames(*now.scene, request.frames);
        const auto few = [&](std::size_t states)
        {
          if (states > options_.max_poses / frames.size())
            throw Error(std::to_string(states) + " states with " + std::to_string(frames.size()) +
                        " frames each; an answer may have " + std::to_string(options_.max_poses) +
                        " poses (limits/request_states): send fewer states per request");
        };
        std::vector<int> columns;
        if (!request.joint_names.empty() || !request.positions.empty())
          columns =
              requestedColumns(robot, {"joint_names", request.joint_names}, {"positions", request.positions}, few);
        const std::size_t count = columns.empty() ? 1 : request.positions.size() / columns.size();
        few(count);
        const std::vector<double> states =
            fullStates(robot, columns, request.positions.data(), count, now.partialState());
        std::vector<Eigen::Isometry3d> links(robot.links().size());
        geometry_msgs::PoseStamped message;
        message.header.frame_id = robot.planningFrame();
        response.poses.reserve(count * frames.size());
        for (std::size_t i = 0; i < count; ++i)
        {
          if (stopping_)
            throw ShuttingDown();
          robot.linkPoses(states.data() + i * robot.variables().size(), links.data());
          for (const LocatedFrame& frame : frames)
          {
            const Eigen::Isometry3d in_parent = frame.object * frame.subframe;
            message.pose = poseOf(frame.link < 0 ? in_parent : links[static_cast<std::size_t>(frame.link)] * in_parent);
            response.poses.push_back(message);
          }
        }
        response.scene_revision = now.scene->revision;
        addWarnings(requested.warnings, response.message);
        addWarning(now.assumedBase(columns), response.message);
      });
}
}  // namespace gpu_planning_scene::core
