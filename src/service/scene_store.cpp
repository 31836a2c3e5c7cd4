#include "service/scene_store.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/seconds_since.h"
#include "base/text/name_list.h"
#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
#include "model/virtual_joint.h"
#include "scene/changes/matrix_entries.h"
#include "service/sensed_octomap.h"
#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kEndedAge = 2.5;  // seconds; slow drivers, for example of grippers, publish once a second

using Clock = std::chrono::steady_clock;

// Earlier scenes are kept for requests that many nodes answer together. These bounds keep them below some 100 MB.
constexpr std::size_t kReplacedScenes = 64;
constexpr std::size_t kReplacedShapes = 200000;
constexpr std::chrono::milliseconds kPollInterval{100};  // in which a wait for a revision looks for the end of the node

std::size_t shapesOf(const PlanningScene& scene)
{
  std::size_t count = 0;
  for (const WorldObject& object : scene.objects)
    count += object.shapes.size();
  for (const AttachedObject& attached : scene.attached)
    count += attached.object.shapes.size();
  return count;
}

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

/// Sets the given variables. Names that the robot lacks are ignored.
void assign(const RobotModel& robot, const std::map<std::string, double>& variables, std::vector<double>& state,
            std::vector<bool>& known)
{
  for (const auto& [name, value] : variables)
  {
    const int variable = robot.variableIndex(name);
    if (variable < 0)
      continue;
    state[static_cast<std::size_t>(variable)] = value;
    known[static_cast<std::size_t>(variable)] = true;
  }
}
}  // namespace

std::string Snapshot::endedVariable(const std::vector<int>& others) const
{
  for (std::size_t i = 0; i < ages.size(); ++i)
    if (std::isfinite(ages[i]) && ages[i] > kEndedAge &&
        std::count(others.begin(), others.end(), static_cast<int>(i)) == 0)
      return "joint_states has brought no value of '" + scene->robot->variables()[i].name + "' for " +
             numberText(ages[i]) + " s, so this joint may be anywhere";
  if (base.values.empty() || !(base.age > kEndedAge))
    return "";
  for (const int variable : virtualVariables(*scene->robot))
    if (std::count(others.begin(), others.end(), variable) == 0)
      return (std::isfinite(base.age) ? "tf has brought no pose of the robot's base for " + numberText(base.age) + " s"
                                      : std::string("tf has lost the pose of the robot's base")) +
             ", so the robot may be anywhere";
  return "";
}

bool Snapshot::allKnown() const
{
  std::vector<bool> all = partialState().known;
  for (const int variable : virtualVariables(*scene->robot))
    all[static_cast<std::size_t>(variable)] = known[static_cast<std::size_t>(variable)] || !base.values.empty();
  return std::find(all.begin(), all.end(), false) == all.end();
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
  const std::vector<int> variables = virtualVariables(robot);
  std::vector<std::string> unset;
  std::vector<std::string> assumed;
  for (const int variable : variables)
    if (!known[static_cast<std::size_t>(variable)] && std::find(given.begin(), given.end(), variable) == given.end())
    {
      unset.push_back(robot.variables()[static_cast<std::size_t>(variable)].name);
      assumed.push_back(unset.back() + " = " + numberText(state[static_cast<std::size_t>(variable)]));
    }
  if (unset.empty())
    return "";
  if (!base.values.empty())
    return base.warning;
  const std::string reason = base.warning.empty() ? "" : " (" + base.warning + ")";
  if (unset.size() < variables.size())
    return "some variables of the virtual joint are not set; they are assumed: " + nameList(assumed) + reason;
  return "no state has set " + unset.front() +
         " of the virtual joint, so the robot is assumed at the origin of frame '" + robot.planningFrame() + "'" +
         reason;
}

void dropUnknown(const Snapshot& now, SceneChange& change)
{
  std::map<std::string, double>& variables = change.state.variables;
  for (auto variable = variables.begin(); variable != variables.end();)
  {
    const int index = now.scene->robot->variableIndex(variable->first);
    const bool is_known = index >= 0 && now.known[static_cast<std::size_t>(index)];
    variable = is_known ? std::next(variable) : variables.erase(variable);
  }
}

void dropMeasured(const Snapshot& now, SceneChange& change)
{
  std::map<std::string, double>& variables = change.state.variables;
  for (auto variable = variables.begin(); variable != variables.end();)
  {
    const int index = now.scene->robot->variableIndex(variable->first);
    const bool is_measured = index >= 0 && now.isMeasured(index);
    variable = is_measured ? variables.erase(variable) : std::next(variable);
  }
}

SceneStore::SceneStore(PlanningScene scene, SceneDefaults defaults, SceneLimits limits, BaseSource base_source)
  : history_(*scene.robot),
    defaults_(std::move(defaults)),
    limits_(limits),
    base_source_(std::move(base_source)),
    virtual_variables_(virtualVariables(*scene.robot))
{
  state_ = PartialState(*scene.robot, scene.current_state).values;
  known_.assign(state_.size(), !scene.current_state.empty());
  if (scene.base_is_default)
    for (const int variable : virtual_variables_)
      known_[static_cast<std::size_t>(variable)] = false;
  stamps_.assign(state_.size(), 0);
  measured_at_.assign(state_.size(), Clock::time_point::min());
  scene_ = std::make_shared<const PlanningScene>(std::move(scene));
}

