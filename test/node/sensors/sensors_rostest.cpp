// ~sensors: depth images and clouds become the octomap of the scene, without the robot and without excluded objects.

#include <cstring>
#include <limits>
#include <optional>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <rosgraph_msgs/Log.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/PointCloud2.h>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
#include "node/node_client.h"
#include "node/sensors/sensor_options.h"
#include "support/depth_camera.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

constexpr double kResolution = 0.04;  // of sensors.yaml
const PinholeCamera kCamera{160, 120, 140.0, 140.0, 79.5, 59.5};

/// A depth camera and a scanner beside the robot.
class SensorsOfANode : public RunningNode
{
 public:
  /// The arm is stretched out in front of the camera.
  static void SetUpTestSuite()
  {
    RunningNode::SetUpTestSuite();
    free_state = {-0.75, 0.5, 0.5, 0.0, 0.3, 0.0, 0.0};
    free_state.resize(robot->variables().size(), 0.0);
  }

  SensorsOfANode()
    : images_(node_.advertise<sensor_msgs::Image>("/camera/depth/image_rect", 1)),
      infos_(node_.advertise<sensor_msgs::CameraInfo>("/camera/depth/camera_info", 1, true)),
      clouds_(node_.advertise<sensor_msgs::PointCloud2>("/scanner/points", 1)),
      statuses_(node_.subscribe<diagnostic_msgs::DiagnosticArray>(
          "/diagnostics", 10, [this](const diagnostic_msgs::DiagnosticArrayConstPtr& message) { take(*message); }))
  {
    infos_.publish(cameraInfo());
  }

  static sensor_msgs::CameraInfo cameraInfo()
  {
    sensor_msgs::CameraInfo info;
    info.width = static_cast<std::uint32_t>(kCamera.width);
    info.height = static_cast<std::uint32_t>(kCamera.height);
    info.K = {{kCamera.fx, 0.0, kCamera.cx, 0.0, kCamera.fy, kCamera.cy, 0.0, 0.0, 1.0}};
    return info;
  }

  void SetUp() override
  {
    RunningNode::SetUp();
    EXPECT_TRUE(call<Clear>("clear_octomap", {}).success);
    look(tipPoint() + Vector3d(1.0, -0.8, 0.9), tipPoint());
    truth_ = std::make_unique<PlanningScene>(robot);
    ASSERT_TRUE(becomes([this] { return images_.getNumSubscribers() > 0 && clouds_.getNumSubscribers() > 0; }));
  }

  /// Places the camera. The scanner stays.
  void look(const Vector3d& from, const Vector3d& at)
  {
    camera_ = cameraPose(from, at);
    PlanningSceneMessage frames = diffScene();
    for (const char* frame : {"camera", "scanner"})
    {
      frames.fixed_frame_transforms.emplace_back();
      frames.fixed_frame_transforms.back().header.frame_id = robot->planningFrame();
      frames.fixed_frame_transforms.back().child_frame_id = frame;
      const geometry_msgs::Pose pose =
          poseAt(std::string(frame) == "camera" ? camera_ : Eigen::Isometry3d(Eigen::Translation3d(3.0, 3.0, 1.0)));
      frames.fixed_frame_transforms.back().transform.translation.x = pose.position.x;
      frames.fixed_frame_transforms.back().transform.translation.y = pose.position.y;
      frames.fixed_frame_transforms.back().transform.translation.z = pose.position.z;
      frames.fixed_frame_transforms.back().transform.rotation = pose.orientation;
    }
    apply(frames);
  }

  void see()
  {
    const DepthImage seen = depthImageOf(*truth_, state_.data(), kCamera, camera_);
    sensor_msgs::Image image;
    image.header.frame_id = "camera";
    image.header.stamp = stamp_.value_or(ros::Time::now());
    image.width = static_cast<std::uint32_t>(kCamera.width);
    image.height = static_cast<std::uint32_t>(kCamera.height);
    image.encoding = encoding_;
    if (encoding_ == "32FC1")
    {
      image.step = image.width * sizeof(float);
      image.data.resize(seen.depths.size() * sizeof(float));
      std::memcpy(image.data.data(), seen.depths.data(), image.data.size());
    }
    else
    {
      image.step = image.width * sizeof(std::uint16_t);
      image.data.resize(seen.depths.size() * sizeof(std::uint16_t));
      for (std::size_t i = 0; i < seen.depths.size(); ++i)
      {
        const float depth = seen.depths[i];
        const std::uint16_t pixel = std::isfinite(depth) ? static_cast<std::uint16_t>(1000.0F * depth) : 0;
        std::memcpy(image.data.data() + i * sizeof(pixel), &pixel, sizeof(pixel));
      }
    }
    if (is_covered_)
      std::fill(image.data.begin(), image.data.end(), std::uint8_t{0});
    images_.publish(image);
  }

