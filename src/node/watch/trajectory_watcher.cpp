#include "node/watch/trajectory_watcher.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <actionlib_msgs/GoalID.h>

#include "base/seconds_since.h"
#include "gpu_planning_scene/error.h"
#include "node/endpoints/respond.h"
#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::chrono::seconds kFindAction{1};  // for the connection to an action server
constexpr int kContactPeriods = 4;              // of ~watch/rate: the longest time without a contact
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool isFault(const WatchState& state)
{
  return state.verdict != WatchState::FREE && state.verdict != WatchState::NONE;
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
                                     MakeChecker make_checker, RestChecker::InspectorOf inspector_of,
                                     std::function<void()> require_scene, const WatcherOptions& options)
  : node_(node),
    store_(store),
    require_scene_(std::move(require_scene)),
    options_(options),
    publisher_(own.advertise<WatchState>("watch", 100, true)),
    rest_checker_(std::move(make_checker), std::move(inspector_of), options.motions)
{
  store_.setListener(
      this,
      [this](const auto& /*before*/, const auto& /*after*/)
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        scene_changed_ = scene_changed_.value_or(Clock::now());
        changed_.notify_one();
      });
  thread_ = std::thread([this] { run(); });
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
  if (!watched_.empty() && !has_said_the_end_)
  {
    has_said_the_end_ = true;
    WatchState state;
    state.header.stamp = ros::Time::now();
    state.verdict = WatchState::UNKNOWN;
    state.message = "the node ends; nothing is watched any more";
    state.brake_in = -kInfinity;
    state.collision_in = kInfinity;
    for (const Watched& each : watched_)
      state.ended.push_back(each.id);
    cancelGoals(state);  // The publishers stay, because a publisher that is destroyed drops what it has not sent.
    publisher_.publish(state);
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
          order.added = newWatched(request, response.message);
        response.state = submit(std::move(order)).get();
      });
}

Watched TrajectoryWatcher::newWatched(const WatchTrajectory::Request& request, std::string& warnings)
{
  if (const std::size_t rows =
          std::max(request.joint_trajectory.points.size(), request.multi_dof_joint_trajectory.points.size());
      rows > options_.max_rows)
    throw Error("the trajectory has " + std::to_string(rows) + " points; the limit is " +
                std::to_string(options_.max_rows));
  Watched added = watchedOf(request, store_.snapshot(), ros::Time::now(), warnings);
  if (request.cancel_action.empty())
    return added;
  added.cancel = node_.advertise<actionlib_msgs::GoalID>(request.cancel_action + "/cancel", 10);
  const auto until = Clock::now() + kFindAction;
  while (added.cancel.getNumSubscribers() == 0)
  {
    if (Clock::now() > until)
      throw Error("nobody listens to " + added.cancel.getTopic() +
                  "; cancel_action must be the name of a running "
                  "action server");
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
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
  Clock::time_point contact_due = due;
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
    // A change is answered without a contact, because its search takes as long as the check. The contact follows at
    // once, unless changes come all the time.
    const bool with_contact = is_due || Clock::now() >= contact_due + kContactPeriods * period;
    WatchState state = look(with_contact);
    if (with_contact)
      contact_due = Clock::now() + period;
    cancelGoals(state);
    for (Watched& each : watched_)
      if (each.start.isZero())
        each.start = ros::Time::now();
    state.latency = secondsSince(cause);
    publisher_.publish(state);
    for (Order& order : orders)
      order.answer.set_value(state);
    due = Clock::now();
    if (state.verdict != WatchState::COLLISION || with_contact)
      due += period;
    lock.lock();
  }
}

/// Carries out the orders, and drops those that cannot be carried out: they get their error.
void TrajectoryWatcher::take(std::vector<Order>& orders)
{
  std::vector<Order> taken;
  for (Order& order : orders)
    try
    {
      carryOut(order);
      taken.push_back(std::move(order));
    }
    catch (...)
    {
      order.answer.set_exception(std::current_exception());
    }
  orders = std::move(taken);
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
                  "' follows joint_states, so no other trajectory can be watched beside it: if one robot were "
                  "late, the times at which both pass a place would not be known; watch several trajectories by the "
                  "clock, with max_deviation");
  std::size_t rows = order.added->trajectory.rows.seconds.size();
  for (const Watched& other : watched_)
    rows += other.id == id ? 0 : other.trajectory.rows.seconds.size();
  if (rows > options_.max_rows)
    throw Busy("all watched trajectories together would have " + std::to_string(rows) + " points; the limit is " +
               std::to_string(options_.max_rows) + ": stop watching one");
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
  const auto until =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options_.longest_check));
  const auto is_over = [&] { return stopping_ || Clock::now() > until; };
  const Fault fault = faultOf(
      [&]
      {
        require_scene_();
        const Snapshot scene = store_.snapshot();
        state.header.frame_id = scene.scene->robot->planningFrame();
        state.scene_revision = scene.scene->revision;
        for (Watched& each : watched_)
          findPlace(scene, state.header.stamp, each);
        for (const Watched& each : watched_)
          if (each.has_ended)
            ended_.push_back(each.id);
        watched_.erase(
            std::remove_if(watched_.begin(), watched_.end(), [](const Watched& each) { return each.has_ended; }),
            watched_.end());
        state.verdict = WatchState::NONE;
        if (!watched_.empty())
          rest_checker_.check(scene, watched_, with_contact, is_over, state);
      });
  if (fault)
  {
    state.verdict = WatchState::UNKNOWN;
    state.message =
        is_over() ? "the check has taken more than " + std::to_string(options_.longest_check) + " s" : fault.message;
    state.free_for = 0.0;
    state.collision_in = kInfinity;
    state.brake_in = -kInfinity;
  }
  for (const Watched& each : watched_)
  {
    state.ids.push_back(each.id);
    state.deviations.push_back(each.deviation);
  }
  state.ended = std::exchange(ended_, {});
  return state;
}

/// Cancels the goals that were sent before the way was blocked. Goals that come later, for example to leave the place,
/// are not cancelled.
void TrajectoryWatcher::cancelGoals(const WatchState& state)
{
  for (Watched& each : watched_)
  {
    if (!isFault(state))
      each.blocked_since = ros::Time();
    else if (each.blocked_since.isZero())
      each.blocked_since = ros::Time::now();  // not the beginning of the check: a goal may have come since then
    if (!isFault(state) || !each.cancel)
      continue;
    actionlib_msgs::GoalID goals;  // without an id: all goals up to the stamp
    goals.stamp = each.blocked_since;
    each.cancel.publish(goals);
  }
}
}  // namespace gpu_planning_scene::core