Snapshot SceneStore::snapshot() const
{
  // A fault that begins or ends while the scene is read counts.
  std::string fault = octomapFault();
  Snapshot now;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::int64_t oldest = std::numeric_limits<std::int64_t>::max();
    for (std::size_t i = 0; i < known_.size(); ++i)
      if (known_[i])
        oldest = std::min(oldest, stamps_[i]);
    std::vector<double> ages;
    for (const Clock::time_point at : measured_at_)
      ages.push_back(at == Clock::time_point::min() ? std::numeric_limits<double>::infinity() : secondsSince(at));
    now = {scene_, state_, known_, ages, {}, {}, oldest == std::numeric_limits<std::int64_t>::max() ? 0 : oldest,
           stamps_};
  }
  now.octomap_fault = fault.empty() ? octomapFault() : std::move(fault);
  now.base = assumeBase(0, now.known, now.state);
  return now;
}

std::string SceneStore::octomapFault() const
{
  const std::lock_guard<std::mutex> lock(octomap_mutex_);
  return octomap_fault_ ? octomap_fault_() : "";
}

void SceneStore::setOctomapFault(std::function<std::string()> find)
{
  const std::lock_guard<std::mutex> lock(octomap_mutex_);
  octomap_fault_ = std::move(find);
}

/// Sets the virtual joint in `state` if base_source_ has a value for it and no state has set it. Called without a lock.
AssumedBase SceneStore::assumeBase(std::int64_t stamp, const std::vector<bool>& known, std::vector<double>& state) const
{
  const auto is_known = [&known](int variable) { return known[static_cast<std::size_t>(variable)]; };
  if (!base_source_ || virtual_variables_.empty() ||
      std::any_of(virtual_variables_.begin(), virtual_variables_.end(), is_known))
    return {};
  AssumedBase base = base_source_(stamp);
  for (std::size_t i = 0; i < base.values.size(); ++i)
    state[static_cast<std::size_t>(virtual_variables_[i])] = base.values[i];
  return base;
}

SceneStore::Applied SceneStore::apply(const SceneChange& change, const Lookup& lookup)
{
  return make(change, lookup, octomap_is_sensed_);
}

SceneStore::Applied SceneStore::make(const SceneChange& change, const Lookup& lookup, bool keeps_octomap)
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
    std::vector<std::string> warnings;
    ChangedScene made =
        applyChange(*at.scene, startingState(at, change.state.variables),
                    keeps_octomap ? keepingOctomap(change, *at.scene, warnings) : change, defaults_, limits_, frames);
    warnings.insert(warnings.end(), made.warnings.begin(), made.warnings.end());
    return {replace(std::move(made.scene), change.state.variables, at.scene->revision + 1), std::move(warnings)};
  }
}

void SceneStore::follow(const SceneChange& change, std::uint64_t revision)
{
  const std::lock_guard<std::mutex> changing(changes_);
  const Snapshot at = snapshot();
  ChangedScene made = applyChange(*at.scene, startingState(at, change.state.variables), change, defaults_, limits_, {});
  replace(std::move(made.scene), change.state.variables, revision);
}

SceneStore::Preview SceneStore::preview(const std::vector<SceneChange>& changes, const Lookup& lookup,
                                        const std::optional<Snapshot>& from) const
{
  Preview preview{from ? *from : snapshot(), {}};
  Snapshot& at = preview.snapshot;
  ExternalFrames frames;
  for (const SceneChange& change : changes)
  {
    findFrames(*at.scene, change, lookup, frames);
    ChangedScene made =
        applyChange(*at.scene, startingState(at, change.state.variables), change, defaults_, limits_, frames);
    at.scene = std::make_shared<const PlanningScene>(std::move(made.scene));
    assign(*at.scene->robot, change.state.variables, at.state, at.known);
    preview.warnings.insert(preview.warnings.end(), made.warnings.begin(), made.warnings.end());
  }
  return preview;
}

SceneStore::Applied SceneStore::clear()
{
  const std::lock_guard<std::mutex> changing(changes_);
  PlanningScene scene = *snapshot().scene;
  std::vector<std::string> warnings;
  const auto forget = [&](const std::string& id)
  {
    if (id == kOctomapId)  // its entries stay, as after any removal of the octomap
      return;
    for (std::string& warning : removeEntriesOfObject(scene.allowed_collisions, id))
      warnings.push_back(std::move(warning));
  };
  for (const WorldObject& object : scene.objects)
    forget(object.id);
  for (const AttachedObject& attached : scene.attached)
    forget(attached.object.id);
  scene.objects.erase(
      std::remove_if(scene.objects.begin(), scene.objects.end(),
                     [this](const WorldObject& object) { return !octomap_is_sensed_ || object.id != kOctomapId; }),
      scene.objects.end());
  scene.attached.clear();
  scene.colors.clear();
  const std::uint64_t revision = scene.revision + 1;
  return {replace(std::move(scene), {}, revision), std::move(warnings)};
}