  /// Whether the camera's images lead to the condition.
  template <class Condition>
  bool seesUntil(const Condition& condition)
  {
    return becomes(
        [&]
        {
          see();
          return condition();
        });
  }

  /// A cloud of the scanner without points.
  static sensor_msgs::PointCloud2 emptyCloud()
  {
    sensor_msgs::PointCloud2 cloud;
    cloud.header.frame_id = "scanner";
    cloud.height = 1;
    cloud.point_step = 12;
    for (const char* axis : {"x", "y", "z"})
    {
      cloud.fields.emplace_back();
      cloud.fields.back().name = axis;
      cloud.fields.back().offset = static_cast<std::uint32_t>(4 * (cloud.fields.size() - 1));
      cloud.fields.back().datatype = sensor_msgs::PointField::FLOAT32;
    }
    return cloud;
  }

  void addToTruth(const std::string& id, const Vector3d& centre, double size)
  {
    truth_->objects.push_back({id, Eigen::Isometry3d(Eigen::Translation3d(centre)), {{Box{Vector3d::Constant(size)}}}});
  }

  static std::vector<PlacedShape> octomap()
  {
    const OctomapWithPose map = scene().world.octomap;
    return occupiedLeaves({map.octomap.id, map.octomap.binary != 0, map.octomap.resolution, map.octomap.data}, 1000000);
  }

  /// The number of whole voxels whose centres are at most `distance` from a point.
  static std::size_t voxelsNear(const Vector3d& point, double distance)
  {
    std::size_t count = 0;
    for (const PlacedShape& cube : octomap())
      if (std::abs(std::get<Box>(cube.shape).size.x() - kResolution) < 1e-9)
        count += (cube.pose.translation() - point).cwiseAbs().maxCoeff() <= distance ? 1 : 0;
    return count;
  }

  void publishEmptyCloud()
  {
    sensor_msgs::PointCloud2 cloud = emptyCloud();
    cloud.header.stamp = ros::Time::now();
    clouds_.publish(cloud);
  }

  /// A value in the status of a sensor; empty before the first status.
  std::string statusOf(const std::string& topic, const std::string& key)
  {
    ros::spinOnce();
    return values_[topic + " " + key];
  }

 protected:
  void take(const diagnostic_msgs::DiagnosticArray& message)
  {
    for (const auto& status : message.status)
    {
      const std::string topic = status.name.substr(status.name.rfind(' ') + 1);
      levels_[topic] = static_cast<std::uint8_t>(status.level);
      for (const auto& value : status.values)
        values_[topic + " " + value.key] = value.value;
    }
  }

  ros::NodeHandle node_;
  ros::Publisher images_;
  ros::Publisher infos_;
  ros::Publisher clouds_;
  ros::Subscriber statuses_;
  std::map<std::string, std::string> values_;
  std::unique_ptr<PlanningScene> truth_;
  Eigen::Isometry3d camera_;
  std::vector<double> state_ = free_state;      // of the robot before the camera
  std::optional<ros::Time> stamp_;              // of the images; no value: now
  std::map<std::string, std::uint8_t> levels_;  // of the sensors' statuses
  std::string encoding_ = "32FC1";
  bool is_covered_ = false;  // the camera's lens
};

