// A depth camera of 640 x 480 pixels at 15 Hz sees a moving robot and a moving obstacle, the robot's trajectory is
// watched, and clients check states. No voxel may be away from the truth, no verdict may be wrong, no reply may be
// lost, and the node's memory must not grow. Prints the lag of the camera and the measurements that were dropped.

#include <atomic>
#include <cmath>
#include <cstring>
#include <random>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/octomap.h"
#include "node/messages/exact_numbers.h"
#include "node/node_client.h"
#include "soak/answer_judge.h"
#include "soak/latencies.h"
#include "soak/memory_record.h"
#include "soak/random_requests.h"
#include "support/depth_camera.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kRate = 15.0;   // images per second
constexpr double kVoxel = 0.05;  // metres: ~octomap_resolution
constexpr int kFrames = 90;      // of a cycle of the robot and the obstacle
constexpr double kTwoPi = 6.283185307179586;
constexpr std::size_t kKeptScenes = 400;  // each has thousands of voxels
const PinholeCamera kCamera{640, 480, 525.0, 525.0, 319.5, 239.5};

/// The robot, the obstacle and the image of one instant of the cycle.
struct Frame
{
  std::vector<double> state;
  std::vector<WorldObject> world;
  sensor_msgs::Image image;
};

/// The arm swings from side to side. The obstacle comes to one side while the arm is at the other side.
std::vector<Frame> makeFrames(const std::shared_ptr<const RobotModel>& robot, const Isometry3d& camera_pose)
{
  std::vector<Frame> frames;
  std::mt19937_64 generator(1);
  for (int i = 0; i < kFrames; ++i)
  {
    const double phase = kTwoPi * i / kFrames;
    Frame frame;
    frame.state = {0.7 * std::sin(phase), 0.6, 0.5, 0.0, 0.3, 0.0, 0.0};
    frame.state.resize(robot->variables().size(), 0.0);
    frame.world = {boxAt("floor", {0.0, 0.0, -0.1137}, {5.0, 5.0, 0.2}),
                   boxAt("wall", {0.0, -1.713, 1.0}, {3.4, 0.1, 2.2}),
                   boxAt("obstacle", {0.75, 1.6 + 1.0 * std::sin(phase), 0.7}, {0.3, 0.3, 1.4})};
    PlanningScene scene(robot);
    scene.objects = frame.world;
    DepthImage image = depthImageOf(scene, frame.state.data(), kCamera, camera_pose);
    addNoise(image, {0.001, 0.005}, generator);
    frame.image.header.frame_id = "camera";
    frame.image.width = static_cast<std::uint32_t>(kCamera.width);
    frame.image.height = static_cast<std::uint32_t>(kCamera.height);
    frame.image.encoding = "32FC1";
    frame.image.step = frame.image.width * sizeof(float);
    frame.image.data.resize(image.depths.size() * sizeof(float));
    std::memcpy(frame.image.data.data(), image.depths.data(), frame.image.data.size());
    frames.push_back(std::move(frame));
  }
  return frames;
}

class SensorsSoak : public RunningNode
{
 public:
  /// Publishes the robot's state and the camera's image, both with the same time.
  void measure()
  {
    ros::Publisher images = node_.advertise<sensor_msgs::Image>("/camera/depth/image_rect", 1);
    ros::Publisher states = node_.advertise<sensor_msgs::JointState>("/joint_states", 10);
    sensor_msgs::JointState joints;
    joints.name = stateRequest(free_state).joint_names;
    for (ros::WallRate rate(kRate); !done; rate.sleep())
    {
      const Frame& next = frames.at(static_cast<std::size_t>(++frame % kFrames));
      joints.header.stamp = ros::Time::now();
      joints.position = next.state;
      states.publish(joints);
      sensor_msgs::Image image = next.image;
      image.header.stamp = joints.header.stamp;
      images.publish(image);
    }
  }

  void checkStates(std::uint64_t seed)
  {
    std::mt19937_64 generator(seed);
    while (!done)
    {
      CheckStates check;
      check.request = stateRequest(randomStates(*robot, 16, generator));
      const ros::WallTime start = ros::WallTime::now();
      if (!callPersistently(name("check_states"), check))
        ++lost;
      else if (!check.response.success)
        ++(check.response.status == gpu_planning_scene::AnswerStatus::BUSY ? busy : failed);
      else
      {
        latencies.add((ros::WallTime::now() - start).toSec());
        judge->add(check, 0);
      }
      ros::WallDuration(0.25).sleep();
    }
  }

