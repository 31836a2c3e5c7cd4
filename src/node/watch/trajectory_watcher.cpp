#include "node/watch/trajectory_watcher.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <actionlib_msgs/GoalID.h>

#include "base/seconds_since.h"
#include "gpu_planning_scene/error.h"
#include "model/full_states.h"
#include "node/endpoints/respond.h"
#include "node/messages/contact_messages.h"
#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool isFault(const WatchState& state)
{
  return state.verdict != WatchState::FREE && state.verdict != WatchState::NONE;
}

/// The motion of the whole robot from now (0 s) on. Each trajectory continues from where the robot is on it.
TimedRows restOf(const Snapshot& scene, const std::vector<Watched>& watched)
{
  const RobotModel& robot = *scene.scene->robot;
  std::vector<const WatchedTrajectory*> trajectories;
  std::vector<double> delays;
  std::vector<int> columns;
  std::vector<double> values;
  for (const Watched& each : watched)
  {
    trajectories.push_back(&each.trajectory);
    delays.push_back(-each.progress.time);
    columns.insert(columns.end(), each.trajectory.columns.begin(), each.trajectory.columns.end());
    const std::vector<double> row = rowAt(robot, each.trajectory, each.progress.time);
    values.insert(values.end(), row.begin(), row.end());
  }
  const std::vector<double> state = fullStates(robot, columns, values.data(), 1, scene.partialState());
  return motionOfAll(robot, trajectories, delays, state, 0.0);
}

/// Throws Error if another trajectory moves a joint of this one.
void requireOwnJoints(const RobotModel& robot, const Watched& added, const std::vector<Watched>& watched)
{
  for (const Watched& other : watched)
    for (const int column : added.trajectory.columns)
      if (other.id != added.id &&
          std::count(other.trajectory.columns.begin(), other.trajectory.columns.end(), column) != 0)
        throw Error("'" + robot.variables()[static_cast<std::size_t>(column)].name + "' is moved by the trajectory '" +
                    other.id + "', which is watched; stop watching it first");
}
}  // namespace

TrajectoryWatcher::TrajectoryWatcher(ros::NodeHandle& node, ros::NodeHandle& own, SceneStore& store,
                                     MakeChecker make_checker, InspectorOf inspector_of,
                                     std::function<void()> require_scene, const WatcherOptions& options)
  : node_(node),
    store_(store),
    make_checker_(std::move(make_checker)),
    inspector_of_(std::move(inspector_of)),
    require_scene_(std::move(require_scene)),
    options_(options),
    publisher_(own.advertise<WatchState>("watch", 100, true)),
    thread_([this] { run(); })
{
  store_.setListener(
      this,
      [this](const auto& /*before*/, const auto& /*after*/)
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        scene_changed_ = scene_changed_.value_or(Clock::now());
        changed_.notify_one();
      });
}

TrajectoryWatcher::~TrajectoryWatcher()
{
  stop();
}

void TrajectoryWatcher::stop()
{
  store_.setListener(this, {});
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
    changed_.notify_one();
  }
  if (thread_.joinable())
    thread_.join();
  if (!watched_.empty())
  {
    WatchState state;
    state.header.stamp = ros::Time::now();
    state.verdict = WatchState::UNKNOWN;
    state.message = "the node ends; nothing is watched any more";
    state.brake_in = -kInfinity;
    state.collision_in = kInfinity;
    for (const Watched& each : watched_)
      state.ended.push_back(each.id);
    publisher_.publish(state);
    watched_.clear();
  }
  for (Order& order : orders_)
    order.answer.set_exception(std::make_exception_ptr(ShuttingDown()));
  orders_.clear();
}

WatchTrajectory::Response TrajectoryWatcher::watch(const WatchTrajectory::Request& request)
{
  return respond<WatchTrajectory::Response>(
      [&](WatchTrajectory::Response& response)
      {
        Order order;
        if (request.stop)
          order.removed = request.id;
        else
          order.added = newWatched(request);
        response.state = submit(std::move(order)).get();
      });
}

Watched TrajectoryWatcher::newWatched(const WatchTrajectory::Request& request)
{
  if (const std::size_t rows =
          std::max(request.joint_trajectory.points.size(), request.multi_dof_joint_trajectory.points.size());
      rows > options_.max_rows)
    throw Error("the trajectory has " + std::to_string(rows) + " points; the limit is " +
                std::to_string(options_.max_rows));
  Watched added = watchedOf(request, store_.snapshot(), ros::Time::now());
  if (!request.cancel_action.empty())
    added.cancel = node_.advertise<actionlib_msgs::GoalID>(request.cancel_action + "/cancel", 10);
  return added;
}

std::future<WatchState> TrajectoryWatcher::submit(Order order)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (stopping_)
    throw ShuttingDown();
  std::future<WatchState> answer = order.answer.get_future();
  orders_.push_back(std::move(order));
  changed_.notify_one();
  return answer;
}

void TrajectoryWatcher::run()
{
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / options_.rate));
  Clock::time_point due = Clock::now();
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopping_)
  {
    const auto is_called = [this] { return stopping_ || !orders_.empty() || (scene_changed_ && !watched_.empty()); };
    if (watched_.empty())
      changed_.wait(lock, is_called);
    else
      changed_.wait_until(lock, due, is_called);
    if (stopping_)
      return;
    std::vector<Order> orders = std::move(orders_);
    orders_.clear();
    const bool is_due = orders.empty() && !scene_changed_;
    const bool is_change = scene_changed_ && !watched_.empty();
    const Clock::time_point cause = is_due ? due : is_change ? *scene_changed_ : Clock::now();
    scene_changed_.reset();
    lock.unlock();

    take(orders);
    WatchState state = look(is_due);
    if (isFault(state))
      cancelGoals();
    state.latency = secondsSince(cause);
    publisher_.publish(state);
    for (Order& order : orders)
      order.answer.set_value(state);
    due = Clock::now() + period;
    lock.lock();
  }
}

