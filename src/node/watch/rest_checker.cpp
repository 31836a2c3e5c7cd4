#include "node/watch/rest_checker.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "gpu_planning_scene/error.h"
#include "model/full_states.h"
#include "node/checks/requested_motions.h"
#include "node/endpoints/respond.h"
#include "node/messages/contact_messages.h"

namespace gpu_planning_scene::core
{
namespace
{
/// The variables of all trajectories.
std::vector<int> columnsOf(const std::vector<Watched>& watched)
{
  std::vector<int> columns;
  for (const Watched& each : watched)
    columns.insert(columns.end(), each.trajectory.columns.begin(), each.trajectory.columns.end());
  return columns;
}

/// The motion from now (0 s) on. Each trajectory continues from the robot's place on it.
TimedRows restOf(const Snapshot& scene, const std::vector<Watched>& watched)
{
  const RobotModel& robot = *scene.scene->robot;
  std::vector<const WatchedTrajectory*> trajectories;
  std::vector<double> delays;
  std::vector<double> values;
  for (const Watched& each : watched)
  {
    trajectories.push_back(&each.trajectory);
    delays.push_back(-each.time);
    const std::vector<double> row = rowAt(robot, each.trajectory, each.time);
    values.insert(values.end(), row.begin(), row.end());
  }
  const std::vector<double> state = fullStates(robot, columnsOf(watched), values.data(), 1, scene.partialState());
  return motionOfAll(robot, trajectories, delays, state, 0.0);
}

/// `first`, the first row of the rest, with the measured values of the robots that are followed and near their places.
std::vector<double> measuredStart(const Snapshot& scene, const std::vector<Watched>& watched, const double* first)
{
  std::vector<double> here(first, first + scene.state.size());
  for (const Watched& each : watched)
    if (each.max_deviation > 0.0 && each.deviation <= each.max_deviation)
      for (const int column : each.trajectory.columns)
        here[static_cast<std::size_t>(column)] = scene.state[static_cast<std::size_t>(column)];
  return here;
}

/// A message why nothing is proven although nothing is known to collide.
std::string whyUnproven(const RobotModel& robot, const TimedRows& motion)
{
  const std::string beyond =
      beyondLimits(robot, motion.values.data(), motion.seconds.size(),
                   [](std::size_t row) { return "row " + std::to_string(row) + " of the rest"; });
  return beyond.empty() ? "bodies almost touch, or the proof needs too many checks" : beyond;
}

/// The places of the robot are older than the message, so all of its times come sooner.
void age(double seconds, WatchState& state)
{
  state.free_for = std::max(state.free_for - seconds, 0.0);
  state.collision_in = std::max(state.collision_in - seconds, 0.0);
  state.brake_in -= seconds;
}

void markDeviation(const std::vector<Watched>& watched, WatchState& state)
{
  for (const Watched& each : watched)
  {
    if (!(each.max_deviation > 0.0) || each.deviation <= each.max_deviation)
      continue;
    if (state.verdict != WatchState::COLLISION)
      state.verdict = WatchState::OFF_PATH;
    state.message = "'" + each.id + "' is " + std::to_string(each.deviation) +
                    " (radians or metres) beside its trajectory; at most " + std::to_string(each.max_deviation) +
                    " are allowed";
    state.free_for = 0.0;
    state.brake_in = -std::numeric_limits<double>::infinity();
  }
}
}  // namespace

RestChecker::RestChecker(MakeChecker make_checker, InspectorOf inspector_of, const MotionCheckerOptions& options)
  : make_checker_(std::move(make_checker)), inspector_of_(std::move(inspector_of)), options_(options)
{
}

void RestChecker::takeScene(const std::shared_ptr<const PlanningScene>& scene)
{
  if (scene_ == scene)
    return;
  scene_.reset();
  if (checker_)
    checker_->setScene(scene);
  else
    checker_ = make_checker_(scene);
  scene_ = scene;
}

void RestChecker::check(const Snapshot& scene, const std::vector<Watched>& watched, bool with_contact,
                        const std::function<bool()>& is_over, WatchState& state)
{
  if (const std::string fault = scene.endedVariable(columnsOf(watched)); !fault.empty())
    throw Error(fault);
  if (!scene.octomap_fault.empty())
    throw Error(scene.octomap_fault);
  takeScene(scene.scene);
  const RobotModel& robot = *scene.scene->robot;
  const TimedRows rest = restOf(scene, watched);
  const MotionOutlook outlook =
      outlookOf(MotionChecker(checker_, scene.scene->robot, "", options_), robot, rest, is_over);
  state.free_for = outlook.free_until;
  state.collision_in = outlook.collision;
  state.brake_in = outlook.brake_by;
  if (outlook.free)
    state.verdict = WatchState::FREE;
  else if (outlook.colliding == kNoPair)
  {
    state.verdict = WatchState::NOT_PROVEN;
    state.message = whyUnproven(robot, rest);
  }
  else
  {
    state.verdict = WatchState::COLLISION;
    state.body_1 = scene.scene->bodyName(outlook.colliding[0]);
    state.body_2 = scene.scene->bodyName(outlook.colliding[1]);
    if (with_contact)
      addContact(outlook, *scene.scene, state);
  }
  checkStart(scene, watched, rest, is_over, state);
  age(std::max_element(watched.begin(), watched.end(), [](const Watched& a, const Watched& b) { return a.age < b.age; })
          ->age,
      state);
  markDeviation(watched, state);
  addWarning(scene.assumedBase(columnsOf(watched)), state.message);
}

/// The robot is not quite at its places on the trajectories, and may even have been pushed back, so its way to them
/// counts too.
void RestChecker::checkStart(const Snapshot& scene, const std::vector<Watched>& watched, const TimedRows& rest,
                             const std::function<bool()>& is_over, WatchState& state) const
{
  const RobotModel& robot = *scene.scene->robot;
  const double* const place = rest.values.data();
  const std::vector<double> here = measuredStart(scene, watched, place);
  if (std::equal(here.begin(), here.end(), place))
    return;
  MotionCheckerOptions options = options_;
  // Nothing is proven beyond the limits, and a measured value may be a little beyond them.
  if (!beyondLimits(robot, here.data(), 1, [](std::size_t) { return std::string(); }).empty())
    options.rule = MotionRule::Samples;
  const MotionVerdict verdict = MotionChecker(checker_, scene.scene->robot, "", options)
                                    .check(here.data(), place, 1, MotionQuery::Valid, is_over)
                                    .front();
  if (verdict.valid)
    return;
  if (is_over())
    throw Cancelled();
  state.free_for = 0.0;
  state.brake_in = -std::numeric_limits<double>::infinity();
  const bool collides = verdict.colliding != kNoPair;
  const std::string what =
      std::string("the way from the robot's measured state to its place on the trajectory ") +
      (collides ? "collides" : "is not proven free: bodies almost touch, or the proof needs too many checks");
  if (!collides && state.verdict == WatchState::COLLISION)  // of the rest, which says more
  {
    addWarning(what, state.message);
    return;
  }
  state.collision_in = 0.0;
  state.contacts.clear();
  state.verdict = collides ? WatchState::COLLISION : WatchState::NOT_PROVEN;
  state.message = what;
  state.body_1 = collides ? scene.scene->bodyName(verdict.colliding[0]) : "";
  state.body_2 = collides ? scene.scene->bodyName(verdict.colliding[1]) : "";
}

void RestChecker::addContact(const MotionOutlook& outlook, const PlanningScene& scene, WatchState& state) const
{
  state.message = errorOf(
      [&]
      {
        for (const Contact& contact : inspector_of_(scene_)->contacts(outlook.state.data(), "", 256, 1))
          if (contact.bodies == outlook.colliding)
            state.contacts = {messageOf(contact, scene, 0)};
      });
}
}  // namespace gpu_planning_scene::core
