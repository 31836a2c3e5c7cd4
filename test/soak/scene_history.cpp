#include "soak/scene_history.h"

#include <chrono>

#include "gpu_planning_scene/error.h"
#include "node/messages/exact_numbers.h"
#include "node/messages/from_messages.h"

namespace gpu_planning_scene::core
{
namespace
{
std::shared_ptr<const PlanningScene> changed(const PlanningScene& scene, const PlanningSceneMessage& message)
{
  SceneChange sent = changeFrom(message, *scene.robot, {}, nullptr);
  takeExactNumbers(message, sent);
  ChangedScene change = applyChange(scene, scene.current_state, sent, {}, {}, {});
  change.scene.revision = message.scene_revision;
  return std::make_shared<const PlanningScene>(std::move(change.scene));
}
}  // namespace

SceneHistory::SceneHistory(std::shared_ptr<const RobotModel> robot, std::size_t max_scenes)
  : robot_(std::move(robot)), max_scenes_(max_scenes)
{
  subscriber_ = node_.subscribe<PlanningSceneMessage>(
      "/planning_scene/monitored_planning_scene_diffs", 100000,
      [this](const PlanningSceneMessage::ConstPtr& message) { take(*message); });
}

void SceneHistory::start(const PlanningSceneMessage& scene)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  scenes_[scene.scene_revision] = changed(PlanningScene(robot_), scene);
  for (const PlanningSceneMessage& message : early_)
    if (message.scene_revision > scene.scene_revision)
      follow(message);
  early_.clear();
}

void SceneHistory::take(const PlanningSceneMessage& message)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (scenes_.empty())
    early_.push_back(message);
  else
    follow(message);
}

void SceneHistory::follow(const PlanningSceneMessage& message)
{
  const auto last = std::prev(scenes_.end());
  if (last->first != message.previous_revision)
    ++gaps_;
  scenes_[message.scene_revision] = changed(*last->second, message);
  if (scenes_.size() > max_scenes_)
    scenes_.erase(scenes_.begin());
  changed_.notify_all();
}

std::shared_ptr<const PlanningScene> SceneHistory::at(std::uint64_t revision)
{
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_for(lock, std::chrono::seconds(10),
                    [&] { return !scenes_.empty() && std::prev(scenes_.end())->first >= revision; });
  const auto found = scenes_.find(revision);
  return found == scenes_.end() ? nullptr : found->second;
}

int SceneHistory::gaps() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return gaps_;
}
}  // namespace gpu_planning_scene::core