TEST_F(SensorsOfANode, ABoxBeforeTheCameraBlocksTheRobotUntilItIsGone)
{
  // The box stands where the tip is after a turn of the first joint. The camera sees the robot behind it.
  std::vector<double> turned = free_state;
  turned[0] += 1.2;
  std::vector<Eigen::Isometry3d> poses(robot->links().size());
  robot->linkPoses(turned.data(), poses.data());
  const Vector3d there = poses[static_cast<std::size_t>(robot->linkIndex(tip))].translation();
  const Vector3d outward = Vector3d(there.x(), there.y(), 0.0).normalized();
  look(there + 1.2 * outward + Vector3d(0.0, 0.0, 0.5), there);
  addToTruth("box", there, 0.2);
  for (const char* encoding : {"32FC1", "16UC1"})
  {
    encoding_ = encoding;
    EXPECT_NE(0, check(turned).valid.at(0));
    EXPECT_TRUE(seesUntil([&] { return check(turned).valid.at(0) == 0; })) << encoding;
    EXPECT_TRUE(isFree()) << collision() << ": the robot's own points are left out";
    // Without a wall behind the box, 16UC1 has no depths there, and the camera sees through nothing.
    const WorldObject box = truth_->objects[0];
    truth_->objects.clear();
    addToTruth("wall", there - 3.5 * outward, 4.0);
    EXPECT_TRUE(seesUntil([&] { return check(turned).valid.at(0) != 0; })) << encoding;
    truth_->objects = {box};
    EXPECT_TRUE(call<Clear>("clear_octomap", {}).success);
  }
}

TEST_F(SensorsOfANode, AnImageThatIsOlderThanTwoSecondsIsRejected)
{
  const std::string topic = "/camera/depth/image_rect";
  ASSERT_TRUE(becomes([&] { return !statusOf(topic, "rejected").empty(); }));
  const std::string before = statusOf(topic, "rejected");
  stamp_ = ros::Time::now() - ros::Duration(3.0);
  EXPECT_TRUE(seesUntil([&] { return statusOf(topic, "rejected") != before; }));
}

TEST_F(SensorsOfANode, ASensorThatStopsIsInTheLogOnce)
{
  int lines = 0;
  const ros::Subscriber log = node_.subscribe<rosgraph_msgs::Log>(
      "/rosout", 100,
      [&lines](const rosgraph_msgs::Log::ConstPtr& line)
      {
        if (line->msg.find("sensor /scanner/points: no measurement came for 5 s") != std::string::npos)
          ++lines;
      });
  ASSERT_TRUE(becomes([&] { return log.getNumPublishers() > 1 && !statusOf("/scanner/points", "used").empty(); }));
  const std::string before = statusOf("/scanner/points", "used");
  ASSERT_TRUE(becomes(
      [&]
      {
        sensor_msgs::PointCloud2 cloud = emptyCloud();
        cloud.header.stamp = ros::Time::now();
        clouds_.publish(cloud);
        return statusOf("/scanner/points", "used") != before;
      }));
  lines = 0;
  const auto is_logged = [&lines]
  {
    ros::spinOnce();
    return lines > 0;
  };
  EXPECT_TRUE(becomes(is_logged));
  ros::WallDuration(2.0).sleep();  // the status is published each second
  ros::spinOnce();
  EXPECT_EQ(1, lines);
}

TEST_F(SensorsOfANode, AnExcludedObjectHasNoVoxels)
{
  const Vector3d there = tipPoint() + Vector3d(0.0, 0.0, -0.35);
  addToTruth("part", there, 0.12);
  EXPECT_TRUE(seesUntil([&] { return voxelsNear(there, 0.09) > 0; }));
  ExcludeFromSensors::Request request;
  request.object_ids = {"part"};
  const auto refused = call<ExcludeFromSensors>("exclude_from_sensors", request);
  EXPECT_EQ(AnswerStatus::INVALID_REQUEST, refused.status);
  EXPECT_NE(std::string::npos, refused.message.find("no object 'part'")) << refused.message;
  apply(diffWith(boxObject("part", there, 0.12)));
  EXPECT_GT(voxelsNear(there, 0.09), 0u);
  const auto excluded = call<ExcludeFromSensors>("exclude_from_sensors", request);
  EXPECT_TRUE(excluded.success) << excluded.message;
  EXPECT_EQ(0u, voxelsNear(there, 0.09)) << "at once";
  for (int i = 0; i < 5; ++i)
  {
    see();
    ros::WallDuration(0.1).sleep();
    EXPECT_EQ(0u, voxelsNear(there, 0.09));
  }
  EXPECT_TRUE(call<ExcludeFromSensors>("exclude_from_sensors", {}).success);
  EXPECT_TRUE(seesUntil([&] { return voxelsNear(there, 0.09) > 0; })) << "an empty list ends the exclusion";
}