/// Sets the scene and the given variables in one step. The variables are finite.
std::uint64_t SceneStore::replace(PlanningScene scene, const std::map<std::string, double>& variables,
                                  std::uint64_t revision)
{
  const std::shared_ptr<const PlanningScene> before = snapshot().scene;
  scene.revision = revision;
  const auto after = std::make_shared<const PlanningScene>(std::move(scene));
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    scene_ = after;
    assign(*scene_->robot, variables, state_, known_);
    for (const auto& [name, value] : variables)
      if (const int variable = scene_->robot->variableIndex(name);
          variable >= 0 &&
          !(keeps_ages_ && measured_at_[static_cast<std::size_t>(variable)] != Clock::time_point::min()))
      {
        stamps_[static_cast<std::size_t>(variable)] = 0;
        measured_at_[static_cast<std::size_t>(variable)] = Clock::time_point::min();
        history_.add(static_cast<std::size_t>(variable), 0.0, 0);
      }
    keep(before);
  }
  arrived_.notify_all();
  for (const auto& [owner, listener] : listeners_)
    listener(before, after);
  return after->revision;
}

/// Called with mutex_ held.
void SceneStore::keep(const std::shared_ptr<const PlanningScene>& replaced)
{
  replaced_.push_back({Clock::now(), replaced, shapesOf(*replaced)});
  replaced_shapes_ += replaced_.back().shapes;
  while (replaced_.size() > kReplacedScenes || (!replaced_.empty() && replaced_shapes_ > kReplacedShapes))
  {
    replaced_shapes_ -= replaced_.front().shapes;
    replaced_.pop_front();
  }
}

Snapshot SceneStore::at(std::uint64_t revision, Clock::time_point until, const std::function<bool()>& stop) const
{
  std::shared_ptr<const PlanningScene> scene;
  {
    std::unique_lock<std::mutex> lock(mutex_);
    while (scene_->revision < revision && Clock::now() < until)
    {
      if (stop && stop())
        throw ShuttingDown();
      arrived_.wait_until(lock, std::min(until, Clock::now() + kPollInterval));
    }
    if (scene_->revision == revision)
      scene = scene_;
    const auto replaced = std::find_if(replaced_.begin(), replaced_.end(),
                                       [&](const Replaced& one) { return one.scene->revision == revision; });
    if (!scene && replaced != replaced_.end())
    {
      scene = replaced->scene;
      replaced->time = Clock::now();
      std::rotate(replaced, std::next(replaced), replaced_.end());
    }
    if (!scene)
      throw UnknownRevision(
          "revision " + std::to_string(revision) +
              (revision > scene_->revision ? " of the scene has not arrived" : " of the scene is not kept") +
              "; the newest is " + std::to_string(scene_->revision),
          scene_->revision);
  }
  Snapshot then = snapshot();
  then.scene = std::move(scene);
  return then;
}

void SceneStore::forgetReplaced(Clock::time_point time)
{
  std::deque<Replaced> dropped;  // destroyed without the lock
  const std::lock_guard<std::mutex> lock(mutex_);
  while (!replaced_.empty() && replaced_.front().time < time)
  {
    replaced_shapes_ -= replaced_.front().shapes;
    dropped.push_back(std::move(replaced_.front()));
    replaced_.pop_front();
  }
}

std::string SceneStore::updateState(const std::map<std::string, double>& variables, std::int64_t stamp)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const RobotModel& robot = *scene_->robot;
  std::string warning;
  std::vector<std::string> not_finite;
  for (const auto& [name, value] : variables)
  {
    const int variable = robot.variableIndex(name);
    if (variable < 0)
      continue;
    const auto index = static_cast<std::size_t>(variable);
    if (!std::isfinite(value))
    {
      known_[index] = false;
      state_[index] = PartialState(robot).values[index];
      measured_at_[index] = Clock::time_point::min();
      stamps_[index] = 0;
      history_.add(index, 0.0, 0);
      not_finite.push_back(name);
      continue;
    }
    state_[index] = value;
    known_[index] = true;
    measured_at_[index] = Clock::now();
    std::int64_t& known = stamps_[index];
    if (stamp != 0 && stamp < known && warning.empty())
      warning = "the time of '" + name + "' jumped back by " +
                std::to_string(static_cast<double>(known - stamp) * 1e-9) +
                " s; the new value counts: if the clock was not set back, look for a second publisher of this joint";
    known = stamp;
    history_.add(index, value, stamp);
  }
  if (!not_finite.empty())
    throw Error("the position is not a finite number, so it is unknown now, of: " + nameList(not_finite));
  return warning;
}

std::vector<double> SceneStore::stateAt(std::int64_t stamp) const
{
  std::vector<double> state;
  std::vector<bool> known;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    state = state_;
    known = known_;
    if (stamp != 0)
      history_.setAt(stamp, state);
  }
  assumeBase(stamp, known, state);
  return state;
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
