#pragma once

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/ros.h>

#include "gpu_planning_scene/planning_scene.h"
#include "node/messages/messages.h"
#include "node/persistent_call.h"

namespace gpu_planning_scene::core
{
geometry_msgs::Pose poseAt(const Eigen::Vector3d& position);
geometry_msgs::Pose poseAt(const Eigen::Isometry3d& pose);
CollisionObject boxObject(const std::string& id, const Eigen::Vector3d& position, double size);
CollisionObject objectOperation(const std::string& id, std::int8_t operation);
PlanningSceneMessage diffScene();
PlanningSceneMessage diffWith(const CollisionObject& object);
PlanningSceneMessage diffWith(const AttachedCollisionObject& object);

/// Waits until the condition holds, for 30 s at most.
template <class Condition>
bool becomes(const Condition& condition)
{
  for (int i = 0; i < 600; ++i)
  {
    if (condition())
      return true;
    ros::WallDuration(0.05).sleep();
  }
  return false;
}

/// A planning_scene_node that runs beside this program, and the node's robot. Each test begins with a scene without
/// objects and with the robot in a state that is free of collision.
class RunningNode : public testing::Test
{
 public:
  static void SetUpTestSuite();
  static void TearDownTestSuite();
  void SetUp() override;

  static std::string name(const std::string& in_its_namespace) { return "/planning_scene/" + in_its_namespace; }
  /// Fails the test unless the node answers.
  template <class Service>
  static typename Service::Response call(const std::string& service, const typename Service::Request& request)
  {
    Service call;
    call.request = request;
    EXPECT_TRUE(callPersistently(name(service), call)) << service << " does not answer";
    return call.response;
  }
  /// Expects that the change is made, and returns the new revision.
  static std::uint64_t apply(const PlanningSceneMessage& change);
  /// Expects that the change is refused for this reason and leaves the scene unchanged.
  static void expectRefusal(const PlanningSceneMessage& change, const std::string& reason,
                            std::uint8_t status = AnswerStatus::INVALID_REQUEST);
  static PlanningSceneMessage scene(std::uint32_t components = 0);
  /// A request to check states whose rows have all variables.
  static CheckStates::Request stateRequest(const std::vector<double>& states);
  static CheckStates::Response check(const std::vector<double>& state);
  static bool isFree() { return check(free_state).valid.at(0) != 0; }
  /// The bodies that collide in the free state, "A B" in alphabetical order; empty if the state is free.
  static std::string collision();
  static RobotState stateMessage(const std::vector<double>& state);
  /// The pose of the link in the planning frame.
  static Eigen::Isometry3d linkPose(const std::string& link, const std::vector<double>& state);
  /// A point in the first shape of the tip (on its surface if it is a mesh), in the free state and the planning frame.
  static Eigen::Vector3d tipPoint();
  /// A point that the robot cannot reach.
  static Eigen::Vector3d farAway() { return {50.0, 0.0, 0.0}; }

  static std::shared_ptr<const RobotModel> robot;
  static std::vector<double> free_state;
  static std::string tip;   ///< the last link with shapes
  static std::string base;  ///< the first link with shapes
};
}  // namespace gpu_planning_scene::core