TEST_F(SensorsOfANode, NoMessageTakesTheirOctomapAway)
{
  const Vector3d there = tipPoint() + Vector3d(0.0, 0.0, -0.35);
  addToTruth("box", there, 0.12);
  EXPECT_TRUE(seesUntil([&] { return voxelsNear(there, 0.09) > 0; }));
  const std::size_t voxels = octomap().size();
  PlanningSceneMessage own = diffScene();
  own.world.octomap = scene().world.octomap;
  own.world.octomap.octomap.data.clear();
  own.world.collision_objects.push_back(boxObject("beside", farAway(), 0.1));
  ApplyPlanningScene::Request request;
  request.scene = own;
  const auto answer = call<ApplyPlanningScene>("apply_planning_scene", request);
  EXPECT_TRUE(answer.success);
  EXPECT_NE(std::string::npos, answer.message.find("the octomap stays as it is")) << answer.message;
  EXPECT_EQ(1u, scene().world.collision_objects.size()) << "the rest of the change is made";
  EXPECT_EQ(voxels, octomap().size());
  PlanningSceneMessage remove = diffScene();
  remove.world.octomap.octomap.id = "cleared";
  apply(remove);
  EXPECT_EQ(voxels, octomap().size());
  PlanningSceneMessage full;
  full.robot_state = stateMessage(free_state);
  apply(full);
  EXPECT_EQ(voxels, octomap().size());
  EXPECT_TRUE(call<Clear>("clear", {}).success);
  EXPECT_EQ(voxels, octomap().size());
  EXPECT_TRUE(call<Clear>("clear_octomap", {}).success);
  EXPECT_EQ(0u, octomap().size());
}

TEST_F(SensorsOfANode, AVoxelThatTheRobotTouchedComesBackWithoutAMeasurement)
{
  std::vector<double> turned = free_state;
  turned[0] += 1.2;
  const Vector3d there = linkPose(tip, turned) * (linkPose(tip, free_state).inverse() * tipPoint());
  const Vector3d outward = Vector3d(there.x(), there.y(), 0.0).normalized();
  look(there + 1.2 * outward + Vector3d(0.0, 0.0, 0.5), there);
  addToTruth("box", there, 0.2);
  EXPECT_TRUE(seesUntil([&] { return voxelsNear(there, 0.15) > 0; }));
  const auto move_to = [](const std::vector<double>& state)
  {
    PlanningSceneMessage change = diffScene();
    change.robot_state.joint_state = stateMessage(state).joint_state;
    apply(change);
  };
  ros::WallDuration(0.5).sleep();  // for the last image, which would hide voxels already before they are counted
  const std::size_t all = voxelsNear(there, 0.15);
  move_to(turned);
  state_ = turned;
  EXPECT_TRUE(seesUntil([&] { return voxelsNear(there, 0.15) < all; })) << "the robot touches voxels";
  ros::WallDuration(0.5).sleep();  // for the last image
  const std::size_t others = voxelsNear(there, 0.15);
  move_to(free_state);
  EXPECT_TRUE(becomes([&] { return voxelsNear(there, 0.15) > others; }));
}

TEST_F(SensorsOfANode, ASilentSensorIsNamedInAnswersAndMakesAWatchUnknown)
{
  const auto both_see = [this](const auto& condition)
  {
    return seesUntil(
        [&]
        {
          publishEmptyCloud();
          return condition();
        });
  };
  WatchTrajectory::Request request;
  request.id = "stand";
  request.joint_trajectory.joint_names = {stateRequest(free_state).joint_names.at(0)};
  for (const double seconds : {0.0, 100.0})
  {
    trajectory_msgs::JointTrajectoryPoint point;
    point.time_from_start = ros::Duration(seconds);
    point.positions = {free_state[0]};
    request.joint_trajectory.points.push_back(point);
  }
  const auto verdict = [&] { return call<WatchTrajectory>("watch_trajectory", request).state.verdict; };
  EXPECT_TRUE(both_see([&] { return verdict() == WatchState::FREE && check(free_state).message.empty(); }));
  ASSERT_TRUE(becomes(
      [&]
      {
        see();  // only the scanner is silent
        return verdict() == WatchState::UNKNOWN;
      }));
  const std::string reason = "the octomap may be out of date: no measurement of sensor /scanner/points was used for ";
  EXPECT_EQ(0u, call<WatchTrajectory>("watch_trajectory", request).state.message.find(reason));
  EXPECT_NE(std::string::npos, check(free_state).message.find(reason)) << check(free_state).message;
  EXPECT_TRUE(both_see([&] { return verdict() == WatchState::FREE; }));
  request.stop = true;
  EXPECT_TRUE(call<WatchTrajectory>("watch_trajectory", request).success);
}