/// Carries out the orders, and drops those that cannot be carried out: they get their error.
void TrajectoryWatcher::take(std::vector<Order>& orders)
{
  const auto fails = [this](Order& order)
  {
    try
    {
      carryOut(order);
      return false;
    }
    catch (...)
    {
      order.answer.set_exception(std::current_exception());
      return true;
    }
  };
  orders.erase(std::remove_if(orders.begin(), orders.end(), fails), orders.end());
}

void TrajectoryWatcher::carryOut(Order& order)
{
  const std::string& id = order.added ? order.added->id : order.removed;
  const auto same = std::find_if(watched_.begin(), watched_.end(), [&](const Watched& each) { return each.id == id; });
  if (!order.added)
  {
    if (same == watched_.end())
      throw Error("no trajectory '" + id + "' is watched; it may have ended");
    watched_.erase(same);
    ended_.push_back(id);
    return;
  }
  for (const Watched& other : watched_)
    if (other.id != id && (other.follows || order.added->follows))
      throw Error("'" + (other.follows ? other.id : id) +
                  "' follows joint_states, so no other trajectory can be watched beside it: where one robot is late, "
                  "nothing is known about the place of both; watch several trajectories by the clock, with "
                  "max_deviation");
  requireOwnJoints(*store_.snapshot().scene->robot, *order.added, watched_);
  if (same != watched_.end())
    *same = std::move(*order.added);
  else if (watched_.size() >= options_.max_watched)
    throw Busy(std::to_string(watched_.size()) + " trajectories are watched already; stop watching one");
  else
    watched_.push_back(std::move(*order.added));
}

WatchState TrajectoryWatcher::look(bool with_contact)
{
  WatchState state;
  state.header.stamp = ros::Time::now();
  state.collision_in = kInfinity;
  state.brake_in = kInfinity;
  const Fault fault = faultOf(
      [&]
      {
        require_scene_();
        const Snapshot scene = store_.snapshot();
        state.header.frame_id = scene.scene->robot->planningFrame();
        state.scene_revision = scene.scene->revision;
        for (Watched& each : watched_)
          findProgress(scene, state.header.stamp, each);
        const auto ended = std::stable_partition(watched_.begin(), watched_.end(),
                                                 [](const Watched& each) { return !hasEnded(each); });
        for (auto each = ended; each != watched_.end(); ++each)
          ended_.push_back(each->id);
        watched_.erase(ended, watched_.end());
        state.verdict = WatchState::NONE;
        if (!watched_.empty())
          check(scene, with_contact, state);
      });
  if (fault)
  {
    state.verdict = WatchState::UNKNOWN;
    state.message = fault.message;
    state.brake_in = -kInfinity;
  }
  for (const Watched& each : watched_)
  {
    state.ids.push_back(each.id);
    state.deviations.push_back(each.progress.deviation);
  }
  state.ended = std::exchange(ended_, {});
  return state;
}

void TrajectoryWatcher::check(const Snapshot& scene, bool with_contact, WatchState& state)
{
  if (checkers_scene_ != scene.scene)
  {
    checkers_scene_.reset();  // until the checker has the new one
    if (checker_)
      checker_->setScene(scene.scene);
    else
      checker_ = make_checker_(scene.scene);
    checkers_scene_ = scene.scene;
  }
  const MotionChecker checker(checker_, scene.scene->robot, "", options_.motions);
  describe(outlookOf(checker, *scene.scene->robot, restOf(scene, watched_)), scene, with_contact, state);
  for (const Watched& each : watched_)
    if (each.max_deviation > 0.0 && !(each.progress.deviation <= each.max_deviation))
    {
      if (state.verdict != WatchState::COLLISION)
        state.verdict = WatchState::OFF_PATH;
      state.message = "'" + each.id + "' is " + std::to_string(each.progress.deviation) +
                      " (radians or metres) beside its trajectory; at most " + std::to_string(each.max_deviation) +
                      " are allowed";
      state.free_for = 0.0;
      state.brake_in = -kInfinity;
    }
}

void TrajectoryWatcher::describe(const MotionOutlook& outlook, const Snapshot& scene, bool with_contact,
                                 WatchState& state)
{
  state.verdict = outlook.free                   ? WatchState::FREE
                  : outlook.colliding == kNoPair ? WatchState::NOT_PROVEN
                                                 : WatchState::COLLISION;
  state.free_for = outlook.free_until;
  state.collision_in = outlook.collision;
  state.brake_in = outlook.brake_by;
  if (outlook.colliding == kNoPair)
    return;
  state.body_1 = scene.scene->bodyName(outlook.colliding[0]);
  state.body_2 = scene.scene->bodyName(outlook.colliding[1]);
  if (!with_contact)
    return;
  state.message = errorOf(
      [&]
      {
        for (const Contact& contact : inspector_of_(scene.scene)->contacts(outlook.state.data(), "", 256, 1))
          if (contact.bodies == outlook.colliding)
            state.contacts = {messageOf(contact, *scene.scene, 0)};
      });
}

void TrajectoryWatcher::cancelGoals() const
{
  for (const Watched& each : watched_)
    if (each.cancel)
      each.cancel.publish(actionlib_msgs::GoalID());  // an empty one cancels all goals
}
}  // namespace gpu_planning_scene::core
