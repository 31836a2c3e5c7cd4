#include "moveit/study_node.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include <gpu_planning_scene/CheckStates.h>
#include <moveit_msgs/ApplyPlanningScene.h>
#include <ros/service.h>

namespace gpu_planning_scene
{
namespace
{
constexpr char kApplyScene[] = "/apply_planning_scene";
}  // namespace

StudyNode::StudyNode(std::string name) : name_(std::move(name))
{
  constexpr double kLongest = 600.0;  // seconds: the node may compile shaders beside other programs
  if (!ros::service::waitForService(kApplyScene, ros::Duration(kLongest)))
    throw std::runtime_error(name_ + " does not come up");
}

void StudyNode::setScene(const planning_scene::PlanningScene& scene, const moveit::core::RobotState& state) const
{
  const planning_scene::PlanningScenePtr with_state = scene.diff();
  with_state->setCurrentState(state);
  moveit_msgs::ApplyPlanningScene call;
  with_state->getPlanningSceneMsg(call.request.scene);
  if (!ros::service::call(kApplyScene, call) || !call.response.success)
    throw std::runtime_error("the node does not take the scene; its log has the reason");
}

std::vector<std::pair<std::string, std::string>> StudyNode::collidingPairs(const moveit::core::RobotModel& robot,
                                                                           const std::vector<double>& rows) const
{
  constexpr std::size_t kRows = 10000;  // of a request
  CheckStates call;
  call.request.joint_names = activeVariables(robot);
  const std::size_t width = call.request.joint_names.size();
  std::vector<std::pair<std::string, std::string>> pairs;
  for (std::size_t begin = 0; begin < rows.size(); begin += kRows * width)
  {
    const std::size_t end = std::min(rows.size(), begin + kRows * width);
    call.request.positions.assign(rows.begin() + static_cast<std::ptrdiff_t>(begin),
                                  rows.begin() + static_cast<std::ptrdiff_t>(end));
    if (!ros::service::call(name_ + "/check_states", call) || !call.response.success)
      throw std::runtime_error("the node does not check the states: " + call.response.message);
    for (std::size_t i = 0; i < call.response.valid.size(); ++i)
      pairs.emplace_back(std::minmax(call.response.body_1[i], call.response.body_2[i]));
  }
  return pairs;
}

std::vector<std::string> activeVariables(const moveit::core::RobotModel& robot)
{
  std::vector<std::string> names;
  for (const moveit::core::JointModel* joint : robot.getActiveJointModels())
    names.insert(names.end(), joint->getVariableNames().begin(), joint->getVariableNames().end());
  return names;
}
}  // namespace gpu_planning_scene
