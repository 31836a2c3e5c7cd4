#include "node/follow/fake_node.h"

namespace gpu_planning_scene::core
{
namespace
{
bool giveReport(GetReport::Request& /*request*/, GetReport::Response& response)
{
  response.success = 1;
  response.status = AnswerStatus::OK;
  response.names = {"variables"};
  response.values = {1.0};
  return true;
}
}  // namespace

FakeNode::FakeNode(const std::string& name, std::vector<std::uint8_t> statuses, std::uint64_t answered_revision,
                   std::uint64_t revision)
  : statuses_(std::move(statuses)), answered_revision_(answered_revision)
{
  const boost::function<bool(GetPlanningScene::Request&, GetPlanningScene::Response&)> give_scene =
      [revision](GetPlanningScene::Request& /*request*/, GetPlanningScene::Response& response)
  {
    response.success = 1;
    response.status = AnswerStatus::OK;
    response.scene.scene_revision = revision;
    response.scene.robot_state.joint_state.name = {"joint"};
    response.scene.robot_state.joint_state.position = {0.0};
    return true;
  };
  services_.push_back(node_.advertiseService(name + "/get_planning_scene", give_scene));
  services_.push_back(node_.advertiseService(name + "/get_report", &giveReport));
  services_.push_back(node_.advertiseService(name + "/check_states", &FakeNode::check, this));
}

std::size_t FakeNode::calls() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return calls_;
}

CheckStates::Request FakeNode::requestOf(std::size_t states)
{
  CheckStates::Request request;
  request.joint_names = {"joint"};
  request.positions.assign(states, 0.0);
  return request;
}

bool FakeNode::check(CheckStates::Request& request, CheckStates::Response& response)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  response.status = statuses_[std::min(calls_, statuses_.size() - 1)];
  ++calls_;
  response.success = static_cast<std::uint8_t>(response.status == AnswerStatus::OK);
  response.scene_revision = answered_revision_;
  if (response.success != 0)
    response.valid.assign(request.positions.size(), 1);
  else
    response.message = "a fault";
  return true;
}
}  // namespace gpu_planning_scene::core
