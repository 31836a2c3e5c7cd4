// Feeds arbitrary bytes as requests and messages to the node's handlers. Each message must be accepted or refused, with
// one line of text. An input is a sequence of messages to a node that has just started. Each message has one byte for
// its kind, two for its length, and its content.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "fuzz/fuzz_target.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
#include "gpu_planning_scene/planning/group_state_space.h"
#include "node/checks/check_services.h"
#include "node/endpoints/bounded_message.h"
#include "node/endpoints/respond.h"
#include "node/markers/scene_markers.h"
#include "node/messages/exact_numbers.h"
#include "node/messages/from_messages.h"
#include "node/messages/requested_timing.h"
#include "node/messages/sensor_messages.h"
#include "node/messages/to_messages.h"
#include "node/planning/plan_request.h"
#include "node/planning/requested_goals.h"
#include "node/scene/scene_services.h"
#include "node/sensors/cloud_topic.h"
#include "node/sensors/sensed_object.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kMaxStates = 200;

SceneLimits fewThings()
{
  SceneLimits limits;
  limits.objects = 20;
  limits.shapes = 50;
  limits.voxels = 30;
  limits.triangles = 500;
  limits.triangles_of_mesh = 200;
  limits.matrix_entries = 10000;
  return limits;
}

CheckServerOptions fewStates()
{
  CheckServerOptions options;
  options.small_request = 64;
  options.max_states = kMaxStates;
  return options;
}

PointCloudOptions fewVoxels()
{
  PointCloudOptions options;
  options.max_voxels = 50;
  return options;
}

PlanServiceOptions fewGoals()
{
  PlanServiceOptions options;
  options.max_goals = 20;
  return options;
}

CheckServicesOptions fewChecks()
{
  CheckServicesOptions options;
  options.max_states = kMaxStates;
  options.max_motion_checks = 100 * kMaxStates;
  options.max_inspected_states = 10;
  options.revision_wait = std::chrono::milliseconds(0);
  return options;
}

/// As a planners.yaml with settings for one group.
GroupPlanners plannersOf(const std::string& group)
{
  GroupPlanners planners;
  if (group == "drive")
  {
    planners.projection = {"slide", "turn"};
    planners.longest_valid_segment_fraction = 0.005;
  }
  return planners;
}

OccupancyMapOptions smallMap()
{
  OccupancyMapOptions options;
  options.max_voxels = fewVoxels().max_voxels;
  return options;
}

/// Replaces tf. It knows one frame.
Eigen::Isometry3d frameOfTf(const StampedFrame& frame)
{
  if (frame.name != "tf")
    throw Error("frame '" + frame.name + "' is not known");
  return Eigen::Translation3d(1.0, 2.0, 3.0) * Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
}

/// The node's handlers without a ROS master.
class Handlers
{
 public:
  explicit Handlers(const std::shared_ptr<const RobotModel>& robot)
    : store_(PlanningScene(robot), {}, fewThings()),
      memory_(std::size_t{1} << 40),
      server_(
          store_,
          [](std::shared_ptr<const PlanningScene> scene) { return std::make_shared<CpuChecker>(std::move(scene)); },
          fewStates()),
      checks_(store_, server_, memory_, fewChecks(), {frameOfTf}),
      scenes_(store_, frameOfTf, memory_),
      clouds_(
          store_, frameOfTf, 0.0, [] { return false; }, memory_, fewVoxels(), "cloud"),
      map_(smallMap())
  {
    store_.setListener(
        this,
        [this](const auto& before, const auto& after)
        {
          const SceneChange change = diffOf(*before, *after);
          PlanningSceneMessage message = messageOf(change, *after->robot);
          keepExactNumbers(change, *after->robot, message);
          requireReadable(message);
        });
  }

  void take(unsigned kind, const std::uint8_t* data, std::uint32_t size)
  {
    const auto make = [this](const auto& message) { scenes_.make(scenes_.changeOf(message), frameOfTf); };
    switch (kind % 17)
    {
      case 0:
        return answer<ApplyPlanningScene>(data, size, [&](const auto& request) { return scenes_.apply(request); });
      case 1:
        return answer<CheckStates>(data, size, [&](const auto& request) { return checks_.checkStates(request); });
      case 2:
        return answer<CheckMotions>(data, size, [&](const auto& request) { return checks_.checkMotions(request); });
      case 3:
        return answer<GetReport>(data, size, [&](const auto& request) { return report(request); });
      case 4:
        return answer<Clear>(data, size, [&](const auto&) { return scenes_.clear(); });
      case 5:
        return read<GetPlanningScene::Request>(data, size, [&](const auto& request) { get(request); });
      case 6:
        return read<PlanningSceneMessage>(data, size, make);
      case 7:
        return read<CollisionObject>(data, size, make);
      case 8:
        return read<AttachedCollisionObject>(data, size, make);
      case 9:
        return read<sensor_msgs::JointState>(data, size, [&](const auto& message) { scenes_.take(message); });
      case 10:
        return read<sensor_msgs::PointCloud2>(data, size, [&](const auto& message) { clouds_.take(message); });
      case 11:
        return read<ShowTreeLevel::Request>(data, size, [&](const auto& request) { draw(request); });
      case 12:
        return read<PlanMotion::Request>(data, size, [&](const auto& request) { plan(request); });
      case 13:
        return read<PlanningSceneMessage>(data, size, [&](const auto& message) { follow(message); });
      case 15:
        return read<sensor_msgs::CameraInfo>(data, size, [&](const auto& message) { camera_ = cameraOf(message); });
      case 16:
        return read<sensor_msgs::Image>(data, size, [&](const auto& message) { see(message); });
      default:
        return answer<CheckTrajectory>(data, size,
                                       [&](const auto& request) { return checks_.checkTrajectory(request); });
    }
  }

