#include "node/serve.h"

#include <array>
#include <atomic>
#include <chrono>
#include <optional>

#include "gpu_planning_scene/cpu_checker.h"
#include "node/checks/check_services.h"
#include "node/checks/scene_watch.h"
#include "node/endpoints/diagnostics.h"
#include "node/endpoints/endpoints.h"
#include "node/follow/follow_options.h"
#include "node/follow/leader_scene.h"
#include "node/kinematics/kinematics_services.h"
#include "node/markers/animation_publisher.h"
#include "node/markers/marker_publisher.h"
#include "node/markers/path_publisher.h"
#include "node/moveit/moveit_interface.h"
#include "node/parameters/node_parameters.h"
#include "node/parameters/setup.h"
#include "node/planning/plan_service.h"
#include "node/scene/base_from_tf.h"
#include "node/scene/frame_lookup.h"
#include "node/scene/scene_publisher.h"
#include "node/scene/scene_topics.h"
#include "node/sensors/cloud_topic.h"
#include "node/sensors/sensors.h"
#include "node/shutdown_call.h"
#include "node/shutdown_deadline.h"
#include "node/watch/trajectory_watcher.h"
#include "scene/frame.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kLongestEnd = 8.0;               // seconds; roslaunch kills the process after 15 s
constexpr std::chrono::seconds kKeptReplaced{3};  // how long replaced scenes are kept for requests

void warn(const std::vector<std::string>& warnings)
{
  for (const std::string& warning : warnings)
    ROS_WARN_STREAM(warning);
}
}  // namespace