  /// Watches the next 20 s of the robot's motion, again and again.
  void watch()
  {
    const std::vector<std::string> names = stateRequest(free_state).joint_names;
    while (!done)
    {
      WatchTrajectory watch;
      watch.request.id = "swing";
      watch.request.joint_trajectory.header.stamp = ros::Time::now();
      watch.request.joint_trajectory.joint_names = names;
      const int first = frame;
      for (int i = 0; i <= static_cast<int>(20.0 * kRate); ++i)
      {
        trajectory_msgs::JointTrajectoryPoint point;
        point.time_from_start = ros::Duration(i / kRate);
        point.positions = frames.at(static_cast<std::size_t>((first + i) % kFrames)).state;
        watch.request.joint_trajectory.points.push_back(point);
      }
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        watched_ = watch.request;
      }
      if (!callPersistently(name("watch_trajectory"), watch))
        ++lost;
      else if (!watch.response.success)
        ++failed;
      for (int i = 0; i < 150 && !done; ++i)
        ros::WallDuration(0.1).sleep();
    }
  }

  /// The watched state at a time on the ROS clock.
  static std::vector<double> watchedAt(const trajectory_msgs::JointTrajectory& trajectory, double time)
  {
    const double place = std::clamp((time - trajectory.header.stamp.toSec()) * kRate, 0.0,
                                    static_cast<double>(trajectory.points.size() - 1));
    const auto before = std::min(static_cast<std::size_t>(place), trajectory.points.size() - 2);
    const double share = place - static_cast<double>(before);
    std::vector<double> state;
    for (std::size_t i = 0; i < trajectory.joint_names.size(); ++i)
      state.push_back((1.0 - share) * trajectory.points[before].positions[i] +
                      share * trajectory.points[before + 1].positions[i]);
    return state;
  }

  /// Checks every eighth verdict of the watch by dense states.
  void take(const WatchState& state, SceneHistory& history)
  {
    latencies_of_watch.add(state.latency);
    if (++watch_messages % 8 != 0 || (state.verdict != WatchState::FREE && state.verdict != WatchState::COLLISION))
      return;
    trajectory_msgs::JointTrajectory trajectory;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      trajectory = watched_.joint_trajectory;
    }
    if (state.header.stamp < trajectory.header.stamp + ros::Duration(0.5))
      return;  // perhaps a verdict about the trajectory before
    const std::shared_ptr<const PlanningScene> scene = history.at(state.scene_revision);
    if (scene == nullptr)
      return;
    CpuChecker checker(scene);
    std::vector<double> states;
    const bool is_free = state.verdict == WatchState::FREE;
    const double first = state.header.stamp.toSec() + (is_free ? 0.0 : state.collision_in - 1e-4);
    const double end = is_free ? first + 8.0 : first + 0.01;
    for (int i = 0; i <= 400; ++i)
    {
      const std::vector<double> row = watchedAt(trajectory, first + i * (end - first) / 400.0);
      states.insert(states.end(), row.begin(), row.end());
    }
    const BatchResult result = checker.check(states.data(), 401);
    const bool collides = std::count(result.valid.begin(), result.valid.end(), 0) != 0;
    ++judged_verdicts;
    found_collisions += is_free ? 0 : 1;
    if (collides == is_free)
      ++wrong_verdicts;
  }

  void take(const diagnostic_msgs::DiagnosticArray& message)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto& status : message.status)
      for (const auto& value : status.values)
      {
        if (value.key == "memory")
          memory.add(std::stod(value.value));
        if (value.key == "longest_lag")
          lags.add(std::stod(value.value));
        if (status.name.find("image_rect") != std::string::npos)
          counts[value.key] = value.value;
      }
  }

  /// Whether a frame's camera sees what is behind a ball of this radius, and around it.
  bool seesAround(const Frame& seen, const Vector3d& centre, double radius) const
  {
    const Vector3d local = camera.inverse() * centre;
    const double u = kCamera.cx + kCamera.fx * local.x() / local.z();
    const double v = kCamera.cy + kCamera.fy * local.y() / local.z();
    const double reach = 1.5 * kCamera.fx * radius / local.z() + 5.0;  // pixels
    if (local.z() < 0.2 || u < reach || v < reach || u + reach > kCamera.width - 1 || v + reach > kCamera.height - 1)
      return false;
    for (int y = static_cast<int>(v - reach); y <= static_cast<int>(v + reach); ++y)
      for (int x = static_cast<int>(u - reach); x <= static_cast<int>(u + reach); ++x)
      {
        float depth = 0.0F;
        std::memcpy(&depth, seen.image.data.data() + kCamera.pixel(x, y) * sizeof(float), sizeof(float));
        if (static_cast<double>(depth) < local.z() + radius)
          return false;
      }
    return true;
  }

  /// Compares the octomap with the world of the last images. Voxels that the camera does not see may stay.
  void compareWithTruth()
  {
    const OctomapWithPose map = scene(PlanningSceneComponents::OCTOMAP).world.octomap;
    const std::vector<PlacedShape> cubes =
        occupiedLeaves({map.octomap.id, map.octomap.binary != 0, map.octomap.resolution, map.octomap.data}, 1000000);
    const int now = frame;
    const double reach = (1.0 + 0.5 * std::sqrt(3.0)) * kVoxel;
    for (const PlacedShape& cube : cubes)
    {
      double nearest = std::numeric_limits<double>::infinity();
      for (int back = 0; back < 12 && nearest > reach; ++back)
      {
        const Frame& seen = frames.at(static_cast<std::size_t>((now - back + kFrames) % kFrames));
        if (!seesAround(seen, cube.pose.translation(), reach))
          nearest = 0.0;
        for (const WorldObject& object : seen.world)
          nearest = std::min(nearest, distanceFromSurface(object, cube.pose.translation()));
      }
      invented += nearest > reach ? 1 : 0;
    }
    // The obstacle is nowhere near these points, nor is the robot.
    const Frame& seen = frames.at(static_cast<std::size_t>(now % kFrames));
    for (int y = 10; y < kCamera.height; y += 40)
      for (int x = 10; x < kCamera.width; x += 40)
      {
        float depth = 0.0F;
        std::memcpy(&depth, seen.image.data.data() + kCamera.pixel(x, y) * sizeof(float), sizeof(float));
        const double z = static_cast<double>(depth);
        const Vector3d point =
            camera * Vector3d((x - kCamera.cx) / kCamera.fx * z, (y - kCamera.cy) / kCamera.fy * z, z);
        const bool is_of_floor_or_wall =
            std::min(distanceFromSurface(seen.world[0], point), distanceFromSurface(seen.world[1], point)) < 0.01;
        if (!(z < 4.9) || !is_of_floor_or_wall || point.head<2>().norm() < 1.2 || point.cwiseAbs().maxCoeff() > 1.4)
          continue;
        const bool has_voxel = std::any_of(cubes.begin(), cubes.end(),
                                           [&](const PlacedShape& cube)
                                           { return (cube.pose.translation() - point).cwiseAbs().maxCoeff() < reach; });
        missing += has_voxel ? 0 : 1;
      }
    most_voxels = std::max(most_voxels, cubes.size());
    least_voxels = std::min(least_voxels, cubes.size());
    ++comparisons;
  }

  Isometry3d camera;
  std::vector<Frame> frames;
  std::atomic<int> frame{0};
  std::atomic<bool> done{false};
  std::atomic<int> lost{0}, busy{0}, failed{0}, watch_messages{0}, judged_verdicts{0}, wrong_verdicts{0},
      found_collisions{0};
  std::size_t invented = 0, missing = 0, comparisons = 0, most_voxels = 0, least_voxels = 1000000;
  std::unique_ptr<AnswerJudge> judge;
  Latencies latencies, latencies_of_watch, lags;
  MemoryRecord memory;
  std::map<std::string, std::string> counts;

 private:
  ros::NodeHandle node_;
  std::mutex mutex_;
  WatchTrajectory::Request watched_;
};