TEST_F(SensorsOfANode, AClearedOctomapIsNotKnownToBeRightUntilTheNextMeasurements)
{
  const auto both_see = [this](const auto& condition)
  {
    return seesUntil(
        [&]
        {
          publishEmptyCloud();
          return condition();
        });
  };
  EXPECT_TRUE(both_see([&] { return check(free_state).message.empty(); }));
  ros::WallDuration(0.3).sleep();  // the last measurements are used
  ASSERT_TRUE(call<Clear>("clear_octomap", {}).success);
  const auto whole = ros::topic::waitForMessage<PlanningSceneMessage>(name("monitored_planning_scene"), node_);
  EXPECT_NE(std::string::npos, whole->octomap_fault.find(" was used since the octomap was cleared"));
  EXPECT_NE(std::string::npos, check(free_state).message.find(" was used since the octomap was cleared"))
      << check(free_state).message;
  EXPECT_TRUE(both_see([&] { return check(free_state).message.empty(); }));
}

TEST_F(SensorsOfANode, CloudsOfAScannerAreInTheSameMap)
{
  sensor_msgs::PointCloud2 cloud = emptyCloud();
  cloud.width = 1000;
  cloud.row_step = 12000;
  std::vector<float> points;
  for (int i = 0; i < 1000; ++i)
    points.insert(points.end(), {2.0F, 0.001F * static_cast<float>(i), 0.0F});
  cloud.data.resize(12000);
  std::memcpy(cloud.data.data(), points.data(), 12000);
  EXPECT_TRUE(becomes(
      [&]
      {
        cloud.header.stamp = ros::Time::now();
        clouds_.publish(cloud);
        return octomap().size() >= 25;
      }));
  EXPECT_GT(voxelsNear({5.0, 3.5, 1.0}, 0.06), 0u);
  addToTruth("box", tipPoint() + Vector3d(0.0, 0.0, -0.35), 0.12);
  EXPECT_TRUE(seesUntil([&] { return voxelsNear(tipPoint() + Vector3d(0.0, 0.0, -0.35), 0.09) > 0; }));
  EXPECT_GT(voxelsNear({5.0, 3.5, 1.0}, 0.06), 0u);
}

TEST_F(SensorsOfANode, WrongMeasurementsAreCountedAndChangeNothing)
{
  const std::string topic = "/camera/depth/image_rect";
  ASSERT_TRUE(becomes([&] { return !statusOf(topic, "rejected").empty(); }));
  const int before = std::stoi(statusOf(topic, "rejected"));
  const std::uint64_t revision = scene().scene_revision;
  encoding_ = "rgb8";
  EXPECT_TRUE(seesUntil([&] { return std::stoi(statusOf(topic, "rejected")) > before; }));
  EXPECT_EQ(revision, scene().scene_revision);
  EXPECT_EQ(diagnostic_msgs::DiagnosticStatus::ERROR, levels_[topic]) << "the octomap does not follow the camera";
  encoding_ = "32FC1";
  is_covered_ = true;
  const int wrong = std::stoi(statusOf(topic, "rejected"));
  EXPECT_TRUE(seesUntil([&] { return std::stoi(statusOf(topic, "rejected")) > wrong + 3; }));
  EXPECT_EQ(revision, scene().scene_revision);
  is_covered_ = false;
  const int used = std::stoi(statusOf(topic, "used"));
  EXPECT_TRUE(seesUntil([&] { return std::stoi(statusOf(topic, "used")) > used; }));
  EXPECT_EQ(diagnostic_msgs::DiagnosticStatus::OK, levels_[topic]);
  EXPECT_LT(std::stod(statusOf(topic, "lag")), 1.0);
  EXPECT_TRUE(becomes(
      [&] { return !statusOf(topic, "used").empty() && levels_[topic] == diagnostic_msgs::DiagnosticStatus::WARN; }))
      << "the camera is silent";
}

TEST_F(SensorsOfANode, ACloudWithoutAMeasuredPointIsRejected)
{
  const std::string topic = "/scanner/points";
  ASSERT_TRUE(becomes([&] { return !statusOf(topic, "rejected").empty(); }));
  const int before = std::stoi(statusOf(topic, "rejected"));
  sensor_msgs::PointCloud2 cloud = emptyCloud();
  cloud.width = 100;
  cloud.row_step = 1200;
  cloud.data.resize(1200);  // zeros
  EXPECT_TRUE(becomes(
      [&]
      {
        cloud.header.stamp = ros::Time::now();
        clouds_.publish(cloud);
        return std::stoi(statusOf(topic, "rejected")) > before;
      }));
}

