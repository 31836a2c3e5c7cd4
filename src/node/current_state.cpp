#include "node/current_state.h"

#include <cmath>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene
{
CurrentState::CurrentState(std::shared_ptr<const PlanningScene> scene)
  : scene_(std::move(scene)), state_(*scene_->robot, scene_->current_state)
{
}

PartialState CurrentState::get() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return state_;
}

void CurrentState::update(const sensor_msgs::JointState& message)
{
  // Drivers that report only velocities or efforts leave the positions empty.
  if (message.position.empty())
    return;
  if (message.position.size() != message.name.size())
    throw Error(std::to_string(message.position.size()) + " positions for " + std::to_string(message.name.size()) +
                " names");
  const std::lock_guard<std::mutex> lock(mutex_);
  PartialState next = state_;
  for (std::size_t i = 0; i < message.name.size(); ++i)
  {
    const int variable = scene_->robot->variableIndex(message.name[i]);
    if (variable < 0)
      continue;
    if (!std::isfinite(message.position[i]))
      throw Error("the position of '" + message.name[i] + "' is not a finite number");
    next.values[variable] = message.position[i];
    next.known[variable] = true;
  }
  state_ = std::move(next);
}
}  // namespace gpu_planning_scene
