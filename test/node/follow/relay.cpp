#include "node/follow/relay.h"

#include "node/messages/exact_numbers.h"
#include "node/persistent_call.h"

namespace gpu_planning_scene::core
{
Relay::Relay(const std::string& name, const std::string& leader)
  : leader_(leader),
    publisher_(node_.advertise<PlanningSceneMessage>(name + "/monitored_planning_scene_diffs", 100)),
    service_(node_.advertiseService(name + "/get_planning_scene", &Relay::answer, this)),
    subscriber_(node_.subscribe<PlanningSceneMessage>(leader + "/monitored_planning_scene_diffs", 100,
                                                      [this](const PlanningSceneMessage::ConstPtr& message)
                                                      { pass(*message); }))
{
}

void Relay::pass(const PlanningSceneMessage& message)
{
  if (!loses_.exchange(false))
    publisher_.publish(message);
}

bool Relay::answer(GetPlanningScene::Request& request, GetPlanningScene::Response& response)
{
  const bool is_fetch = (request.components.components & kForFollowers) != 0;
  ++(is_fetch ? fetches_ : comparisons_);
  GetPlanningScene call;
  call.request = request;
  const bool was_answered = callPersistently(leader_ + "/get_planning_scene", call);
  response = call.response;
  return was_answered;
}
}  // namespace gpu_planning_scene::core