TEST_F(SensorsSoak, TheMapFollowsTheWorldAndNoAnswerIsWrong)
{
  const double seconds = ros::param::param<double>("~seconds", 60.0);
  const int clients = ros::param::param<int>("~clients", 50);
  camera = cameraPose({2.2, -0.9, 1.9}, {0.2, 0.3, 0.4});
  frames = makeFrames(robot, camera);
  free_state = frames[0].state;
  PlanningSceneMessage start;
  start.robot_state = stateMessage(free_state);
  start.fixed_frame_transforms.resize(1);
  start.fixed_frame_transforms[0].header.frame_id = robot->planningFrame();
  start.fixed_frame_transforms[0].child_frame_id = "camera";
  const geometry_msgs::Pose pose = poseAt(camera);
  start.fixed_frame_transforms[0].transform.translation.x = pose.position.x;
  start.fixed_frame_transforms[0].transform.translation.y = pose.position.y;
  start.fixed_frame_transforms[0].transform.translation.z = pose.position.z;
  start.fixed_frame_transforms[0].transform.rotation = pose.orientation;
  apply(start);

  SceneHistory history(robot, kKeptScenes);
  ASSERT_TRUE(becomes([&] { return history.listens(); }));
  ros::WallDuration(0.5).sleep();
  history.start(scene(2 * kForFollowers - 1));
  judge = std::make_unique<AnswerJudge>(history, 0);
  ros::NodeHandle node;
  ros::Publisher infos = node.advertise<sensor_msgs::CameraInfo>("/camera/depth/camera_info", 1, true);
  sensor_msgs::CameraInfo info;
  info.width = static_cast<std::uint32_t>(kCamera.width);
  info.height = static_cast<std::uint32_t>(kCamera.height);
  info.K = {{kCamera.fx, 0.0, kCamera.cx, 0.0, kCamera.fy, kCamera.cy, 0.0, 0.0, 1.0}};
  infos.publish(info);
  const ros::Subscriber diagnostics = node.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 10, [this](const diagnostic_msgs::DiagnosticArrayConstPtr& message) { take(*message); });
  const ros::Subscriber verdicts = node.subscribe<WatchState>(
      name("watch"), 1000, [&](const WatchState::ConstPtr& state) { take(*state, history); });

  std::vector<std::thread> threads;
  threads.emplace_back([this] { measure(); });
  if (clients > 0)
    threads.emplace_back([this] { watch(); });
  for (int i = 0; i < clients; ++i)
    threads.emplace_back([this, i] { checkStates(static_cast<std::uint64_t>(i)); });
  ros::WallDuration(5.0).sleep();
  for (const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds); ros::WallTime::now() < end;)
  {
    compareWithTruth();
    ros::WallDuration(1.0).sleep();
  }
  done = true;
  for (std::thread& thread : threads)
    thread.join();
  judge->finish();

  std::printf("%g s, %d clients, %zu comparisons of the octomap, %zu to %zu voxels\n", seconds, clients, comparisons,
              least_voxels, most_voxels);
  std::printf("images: %s used, %s dropped, %s rejected; longest lag of each second: ", counts["used"].c_str(),
              counts["dropped"].c_str(), counts["rejected"].c_str());
  lags.print();
  std::printf("answers: ");
  latencies.print();
  std::printf("watch: %d messages, %d judged, %d with a collision; ", watch_messages.load(), judged_verdicts.load(),
              found_collisions.load());
  latencies_of_watch.print();
  memory.expectFlat(seconds);
  judge->expectNoWrongAnswer();
  EXPECT_EQ(0u, invented) << "voxels away from the truth";
  EXPECT_EQ(0u, missing) << "points of floor and wall without a voxel";
  EXPECT_GT(least_voxels, 1000u);
  EXPECT_GT(comparisons, 10u);
  EXPECT_EQ(0, lost) << "requests without a reply";
  EXPECT_EQ(0, failed);
  EXPECT_EQ(0, wrong_verdicts) << "verdicts of the watch";
  if (clients > 0)
  {
    EXPECT_GT(judge->answers, 100u);
    EXPECT_GT(judged_verdicts, found_collisions);
    EXPECT_GT(found_collisions, 0) << "the obstacle comes in the way";
  }
  EXPECT_EQ("0", counts["rejected"]);
  EXPECT_EQ(0, history.gaps());
}
}  // namespace
}  // namespace gpu_planning_scene::core