void serve(ros::NodeHandle& node, ros::NodeHandle& own, const OpenDevice& open_device,
           const std::function<bool()>& stop)
{
  std::optional<ShutdownDeadline> deadline;  // declared first, so that it covers the destructors of all objects below
  const ServiceOptions options = serviceOptionsFromParameters(own);
  const CheckServerOptions server_options = serverOptionsFromParameters(own);
  const BatchCheckerOptions checker_options = checkerOptionsFromParameters(own);
  const SceneLimits limits = sceneLimitsFromParameters(own);
  const PlanServiceOptions plan_options = planOptionsFromParameters(own);
  KinematicsOptions kinematics_options = kinematicsOptionsFromParameters(own);
  kinematics_options.max_inspected_states = options.max_inspected_states;
  kinematics_options.max_poses = server_options.max_states;
  kinematics_options.motions = plan_options.motions;
  const FollowOptions follow_options = followOptionsFromParameters(node, own);
  setMessageLimit(options.message_size);

  std::vector<std::string> warnings;
  SceneDefaults defaults;
  PlanningScene scene = sceneFromParameters(node, own, defaults, &warnings);
  const SensorsOptions sensors_options = sensorsFromParameters(node, own, scene.robot->planningFrame(), warnings);
  warn(warnings);
  const std::uint64_t setup = setupFromParameters(node, *scene.robot, defaults);

  std::atomic<bool> stopping{false};
  const SceneStore* known = nullptr;  // the store below, which needs the lookup for the base
  const FrameLookup lookup(
      scene.robot->planningFrame(), options.tf_timeout, [&stopping] { return stopping || !ros::ok(); },
      [&known] { return frameNames(*known->snapshot().scene); });
  BaseFromTf base(lookup, scene.robot);
  Diagnostics diagnostics;
  SceneStore store(std::move(scene), defaults, limits, [&base](std::int64_t stamp) { return base.at(stamp); });
  known = &store;
  const MakeChecker make_checker = diagnostics.watched(
      makeCheckers(checker_options, open_device, [](const std::string& warning) { ROS_WARN_STREAM(warning); }));
  // A CPU checks few states as fast as a device, on the thread of the caller, and its checker needs no memory of a
  // device.
  const MakeChecker make_cpu_checker = [&checker_options](std::shared_ptr<const PlanningScene> its_scene)
  { return std::make_shared<CpuChecker>(std::move(its_scene), checker_options); };
  CheckServer server(store, make_checker, server_options, make_cpu_checker);
  const SceneWatch watch(own, store, server);

  const MemoryGuard memory(options.max_memory);
  const SceneStore::Lookup look_up = [&lookup](const StampedFrame& frame) { return lookup(frame, lookup.deadline()); };
  const OtherFrames others{look_up, [&lookup](const std::string& frame) { return lookup.parents(frame); }};
  CheckServices checks(store, server, memory,
                       {server_options.max_states, options.max_motion_checks, options.max_inspected_states,
                        options.max_contacts, server_options.max_waiting_requests, plan_options.motions.rule,
                        std::chrono::seconds(1), server_options.max_waiting_requests},
                       others);
  PathPublisher paths(own, options.marker_rate, options.marker_triangles);
  AnimationPublisher animation(own, options.animation_rate, options.marker_triangles);
  const PlanService::Show show_plan = [&](const std::shared_ptr<const ShownPlan>& plan)
  {
    paths.show(plan);
    animation.show(plan);
  };
  PlanService plans(own, store, others, make_cpu_checker, memory, show_plan, plan_options);
  plans.prepare();
  const auto inspector_of = [&checks](const std::shared_ptr<const PlanningScene>& of)
  { return checks.inspectorOf(of); };
  KinematicsServices kinematics(store, others, make_cpu_checker, inspector_of, memory, kinematics_options);
  SceneServices changes(store, look_up, memory, setup);
  const SceneStore::Lookup find_frame = [&lookup](const StampedFrame& frame)
  { return lookup(frame, FrameLookup::Clock::now()); };
  CloudTopic clouds(
      store, find_frame, options.tf_timeout, [&stopping] { return stopping.load(); }, memory, options.cloud,
      options.cloud_id);
  MarkerPublisher markers(own, store, options.marker_rate, options.marker_triangles);
  const ScenePublisher publisher(own, store, options.full_scene_period, setup);
  const ros::WallTimer forget =
      own.createWallTimer(ros::WallDuration(1.0), [&store](const ros::WallTimerEvent&)
                          { store.forgetReplaced(std::chrono::steady_clock::now() - kKeptReplaced); });

  std::optional<LeaderScene> leader;
  if (!follow_options.node.empty())
  {
    leader.emplace(node, own, follow_options, setup, store, changes);
    diagnostics.watchScene([&leader] { return leader->fault(); });
  }
  const Endpoints::Precondition require_leader = [&leader]
  {
    if (leader)
      leader->requireScene();
  };
  std::optional<Sensors> sensors;
  if (!sensors_options.sensors.empty())
    sensors.emplace(node, own, store, find_frame, options.tf_timeout, memory, diagnostics, sensors_options);
  const ClearOctomap clear_octomap = [&] { return sensors ? sensors->clear() : changes.clearOctomap(); };

  MoveItInterface moveit(
      {node, own, store, changes, clear_octomap, checks, kinematics, lookup, diagnostics, options, require_leader});
  const Endpoints::Precondition require_scene = [&]
  {
    require_leader();
    moveit.requireScene();
  };
  const Endpoints::Precondition require_own_scene = [&]
  {
    if (const std::string fault = leader ? leader->changeFault() : moveit.changeFault(); !fault.empty())
      throw Error(fault);
  };

  WatcherOptions watcher_options;
  watcher_options.rate = options.watch_rate;
  watcher_options.motions.steps = plan_options.motions.steps;
  watcher_options.motions.max_checks = options.max_motion_checks;
  TrajectoryWatcher watcher(node, own, store, make_cpu_checker, inspector_of, require_scene, watcher_options);

  Endpoints change_requests(node, own, 3, diagnostics, require_own_scene);
  change_requests.advertise<ApplyPlanningScene>(
      "apply_planning_scene", [&](const ApplyPlanningScene::Request& r) { return changes.apply(r); });
  change_requests.advertise<Clear>(
      "clear", [&](const Clear::Request&) { return changes.clear(); });
  change_requests.advertise<Clear>("clear_octomap", [&](const Clear::Request&) { return clear_octomap(); });
  if (sensors)
    change_requests.advertise<ExcludeFromSensors>(
        "exclude_from_sensors", [&](const ExcludeFromSensors::Request& r) { return sensors->exclude(r); });
  Endpoints scene_requests(node, own, 3, diagnostics, require_scene);
  scene_requests.advertise<GetPlanningScene>(
      "get_planning_scene", [&](const GetPlanningScene::Request& r) { return changes.get(r); });
  scene_requests.advertise<ShowTreeLevel>("show_tree_level",
                                          [&](const ShowTreeLevel::Request& r) { return markers.show(r); });

  SceneTopics scene_topics(node, own, changes, lookup, diagnostics, options.max_waiting_changes, options.message_size,
                           require_own_scene);
  scene_topics.subscribeToOwn();
  Endpoints cloud_topics(node, own, 1, diagnostics, require_own_scene);
  cloud_topics.subscribe<sensor_msgs::PointCloud2>(options.cloud_topic, 1,
                                                   [&](const sensor_msgs::PointCloud2& m) { clouds.take(m); });
  Endpoints state_topics(node, own, 1, diagnostics);
  state_topics.subscribe<sensor_msgs::JointState>("joint_states", 100,
                                                  [&](const sensor_msgs::JointState& m) { changes.take(m); });

  Endpoints plan_requests(node, own, plan_options.at_once + plan_options.max_waiting + 1, diagnostics, require_scene);
  plan_requests.advertise<PlanMotion>("plan", [&](const PlanMotion::Request& r) { return plans.plan(r); });

  Endpoints kinematics_requests(node, own, KinematicsServices::kSearchingRequests + kinematics_options.max_waiting + 2,
                                diagnostics, require_scene);
  kinematics_requests.advertise<ComputeIk>(
      "compute_ik", [&](const ComputeIk::Request& r) { return kinematics.computeIk(r); });
  kinematics_requests.advertise<ComputeCartesianPath>(
      "compute_cartesian_path",
      [&](const ComputeCartesianPath::Request& r) { return kinematics.computeCartesianPath(r); });
  kinematics_requests.advertise<ComputeFk>("compute_fk",
                                           [&](const ComputeFk::Request& r) { return kinematics.computeFk(r); });

  Endpoints watch_requests(node, own, 3, diagnostics);  // the verdict says it if the scene is not known
  watch_requests.advertise<WatchTrajectory>("watch_trajectory",
                                            [&](const WatchTrajectory::Request& r) { return watcher.watch(r); });

  // Each waiting request occupies a thread, and a thread must be free to answer with BUSY immediately. Up to
  // max_waiting_requests requests each can be in the two running batches of small requests, in their queue, in the
  // queue of large requests, in the queue for contacts, and waiting for a revision. check_states is advertised last:
  // when it is there, all other services are.
  Endpoints check_requests(node, own, 6 * server_options.max_waiting_requests + 8, diagnostics, require_scene);
  check_requests.advertise<CheckMotions>(
      "check_motions", [&](const CheckMotions::Request& r) { return checks.checkMotions(r); });
  check_requests.advertise<CheckTrajectory>(
      "check_trajectory", [&](const CheckTrajectory::Request& r) { return checks.checkTrajectory(r); });
  check_requests.advertise<GetReport>(
      "get_report", [&](const GetReport::Request& r) { return checks.report(r); });
  check_requests.advertise<CheckStates>("check_states",
                                        [&](const CheckStates::Request& r) { return checks.checkStates(r); });

  DiagnosticsPublisher diagnostics_publisher(node, diagnostics, store, server);
  ros::AsyncSpinner timers(1);
  timers.start();
  ROS_INFO_STREAM("ready: " << own.resolveName("check_states"));
  const ShutdownCall shutdown_call;
  while (ros::ok() && !stop() && !shutdown_call.came())
    ros::WallDuration(0.05).sleep();

  // Running requests are answered or, if they take too long, rejected; queued requests are rejected. Then the threads
  // that send the answers are joined.
  stopping = true;
  deadline.emplace(kLongestEnd);
  const std::array<Endpoints*, 8> endpoints = {{&state_topics, &cloud_topics, &change_requests, &scene_requests,
                                                &plan_requests, &kinematics_requests, &watch_requests,
                                                &check_requests}};
  for (Endpoints* some : endpoints)
    some->close();
  scene_topics.close();
  if (sensors)
    sensors->close();
  moveit.close();
  checks.stop();
  plans.stop();
  kinematics.stop();
  watcher.stop();
  server.stop();
  scene_topics.stop();
  if (sensors)
    sensors->stop();
  moveit.stop();
  if (leader)
    leader->stop();
  for (Endpoints* some : endpoints)
    some->stop();
  timers.stop();
  // roscpp writes the answers to their connections on its own threads, and drops unwritten answers when it shuts down,
  // so it gets time here, unless there are none. Requests that arrive meanwhile are rejected too.
  bool has_answered = true;
  for (int i = 0; i < 10 && has_answered; ++i)
  {
    ros::WallDuration(0.05).sleep();
    has_answered = moveit.refuseWaiting();
    for (Endpoints* some : endpoints)
      has_answered = some->refuseWaiting() || has_answered;
  }
}
}  // namespace gpu_planning_scene::core
