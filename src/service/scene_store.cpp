#include "service/scene_store.h"

#include <algorithm>
#include <cmath>

#include "gpu_planning_scene/error.h"
#include "model/base_joints.h"
#include "scene/matrix_entries.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Looks up the frames that the change needs and that neither the scene nor `frames` has. Adds them to `frames`.
void findFrames(const PlanningScene& scene, const SceneChange& change, const SceneStore::Lookup& lookup,
                ExternalFrames& frames)
{
  for (const StampedFrame& frame : externalFrames(scene, change))
    if (frames.count(frame) == 0)
      frames.emplace(frame, lookup(frame));
}

bool hasAll(const ExternalFrames& frames, const std::vector<StampedFrame>& wanted)
{
  return std::all_of(
      wanted.begin(), wanted.end(), [&](const StampedFrame& frame) { return frames.count(frame) != 0; });
}

/// The robot's state before the change. Empty if a variable is neither known nor set by the change.
std::vector<double> startingState(const Snapshot& at, const std::map<std::string, double>& variables)
{
  const RobotModel& robot = *at.scene->robot;
  const std::vector<bool> known = at.partialState().known;
  for (std::size_t i = 0; i < known.size(); ++i)
    if (!known[i] && variables.count(robot.variables()[i].name) == 0)
      return {};
  return at.state;
}
}  // namespace

bool Snapshot::allKnown() const
{
  return std::find(known.begin(), known.end(), false) == known.end();
}

PartialState Snapshot::partialState() const
{
  PartialState partial(*scene->robot);
  partial.values = state;
  for (std::size_t i = 0; i < known.size(); ++i)
    partial.known[i] = partial.known[i] || known[i];
  return partial;
}

std::string Snapshot::assumedBase(const std::vector<int>& given) const
{
  const RobotModel& robot = *scene->robot;
  for (const int variable : virtualVariables(robot))
    if (!known[static_cast<std::size_t>(variable)] && std::find(given.begin(), given.end(), variable) == given.end())
      return "no state has set " + robot.variables()[static_cast<std::size_t>(variable)].name +
             " of the virtual joint, so the robot is assumed at the origin of frame '" + robot.planningFrame() + "'";
  return "";
}

SceneStore::SceneStore(PlanningScene scene, SceneDefaults defaults, SceneLimits limits)
  : defaults_(std::move(defaults)), limits_(limits)
{
  state_ = PartialState(*scene.robot, scene.current_state).values;
  known_.assign(state_.size(), !scene.current_state.empty());
  measured_.assign(state_.size(), false);
  scene_ = std::make_shared<const PlanningScene>(std::move(scene));
}

Snapshot SceneStore::snapshot() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return {scene_, state_, known_, measured_};
}

SceneStore::Applied SceneStore::apply(const SceneChange& change, const Lookup& lookup)
{
  ExternalFrames frames;
  for (;;)
  {
    Snapshot at = snapshot();
    findFrames(*at.scene, change, lookup, frames);
    const std::shared_ptr<const PlanningScene> asked = at.scene;

    const std::lock_guard<std::mutex> changing(changes_);
    at = snapshot();
    // Another change may have removed a frame that the scene had during the lookup.
    if (at.scene != asked && !hasAll(frames, externalFrames(*at.scene, change)))
      continue;
    Change made = applyChange(*at.scene, startingState(at, change.state.variables), change, defaults_, limits_, frames);
    return {replace(std::move(made.scene), change.state.variables), std::move(made.warnings)};
  }
}

Change SceneStore::preview(const SceneChange& change, const Lookup& lookup) const
{
  const Snapshot at = snapshot();
  ExternalFrames frames;
  findFrames(*at.scene, change, lookup, frames);
  return applyChange(*at.scene, startingState(at, change.state.variables), change, defaults_, limits_, frames);
}

SceneStore::Applied SceneStore::clear()
{
  const std::lock_guard<std::mutex> changing(changes_);
  PlanningScene scene = *snapshot().scene;
  std::vector<std::string> warnings;
  const auto forget = [&](const std::string& id)
  {
    for (std::string& warning : removeEntriesOfObject(scene.allowed_collisions, id))
      warnings.push_back(std::move(warning));
  };
  for (const WorldObject& object : scene.objects)
    forget(object.id);
  for (const AttachedObject& attached : scene.attached)
    forget(attached.object.id);
  scene.objects.clear();
  scene.attached.clear();
  scene.colors.clear();
  return {replace(std::move(scene), {}), std::move(warnings)};
}

/// Sets the scene and the given variables in one step. The variables are finite.
std::uint64_t SceneStore::replace(PlanningScene scene, const std::map<std::string, double>& variables)
{
  const std::shared_ptr<const PlanningScene> before = snapshot().scene;
  scene.revision = before->revision + 1;
  const auto after = std::make_shared<const PlanningScene>(std::move(scene));
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    scene_ = after;
    setVariables(variables);
  }
  for (const auto& [owner, listener] : listeners_)
    listener(before, after);
  return after->revision;
}

/// The caller holds mutex_. Names that the robot lacks are ignored.
void SceneStore::setVariables(const std::map<std::string, double>& variables)
{
  for (const auto& [name, value] : variables)
  {
    const int variable = scene_->robot->variableIndex(name);
    if (variable < 0)
      continue;
    state_[static_cast<std::size_t>(variable)] = value;
    known_[static_cast<std::size_t>(variable)] = true;
  }
}

void SceneStore::updateState(const std::map<std::string, double>& variables, std::int64_t stamp)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const RobotModel& robot = *scene_->robot;
  for (const auto& [name, value] : variables)
    if (robot.variableIndex(name) >= 0 && !std::isfinite(value))
      throw Error("the position of '" + name + "' is not a finite number");
  setVariables(variables);
  for (const auto& [name, value] : variables)
    if (const int variable = robot.variableIndex(name); variable >= 0)
      measured_[static_cast<std::size_t>(variable)] = true;
  history_.add(stamp, state_);
}

std::vector<double> SceneStore::stateAt(std::int64_t stamp) const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::vector<double>* known = stamp == 0 ? nullptr : history_.nearest(stamp);
  return known != nullptr ? *known : state_;
}

void SceneStore::setListener(const void* owner, Listener listener)
{
  const std::lock_guard<std::mutex> changing(changes_);
  if (listener)
    listeners_[owner] = std::move(listener);
  else
    listeners_.erase(owner);
}
}  // namespace gpu_planning_scene::core