TEST_F(SensorsOfANode, AWrongCameraInfoIsNotReplacedByAnOlderOne)
{
  const std::string topic = "/camera/depth/image_rect";
  ASSERT_TRUE(becomes([&] { return infos_.getNumSubscribers() > 0 && !statusOf(topic, "rejected").empty(); }));
  sensor_msgs::CameraInfo second = cameraInfo();  // of a stereo pair
  second.P = {{kCamera.fx, 0.0, kCamera.cx, -0.1 * kCamera.fx, 0.0, kCamera.fy, kCamera.cy, 0.0, 0.0, 0.0, 1.0, 0.0}};
  infos_.publish(second);
  const int before = std::stoi(statusOf(topic, "rejected"));
  EXPECT_TRUE(seesUntil([&] { return std::stoi(statusOf(topic, "rejected")) > before + 1; }));
  infos_.publish(cameraInfo());
  const int used = std::stoi(statusOf(topic, "used"));
  EXPECT_TRUE(seesUntil([&] { return std::stoi(statusOf(topic, "used")) > used; }));
}

TEST_F(SensorsOfANode, NoStampEndsTheNode)
{
  const std::string topic = "/camera/depth/image_rect";
  ASSERT_TRUE(becomes([&] { return !statusOf(topic, "rejected").empty(); }));
  const int before = std::stoi(statusOf(topic, "rejected"));
  const int used = std::stoi(statusOf(topic, "used"));
  for (const ros::Time& stamp : {ros::Time(4294967295U, 999999999U), ros::Time(1, 0), ros::Time()})
  {
    stamp_ = stamp;
    see();
    ros::WallDuration(0.3).sleep();
  }
  EXPECT_TRUE(becomes(
      [&] {
        return std::stoi(statusOf(topic, "rejected")) == before + 2 && std::stoi(statusOf(topic, "used")) >= used + 1;
      }))
      << statusOf(topic, "rejected") << " " << statusOf(topic, "used");
  EXPECT_TRUE(isFree());
}

TEST_F(SensorsOfANode, ASensorWithoutAFrameDoesNotHoldUpTheOthers)
{
  const std::string topic = "/camera/depth/image_rect";
  ASSERT_TRUE(becomes([&] { return !statusOf(topic, "dropped").empty(); }));
  const int dropped = std::stoi(statusOf(topic, "dropped"));
  const int used = std::stoi(statusOf(topic, "used"));
  sensor_msgs::PointCloud2 cloud = emptyCloud();
  cloud.header.frame_id = "unknown";
  for (int i = 0; i < 20; ++i)
  {
    cloud.header.stamp = ros::Time::now();
    clouds_.publish(cloud);
    see();
    ros::WallDuration(0.1).sleep();
  }
  EXPECT_TRUE(becomes([&] { return std::stoi(statusOf(topic, "used")) >= used + 18; })) << statusOf(topic, "used");
  EXPECT_LE(std::stoi(statusOf(topic, "dropped")), dropped + 2);
}

TEST_F(SensorsOfANode, TheRobotOfTheTimeOfAnImageIsLeftOut)
{
  // Only the robot is in the image. When the image arrives, the robot is elsewhere.
  ros::Publisher states = node_.advertise<sensor_msgs::JointState>("/joint_states", 10);
  ASSERT_TRUE(becomes([&] { return states.getNumSubscribers() > 0; }));
  sensor_msgs::JointState joints;
  joints.name = stateRequest(free_state).joint_names;
  joints.position = free_state;
  joints.header.stamp = ros::Time::now();
  states.publish(joints);
  stamp_ = joints.header.stamp;
  std::vector<double> turned = free_state;
  turned[0] += 1.2;
  joints.position = turned;
  joints.header.stamp += ros::Duration(0.3);
  states.publish(joints);
  ASSERT_TRUE(becomes([&] { return scene().robot_state.joint_state.position.at(0) == turned[0]; }));
  const std::string topic = "/camera/depth/image_rect";
  ASSERT_TRUE(becomes([&] { return !statusOf(topic, "used").empty(); }));
  const int used = std::stoi(statusOf(topic, "used"));
  see();
  EXPECT_TRUE(becomes([&] { return std::stoi(statusOf(topic, "used")) > used; }));
  EXPECT_EQ(0u, octomap().size());
}