 private:
  template <class Service, class Handler>
  static void answer(const std::uint8_t* data, std::uint32_t size, Handler handler)
  {
    read<typename Service::Request>(
        data, size,
        [&](const auto& request)
        {
          const typename Service::Response response = handler(request);
          requireOneLine(response.message, !response.success);
          requireStatus(response.success, response.status);
        });
  }

  /// Ends the program unless the status is set and agrees with `success`.
  static void requireStatus(bool success, std::uint8_t status)
  {
    if (status != 0 && success == (status == AnswerStatus::OK))
      return;
    std::fprintf(stderr, "an answer has the status %u, but success is %d\n", status, success);
    std::abort();
  }

  /// Reads a message as roscpp and then the node's endpoints do.
  template <class M, class Handler>
  static void read(const std::uint8_t* data, std::uint32_t size, Handler handler)
  {
    Bounded<M> bounded;
    // The stream's constructor takes a non-const pointer although it only reads.
    ros::serialization::IStream stream(const_cast<std::uint8_t*>(data), size);
    ros::serialization::deserialize(stream, bounded);
    if (!bounded.fault.empty())
      return requireOneLine(bounded.fault, true);
    requireOneLine(errorOf([&] { handler(bounded.message); }), false);
  }

  GetReport::Response report(const GetReport::Request& request)
  {
    GetReport::Response response = checks_.report(request);
    for (const std::string& line : response.lines)
      requireOneLine(line, false);
    return response;
  }

  /// Makes a change of a followed node.
  void follow(const PlanningSceneMessage& message)
  {
    SceneChange change = changeFrom(message, *store_.snapshot().scene->robot, store_.limits(), nullptr);
    takeExactNumbers(message, change);
    scenes_.follow(change, message.scene_revision);
  }

  void get(const GetPlanningScene::Request& request)
  {
    const GetPlanningScene::Response response = scenes_.get(request);
    requireStatus(response.success, response.status);
    requireReadable(response.scene);
  }

  /// Ends the program unless a node can read a message that the node publishes or answers.
  void requireReadable(const PlanningSceneMessage& message) const
  {
    const auto read_it = [&]
    {
      SceneChange change = changeFrom(message, *store_.snapshot().scene->robot, store_.limits(), nullptr);
      takeExactNumbers(message, change);
    };
    if (const std::string fault = errorOf(read_it); !fault.empty())
    {
      std::fprintf(stderr, "a scene that the node sent is refused: %s\n", fault.c_str());
      std::abort();
    }
  }

  void draw(const ShowTreeLevel::Request& request)
  {
    const Snapshot now = store_.snapshot();
    requireTreeLevel(*now.scene, request.level, request.body);
    MarkerOptions options;
    options.max_triangles = 100;
    options.tree_level = request.level;
    options.tree_body = request.body;
    markersOf(*now.scene, now.state.data(), {}, {}, options);
  }

  /// Reads the request and plans nothing, because planning takes its time for any request.
  void plan(const PlanMotion::Request& request) const
  {
    const PlannerConfig config{"geometric::RRTConnect", {{"range", "0.5"}}};
    const Snapshot now = store_.snapshot();
    const RequestedState start = requestedStart(request, now);
    PlanningQuery query = queryFrom(request, now, start, config, plannersOf(request.group), fewGoals());
    addRegions(request, *now.scene, {frameOfTf}, fewGoals().max_goals, query);
    planWarnings(request, now, start);
    requestedTiming(request, *now.scene->robot, 0.05, query.motions, query.path_constraints);
    requireWithinGroup(query, now.scene->robot);
  }

  /// Ends the program unless all rows have finite values for all variables and the goals differ from the start only in
  /// variables of the group.
  static void requireWithinGroup(const PlanningQuery& query, const std::shared_ptr<const RobotModel>& robot)
  {
    const GroupStateSpace space(robot, query.group);
    const auto fits = [&](std::vector<double> row)
    {
      const auto finite = [](double value) { return std::isfinite(value); };
      if (row.size() != robot->variables().size() || !std::all_of(row.begin(), row.end(), finite))
        return false;
      for (const int variable : space.variables())
        row[static_cast<std::size_t>(variable)] = query.start[static_cast<std::size_t>(variable)];
      return row == query.start;
    };
    if (fits(query.start) && std::all_of(query.goals.begin(), query.goals.end(), fits))
      return;
    std::fprintf(stderr, "a plan request becomes a query that does not fit group '%s'\n", query.group.c_str());
    std::abort();
  }

  /// Takes an image as Sensors does, on this thread.
  void see(const sensor_msgs::Image& message)
  {
    const Snapshot now = store_.snapshot();
    map_.add(depthImageOf(message, camera_), {}, *now.scene, now.state.data());
    replaceObject(store_, kOctomapId, map_.cubes(*now.scene, now.state.data()).cubes);
  }

  SceneStore store_;
  const MemoryGuard memory_;
  CheckServer server_;
  CheckServices checks_;
  SceneServices scenes_;
  CloudTopic clouds_;
  PinholeCamera camera_;
  OccupancyMap map_;
};
}  // namespace
}  // namespace gpu_planning_scene::core

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace gpu_planning_scene::core;
  static const auto robot = sliderRobotOnFloor("floating");
  Handlers handlers(robot);
  while (size >= 3)
  {
    const std::size_t length = std::min<std::size_t>(data[1] | data[2] << 8, size - 3);
    handlers.take(data[0], data + 3, static_cast<std::uint32_t>(length));
    data += 3 + length;
    size -= 3 + length;
  }
  return 0;
}
