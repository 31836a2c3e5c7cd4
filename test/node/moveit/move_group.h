#pragma once

#include <deque>
#include <functional>
#include <mutex>
#include <random>
#include <string>
#include <vector>

#include <moveit/planning_scene/planning_scene.h>
#include <moveit_msgs/GetPlanningScene.h>
#include <ros/ros.h>

namespace gpu_planning_scene::core
{
/// MoveIt's planning scene with the service and the topic of a move_group. It collects changes and publishes them as
/// differences, as MoveIt's planning scene monitor does. As some servers, it answers a request without components with
/// an empty scene. Thread-safe.
class MoveGroup
{
 public:
  /// `name`: for example "/move_group".
  MoveGroup(const moveit::core::RobotModelConstPtr& model, std::string name);

  void change(const std::function<void(planning_scene::PlanningScene&)>& make);
  /// Publishes the changes since the last call, unless the message is lost.
  void publish(bool is_lost = false);
  void publish(const moveit_msgs::PlanningScene& message) { publisher_.publish(message); }
  moveit_msgs::PlanningScene whole();
  /// For each state, whether it is free by the detector of this package.
  std::vector<bool> verdicts(const std::vector<moveit::core::RobotState>& states);
  bool hasSubscriber() const { return publisher_.getNumSubscribers() != 0; }

  /// The service and the topic go away, and come back.
  void stop();
  void start();
  /// While true, the service does not answer.
  void hang(bool hangs);
  /// Changes each answer of the service. Empty: the answers stay as they are.
  void alterAnswers(const std::function<void(moveit_msgs::PlanningScene&)>& alter);

 private:
  bool answer(moveit_msgs::GetPlanningScene::Request& request, moveit_msgs::GetPlanningScene::Response& response);

  const std::string name_;
  ros::NodeHandle node_;
  std::mutex mutex_;    // guards the two scenes and alter_
  std::mutex hanging_;  // held while the service does not answer
  planning_scene::PlanningScenePtr parent_;
  planning_scene::PlanningScenePtr scene_;  // the difference to parent_ is not published yet
  std::function<void(moveit_msgs::PlanningScene&)> alter_;
  ros::Publisher publisher_;
  ros::ServiceServer service_;
};

/// Random changes of a scene: objects of all kinds, attached objects, the matrix, colours, padding, joint values.
class RandomChanges
{
 public:
  explicit RandomChanges(unsigned seed) : random_(seed) {}
  void operator()(planning_scene::PlanningScene& scene);

 private:
  double number(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  int index(std::size_t count) { return std::uniform_int_distribution<int>(0, static_cast<int>(count) - 1)(random_); }
  geometry_msgs::Pose pose(double reach);
  moveit_msgs::CollisionObject object(const std::string& id, const std::string& frame, double reach);
  std::string worldObject(const planning_scene::PlanningScene& scene);
  std::string link() { return index(2) == 0 ? "panda_hand" : "panda_link5"; }

  std::mt19937 random_;
};

/// The first difference between two scenes, apart from joint values; empty if they are equal.
std::string differenceOf(const moveit_msgs::PlanningScene& a, const moveit_msgs::PlanningScene& b);
}  // namespace gpu_planning_scene::core
