// ~compute_ik and ~compute_fk without a ROS master: frames of tf, unknown states, quaternions, and stopping. The slider
// robot of scene/slider_robot.h has its cart at x = `slide`, and its pole turned by `turn`.

#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "node/kinematics/kinematics_services.h"
#include "scene/slider_robot.h"
#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
namespace
{
/// A scene with the services of its kinematics. tf has the frame `camera`, 0.25 m along x for each second of its stamp.
/// The node ends while it waits for the frame `awaited`.
struct KinematicsNode
{
  SceneStore::Lookup lookup = [this](const StampedFrame& frame) -> Eigen::Isometry3d
  {
    ++lookups;
    if (frame.name == "awaited")
      throw ShuttingDown("the lookup was stopped");
    if (frame.name != "camera")
      throw NotKnownYet("frame '" + frame.name + "' is not known");
    return Eigen::Isometry3d(Eigen::Translation3d(0.25e-9 * static_cast<double>(frame.stamp), 0.0, 0.0));
  };
  std::atomic<int> lookups{0};
  SceneStore store{sliderAndWall(5), {}, {}};
  MemoryGuard memory{0};
  KinematicsServices services{
      store,
      {lookup},
      [](std::shared_ptr<const PlanningScene> scene) { return std::make_shared<CpuChecker>(std::move(scene)); },
      [](const std::shared_ptr<const PlanningScene>& scene) { return std::make_shared<StateInspector>(scene); },
      memory,
      {}};
};

class KinematicsOfSlider : public testing::Test
{
 protected:
  KinematicsOfSlider() { node_.store.updateState({{"slide", -0.5}, {"turn", 0.25}}); }

  /// A pose `x` metres along the x axis of a frame, without a rotation relative to this frame.
  static geometry_msgs::PoseStamped poseAlongX(double x, const std::string& frame = "", double stamp = 0.0)
  {
    geometry_msgs::PoseStamped pose;
    pose.header.frame_id = frame;
    pose.header.stamp.fromSec(stamp);
    pose.pose.position.x = x;
    pose.pose.orientation.w = 1.0;
    return pose;
  }

  static ComputeIk::Request requestFor(const std::vector<geometry_msgs::PoseStamped>& poses)
  {
    ComputeIk::Request request;
    request.group = "drive";
    request.link = "pole";
    request.poses = poses;
    return request;
  }

  /// The message of the answer, which must be an error with this status.
  std::string errorFor(const ComputeIk::Request& request, std::uint8_t status = AnswerStatus::INVALID_REQUEST)
  {
    const ComputeIk::Response response = node_.services.computeIk(request);
    EXPECT_FALSE(response.success);
    EXPECT_EQ(status, response.status);
    EXPECT_TRUE(response.pose_status.empty());
    return response.message;
  }

  /// Expects one solution for each pose.
  std::vector<double> solutionsFor(const ComputeIk::Request& request)
  {
    const ComputeIk::Response response = node_.services.computeIk(request);
    EXPECT_TRUE(response.success) << response.message;
    EXPECT_EQ(response.counts, std::vector<std::uint32_t>(request.poses.size(), 1));
    EXPECT_EQ(response.joint_names, (std::vector<std::string>{"slide", "turn"}));
    EXPECT_EQ(response.scene_revision, 5u);
    return response.solutions;
  }