/// The error of sensorsFromParameters with this list of sensors and this value of another parameter.
class SensorParameters : public testing::Test
{
 protected:
  using Value = XmlRpc::XmlRpcValue;

  void TearDown() override { own_.deleteParam(""); }

  std::string errorWith(const Value& sensor, const std::string& other = "", const Value& value = {})
  {
    Value list;
    list[0] = sensor;
    own_.setParam("sensors", list);
    if (!other.empty())
      own_.setParam(other, value);
    std::string error;
    try
    {
      options_ = sensorsFromParameters(ros::NodeHandle(), own_, "world", warnings_);
    }
    catch (const Error& thrown)
    {
      error = thrown.what();
    }
    if (!other.empty())
      own_.deleteParam(other);
    return error;
  }

  static Value camera()
  {
    Value sensor;
    sensor["image_topic"] = "/camera/depth/image_rect";
    return sensor;
  }

  ros::NodeHandle own_{"/sensors_of_a_test"};
  SensorsOptions options_;
  std::vector<std::string> warnings_;
};

TEST_F(SensorParameters, AreThoseOfMoveItsFile)
{
  Value sensor = camera();
  sensor["sensor_plugin"] = "occupancy_map_monitor/DepthImageOctomapUpdater";
  sensor["near_clipping_plane_distance"] = 0.3;
  sensor["far_clipping_plane_distance"] = 5;
  sensor["padding_offset"] = 0.04;
  sensor["padding_scale"] = 4.0;
  sensor["max_update_rate"] = 1.0;
  EXPECT_EQ("", errorWith(sensor));
  ASSERT_EQ(1u, options_.sensors.size());
  EXPECT_EQ("/camera/depth/image_rect", options_.sensors[0].topic);
  EXPECT_EQ("/camera/depth/camera_info", options_.sensors[0].camera_info_topic);
  EXPECT_EQ(0.3, options_.sensors[0].min_range);
  EXPECT_EQ(5.0, options_.sensors[0].max_range);
  EXPECT_EQ(0.04, options_.sensors[0].padding);
  EXPECT_EQ(1.0, options_.sensors[0].max_rate);
  EXPECT_EQ(3.0, options_.sensors[0].max_silence) << "three periods";
  sensor["max_silence"] = 0.5;
  EXPECT_EQ("", errorWith(sensor));
  EXPECT_EQ(0.5, options_.sensors[0].max_silence);
  EXPECT_EQ("", errorWith(camera()));
  EXPECT_EQ(2.5, options_.sensors[0].max_silence);
  ASSERT_EQ(2u, warnings_.size());
  EXPECT_NE(std::string::npos, warnings_[0].find("these keys have no effect: padding_scale")) << warnings_[0];
}

TEST_F(SensorParameters, ThatAreWrongAreRefusedWithTheirName)
{
  const auto expect = [](const std::string& error, const std::string& part)
  { EXPECT_NE(std::string::npos, error.find(part)) << error; };
  Value misspelt = camera();
  misspelt["max_rnage"] = 3.0;
  expect(errorWith(misspelt), "unknown key 'max_rnage'; did you mean 'max_range'?");
  Value both = camera();
  both["point_cloud_topic"] = "/points";
  expect(errorWith(both), "one of the two");
  Value nothing;
  nothing["max_range"] = 3.0;
  expect(errorWith(nothing), "needs image_topic");
  Value behind = camera();
  behind["min_range"] = 3.0;
  behind["max_range"] = 2.0;
  expect(errorWith(behind), "the range ends before it begins");
  Value text = camera();
  text["padding_offset"] = "much";
  expect(errorWith(text), "padding_offset is not a number");
  Value step = camera();
  step["point_subsample"] = 1.5;
  expect(errorWith(step), "point_subsample is not an integer");
  expect(errorWith(camera(), "octomap_frame", "odom"), "~octomap_frame is 'odom'");
  expect(errorWith(camera(), "octomap_resolution", 0.0), "octomap_resolution");
  expect(errorWith(camera(), "follow", "/leader"), "~sensors and ~follow exclude each other");
  Value region;
  for (int i = 0; i < 6; ++i)
    region[i] = i < 3 ? 1.0 : 0.0;
  expect(errorWith(camera(), "octomap_region", region), "~octomap_region is empty");
}
}  // namespace
}  // namespace gpu_planning_scene::core