  KinematicsNode node_;
};

void expectNear(const std::vector<double>& values, const std::vector<double>& expected)
{
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(values[i], expected[i], 2e-6) << "value " << i;
}

TEST_F(KinematicsOfSlider, AFrameOfTfIsLookedUpOnceForEachStamp)
{
  expectNear(solutionsFor(requestFor(
                 {poseAlongX(0.1, "camera", 1.0), poseAlongX(-0.1, "camera", 1.0), poseAlongX(0.1, "camera", 2.0)})),
             {0.35, 0.0, 0.15, 0.0, 0.6, 0.0});
  EXPECT_EQ(node_.lookups, 2);
  EXPECT_EQ(errorFor(requestFor({poseAlongX(0.0), poseAlongX(0.0, "lamp")}), AnswerStatus::UNAVAILABLE),
            "pose 1: frame 'lamp' is not known");
}

TEST_F(KinematicsOfSlider, AFrameThatMovesIsWhereTheCurrentStateHasItAndNotTheSeed)
{
  ComputeIk::Request request = requestFor({poseAlongX(0.2, "cart")});
  request.seed_names = {"slide", "turn"};
  request.seed = {1.5, 0.0};
  expectNear(solutionsFor(request), {-0.3, 0.0});
}

TEST_F(KinematicsOfSlider, DistancesAreThoseFromTheSeed)
{
  ComputeIk::Request request = requestFor({poseAlongX(0.5)});
  EXPECT_NEAR(node_.services.computeIk(request).distances.at(0), std::hypot(1.0, 0.25), 1e-5);
  request.named_seed = "left";  // slide -1, turn 0.8
  EXPECT_NEAR(node_.services.computeIk(request).distances.at(0), std::hypot(1.5, 0.8), 1e-5);
  request.seed_names = {"turn"};
  EXPECT_EQ(errorFor(request), "named_seed is 'left', but seed_names is not empty; give one of the two");
}

TEST_F(KinematicsOfSlider, WhereTheStateIsNotKnownTheRequestMustNameIt)
{
  KinematicsNode fresh;
  ComputeIk::Request request = requestFor({poseAlongX(0.5)});
  const ComputeIk::Response unknown = fresh.services.computeIk(request);
  EXPECT_EQ(AnswerStatus::UNAVAILABLE, unknown.status);
  EXPECT_EQ(unknown.message.rfind("the seed: no value for slide, turn; give values for all joints", 0), 0u)
      << unknown.message;
  request.seed_names = {"slide", "turn"};
  request.seed = {0.0, 0.0};
  EXPECT_EQ(fresh.services.computeIk(request).counts, std::vector<std::uint32_t>{1});
  request.poses = {poseAlongX(0.5, "cart")};
  const ComputeIk::Response moving = fresh.services.computeIk(request);
  EXPECT_EQ(AnswerStatus::UNAVAILABLE, moving.status);
  EXPECT_EQ(moving.message.rfind("pose 0: the robot's state is not known yet, so link 'cart' has no pose", 0), 0u)
      << moving.message;
  ComputeFk::Request forward;
  forward.frames = {"pole"};
  EXPECT_EQ(AnswerStatus::UNAVAILABLE, fresh.services.computeFk(forward).status);
  forward.joint_names = {"slide", "turn"};
  forward.positions = {0.75, 0.0};
  EXPECT_NEAR(fresh.services.computeFk(forward).poses.at(0).pose.position.x, 0.75, 1e-15);
}

TEST_F(KinematicsOfSlider, AQuaternionHasTheLengthOneUnlessAnyOrientationWillDo)
{
  ComputeIk::Request request = requestFor({poseAlongX(0.5)});
  request.poses[0].pose.orientation.w = 1.0009;
  expectNear(solutionsFor(request), {0.5, 0.0});
  request.poses[0].pose.orientation.w = 0.99;
  EXPECT_EQ(errorFor(request).rfind("pose 0: the quaternion of the orientation has the length 0.99", 0), 0u);
  request.poses[0].pose.orientation.w = std::nan("");
  EXPECT_EQ(errorFor(request).rfind("pose 0: the quaternion of the orientation has the length", 0), 0u);
  request.orientation_tolerance = M_PI;
  expectNear(solutionsFor(request), {0.5, 0.25});  // the pole keeps its angle
}

TEST_F(KinematicsOfSlider, ASeedOutsideTheLimitsOfAJointThatTheSearchKeepsIsRefused)
{
  ComputeIk::Request request = requestFor({poseAlongX(0.5), poseAlongX(0.25)});
  request.link = "cart";
  request.seed_names = {"turn"};
  request.seed = {7.0};
  EXPECT_EQ(errorFor(request),
            "the given state must be within the limits of the joints that the search does not move: joint 'turn' is 7, "
            "outside its limits -3 to 3 rad");
  request.link = "pole";  // the search moves `turn`
  expectNear(solutionsFor(request), {0.5, 0.0, 0.25, 0.0});
}

TEST_F(KinematicsOfSlider, ACarriedObjectReachesThePose)
{
  AttachedCollisionObject pen;
  pen.link_name = "pole";
  pen.object.id = "pen";
  pen.object.header.frame_id = "pole";
  pen.object.pose.orientation.w = 1.0;
  pen.object.primitives.resize(1);
  pen.object.primitives[0].type = shape_msgs::SolidPrimitive::SPHERE;
  pen.object.primitives[0].dimensions = {0.01};
  pen.object.primitive_poses.resize(1);
  pen.object.primitive_poses[0].position.z = 1.0;
  pen.object.primitive_poses[0].orientation.w = 1.0;
  pen.object.subframe_names = {"tip"};
  pen.object.subframe_poses.resize(1);
  pen.object.subframe_poses[0].position.x = 0.25;
  pen.object.subframe_poses[0].orientation.w = 1.0;
  ComputeIk::Request request = requestFor({poseAlongX(0.5)});
  request.link = "pen/tip";
  EXPECT_EQ(errorFor(request).rfind("the scene has no frame 'pen/tip'", 0), 0u);
  request.scene_diff.is_diff = request.scene_diff.robot_state.is_diff = 1;
  request.scene_diff.robot_state.attached_collision_objects = {pen};
  const ComputeIk::Response response = node_.services.computeIk(request);
  ASSERT_TRUE(response.success) << response.message;
  expectNear(response.solutions, {0.25, 0.0});
  request.link = "wall";
  EXPECT_EQ(
      errorFor(request),
      "frame 'wall' does not move with the robot; name a link, an object that a link carries, or OBJECT/SUBFRAME");
}

TEST_F(KinematicsOfSlider, ALookupThatIsStoppedIsNoErrorOfTheRequest)
{
  EXPECT_EQ(errorFor(requestFor({poseAlongX(0.0, "awaited")}), AnswerStatus::SHUTTING_DOWN), "the lookup was stopped");
}

/// Sends the request again while the node is busy with the requests of others.
ComputeIk::Response untilAdmitted(KinematicsServices& services, const ComputeIk::Request& request)
{
  for (;;)
    if (ComputeIk::Response response = services.computeIk(request); response.status != AnswerStatus::BUSY)
      return response;
}

/// Requests at the same time, one more than the node answers or queues.
TEST(KinematicsOfABusyNode, AreRefusedWithTheStatusBusy)
{
  KinematicsOptions options;
  options.max_waiting = 0;
  KinematicsNode node;
  KinematicsServices busy(
      node.store, {node.lookup},
      [](std::shared_ptr<const PlanningScene> scene) { return std::make_shared<CpuChecker>(std::move(scene)); },
      [](const std::shared_ptr<const PlanningScene>& scene) { return std::make_shared<StateInspector>(scene); },
      node.memory, options);
  node.store.updateState({{"slide", -0.5}, {"turn", 0.25}});
  ComputeIk::Request endless;
  endless.group = "drive";
  endless.link = "pole";
  endless.poses.resize(1);
  endless.poses[0].pose.position.x = 50.0;  // too far
  endless.poses[0].pose.orientation.w = 1.0;
  endless.max_attempts = 1000000;
  std::vector<std::future<ComputeIk::Response>> running;
  for (std::size_t i = 0; i < KinematicsServices::kSearchingRequests; ++i)
    running.push_back(std::async(std::launch::async, [&busy, endless] { return untilAdmitted(busy, endless); }));
  ComputeCartesianPath::Request line;
  line.group = "drive";
  line.link = "pole";
  line.waypoints.resize(1);
  line.waypoints[0].pose.position.x = 0.5;
  line.waypoints[0].pose.orientation.w = 1.0;
  while (busy.computeCartesianPath(line).status != AnswerStatus::BUSY)
    std::this_thread::yield();
  endless.max_attempts = 1;
  EXPECT_EQ(AnswerStatus::BUSY, busy.computeIk(endless).status);
  busy.stop();
  for (auto& answer : running)
    EXPECT_EQ(AnswerStatus::SHUTTING_DOWN, answer.get().status);
  EXPECT_EQ(AnswerStatus::SHUTTING_DOWN, busy.computeCartesianPath(line).status);
  ComputeFk::Request forward;
  forward.frames = {"pole"};
  EXPECT_EQ(AnswerStatus::SHUTTING_DOWN, busy.computeFk(forward).status);
}

/// An octomap or a mesh may be too large for a checker. The request does not bring it.
TEST(KinematicsOfASceneThatCannotBeChecked, BlameTheNodeAndNotTheRequest)
{
  KinematicsNode node;
  KinematicsServices services(node.store, {node.lookup},
                              [](const std::shared_ptr<const PlanningScene>&) -> std::shared_ptr<StateChecker>
                              { throw Error("the scene has too many triangles"); },
                              {}, node.memory, {});
  node.store.updateState({{"slide", -0.5}, {"turn", 0.25}});
  ComputeIk::Request request;
  request.group = "drive";
  request.link = "pole";
  request.poses.resize(1);
  request.poses[0].pose.orientation.w = 1.0;
  EXPECT_EQ(AnswerStatus::INTERNAL_ERROR, services.computeIk(request).status);
  ComputeCartesianPath::Request line;
  line.group = request.group;
  line.link = request.link;
  line.waypoints = request.poses;
  EXPECT_EQ(AnswerStatus::INTERNAL_ERROR, services.computeCartesianPath(line).status);
  request.scene_diff.is_diff = request.scene_diff.robot_state.is_diff = 1;
  request.scene_diff.name = "changed by the request";
  EXPECT_EQ(AnswerStatus::INVALID_REQUEST, services.computeIk(request).status);
}

TEST_F(KinematicsOfSlider, StoppingEndsARunningSearch)
{
  ComputeIk::Request request = requestFor(std::vector<geometry_msgs::PoseStamped>(5, poseAlongX(50.0)));  // too far
  request.max_attempts = 200000;
  ComputeIk::Response response;
  std::thread caller([&] { response = node_.services.computeIk(request); });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  node_.services.stop();
  const auto stopped = std::chrono::steady_clock::now();
  caller.join();
  EXPECT_LT(std::chrono::steady_clock::now() - stopped, std::chrono::seconds(5));
  EXPECT_FALSE(response.success);
  EXPECT_EQ(AnswerStatus::SHUTTING_DOWN, response.status) << response.message;
  EXPECT_EQ(errorFor(requestFor({poseAlongX(0.5)}), AnswerStatus::SHUTTING_DOWN),
            "shutting down: the request was not answered");
}
}  // namespace
}  // namespace gpu_planning_scene::core
