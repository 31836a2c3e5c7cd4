// ~watch_trajectory and ~watch: the rest of a trajectory is checked while the scene changes, and a simulated robot
// stops before it hits a box that moves into its way.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <thread>

#include <actionlib_msgs/GoalID.h>
#include <sensor_msgs/JointState.h>

#include "node/child_node.h"
#include "node/node_client.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kRate = 0.25;         // rad/s
constexpr double kSeconds = 6.0;       // of a trajectory
constexpr double kDeceleration = 1.0;  // rad/s^2

/// A robot that turns its first joint at a constant rate, publishes its joint values, and brakes when its goal is
/// cancelled.
class SimulatedRobot
{
 public:
  SimulatedRobot(std::vector<std::string> names, std::vector<double> start)
    : names_(std::move(names)),
      start_(std::move(start)),
      states_(node_.advertise<sensor_msgs::JointState>("/joint_states", 100)),
      cancel_(node_.subscribe<actionlib_msgs::GoalID>("/simulation/cancel", 10,
                                                      [this](const actionlib_msgs::GoalIDConstPtr& goals)
                                                      {
                                                        cancelled_until_ = goals->stamp.toSec();
                                                        brakes_ = true;
                                                      }))
  {
    thread_ = std::thread([this] { run(); });
  }
  ~SimulatedRobot()
  {
    ended_ = true;
    thread_.join();
  }

  void go() { moves_ = true; }
  bool stands() const { return stands_; }
  bool brakes() const { return brakes_; }
  /// Goals that were sent until then are cancelled.
  double cancelledUntil() const { return cancelled_until_; }
  /// Is added to the published values.
  std::atomic<double> error{0.0};
  /// Seconds: the values are published so late.
  std::atomic<double> delay{0.0};

  std::vector<double> stateAt(double time) const
  {
    std::vector<double> state = start_;
    state[0] += kRate * time;
    return state;
  }
  double time() const { return time_; }
  bool isListenedTo() const { return states_.getNumSubscribers() > 0; }

 private:
  void run()
  {
    constexpr double kStep = 0.01;
    double rate = 1.0;
    for (ros::WallRate loop(1.0 / kStep); !ended_; loop.sleep())
    {
      if (moves_ && brakes_)
        rate = std::max(rate - kStep * kDeceleration / kRate, 0.0);
      if (moves_)
        time_ = std::min(time_ + kStep * rate, kSeconds);
      stands_ = rate == 0.0;
      sensor_msgs::JointState message;
      message.header.stamp = ros::Time::now() - ros::Duration(delay);
      message.name = names_;
      message.position = stateAt(time_);
      message.position[0] += error;
      states_.publish(message);
    }
  }

  ros::NodeHandle node_;
  const std::vector<std::string> names_;
  const std::vector<double> start_;
  ros::Publisher states_;
  ros::Subscriber cancel_;
  std::atomic<bool> moves_{false};
  std::atomic<bool> brakes_{false};
  std::atomic<double> cancelled_until_{0.0};  // seconds
  std::atomic<bool> stands_{false};
  std::atomic<bool> ended_{false};
  std::atomic<double> time_{0.0};
  std::thread thread_;
};

class Watch : public RunningNode
{
 public:
  /// The arm is stretched out, so that its tip leaves a place when the first joint turns.
  static void SetUpTestSuite()
  {
    RunningNode::SetUpTestSuite();
    free_state = {-0.75, 0.5, 0.5, 0.0, 0.3, 0.0, 0.0};
  }

  void SetUp() override
  {
    RunningNode::SetUp();
    ASSERT_EQ(robot->variables()[0].name, names()[0]);
    subscriber_ = ros::NodeHandle().subscribe<WatchState>(name("watch"), 1000,
                                                          [this](const WatchState::ConstPtr& state)
                                                          {
                                                            const std::lock_guard<std::mutex> lock(mutex_);
                                                            states_.push_back(*state);
                                                          });
  }
  void TearDown() override
  {
    for (const char* id : {"turn", "short", "a"})
      stopWatching(id);  // refused if the test does not watch it any more
    RunningNode::TearDown();
  }

  static std::vector<std::string> names() { return stateRequest(free_state).joint_names; }

  /// The trajectory of the simulated robot.
  static WatchTrajectory::Request trajectory(const std::string& id)
  {
    WatchTrajectory::Request request;
    request.id = id;
    request.joint_trajectory.joint_names = {names()[0]};
    for (int i = 0; i <= 6; ++i)
    {
      trajectory_msgs::JointTrajectoryPoint point;
      point.time_from_start = ros::Duration(kSeconds * i / 6.0);
      point.positions = {free_state[0] + kRate * kSeconds * i / 6.0};
      request.joint_trajectory.points.push_back(point);
    }
    return request;
  }

  /// The trajectory "turn", which follows joint_states.
  static WatchTrajectory::Request followed(double max_deviation)
  {
    WatchTrajectory::Request request = trajectory("turn");
    request.follow_joint_states = true;
    request.max_deviation = max_deviation;
    return request;
  }

  /// Waits until the node has received the robot's values.
  static bool isMeasured(const SimulatedRobot& simulated)
  {
    if (!becomes([&] { return simulated.isListenedTo(); }))
      return false;
    ros::WallDuration(0.3).sleep();
    return true;
  }

  static WatchTrajectory::Response watch(const WatchTrajectory::Request& request)
  {
    return call<WatchTrajectory>("watch_trajectory", request);
  }
  static WatchTrajectory::Response stopWatching(const std::string& id)
  {
    WatchTrajectory::Request request;
    request.id = id;
    request.stop = true;
    return watch(request);
  }

  WatchState last()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return states_.empty() ? WatchState() : states_.back();
  }
  WatchState firstWith(std::uint8_t verdict)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found =
        std::find_if(states_.begin(), states_.end(), [&](const WatchState& state) { return state.verdict == verdict; });
    return found == states_.end() ? WatchState() : *found;
  }
  /// Waits for a message with this verdict.
  bool comes(std::uint8_t verdict)
  {
    return becomes([&] { return last().verdict == verdict; });
  }

  /// The state of the trajectory at a time.
  static std::vector<double> turned(double time)
  {
    std::vector<double> state = free_state;
    state[0] += kRate * time;
    return state;
  }

  static CollisionObject boxAtTip(const std::vector<double>& state)
  {
    const Eigen::Vector3d at = linkPose(tip, state) * (linkPose(tip, free_state).inverse() * tipPoint());
    return boxObject("box", at, 0.05);
  }

 private:
  std::mutex mutex_;  // guards the next member
  std::vector<WatchState> states_;
  ros::Subscriber subscriber_;
};

TEST_F(Watch, TheRobotStopsBeforeABoxThatMovesIntoItsWay)
{
  SimulatedRobot simulated(names(), free_state);
  ASSERT_TRUE(isMeasured(simulated));
  WatchTrajectory::Request request = followed(0.05);
  request.cancel_action = "/simulation";
  const WatchTrajectory::Response first = watch(request);
  ASSERT_TRUE(first.success) << first.message;
  ASSERT_EQ(first.state.verdict, WatchState::FREE) << first.state.message;
  EXPECT_NEAR(first.state.free_for, kSeconds, 0.3);
  simulated.go();
  ASSERT_TRUE(becomes([&] { return simulated.time() > 1.0; }));
  EXPECT_FALSE(simulated.brakes());
  EXPECT_EQ(last().verdict, WatchState::FREE) << last().message;

  const double before = ros::Time::now().toSec();
  const std::uint64_t revision = apply(diffWith(boxAtTip(simulated.stateAt(4.5))));
  ASSERT_TRUE(comes(WatchState::COLLISION)) << last().message;
  const double told_at = simulated.time();
  ASSERT_TRUE(becomes([&] { return simulated.stands(); }));
  const WatchState found = last();
  EXPECT_EQ(found.scene_revision, revision);
  EXPECT_EQ(found.body_2, "box");
  EXPECT_LE(found.free_for, found.collision_in);
  EXPECT_LT(told_at, 2.5) << "the collision is found seconds before it happens";
  ASSERT_TRUE(becomes([&] { return !last().contacts.empty(); }));
  EXPECT_EQ(last().contacts[0].contact_body_2, "box");
  EXPECT_GT(last().collision_in, 0.5) << "the robot stands, so the rest is still to come";
  EXPECT_GE(simulated.cancelledUntil(), before);
  EXPECT_GT(simulated.cancelledUntil(), firstWith(WatchState::COLLISION).header.stamp.toSec())
      << "a goal that is sent during the check is cancelled too";
  EXPECT_LT(simulated.cancelledUntil(), before + 1.0) << "a goal that is sent now is not cancelled";
  for (int hundredths = 0; hundredths <= 100.0 * simulated.time(); ++hundredths)
    ASSERT_EQ(check(simulated.stateAt(0.01 * hundredths)).valid.at(0), 1) << 0.01 * hundredths;
  EXPECT_EQ(check(simulated.stateAt(4.5)).valid.at(0), 0) << "it would have hit the box";

  apply(diffWith(objectOperation("box", CollisionObject::REMOVE)));
  EXPECT_TRUE(comes(WatchState::FREE)) << "the way is free again";
}

TEST_F(Watch, AChangeIsAnsweredAtOnceHoweverLowTheRateIs)
{
  const ChildNode slow("slow", {"_device:=cpu", "_watch/rate:=0.001"});
  const auto ask = [&](const std::string& service, auto call)
  {
    EXPECT_TRUE(callPersistently(slow.service(service), call)) << service;
    EXPECT_TRUE(call.response.success) << call.response.message;
    return call.response;
  };
  ApplyPlanningScene change;
  change.request.scene = diffScene();
  change.request.scene.robot_state = stateMessage(free_state);
  ask("apply_planning_scene", change);
  std::atomic<std::uint64_t> collides_in{0};
  const auto subscriber = ros::NodeHandle().subscribe<WatchState>(slow.service("watch"), 100,
                                                                  [&](const WatchState::ConstPtr& state)
                                                                  {
                                                                    if (state->verdict == WatchState::COLLISION)
                                                                      collides_in = state->scene_revision;
                                                                  });
  WatchTrajectory watched;
  watched.request = trajectory("turn");
  EXPECT_EQ(ask("watch_trajectory", watched).state.verdict, WatchState::FREE);
  change.request.scene = diffWith(boxAtTip(turned(4.5)));
  const std::uint64_t revision = ask("apply_planning_scene", change).scene_revision;
  EXPECT_TRUE(becomes([&] { return collides_in == revision; }));
}

TEST_F(Watch, ANodeThatEndsSaysThatItWatchesNothing)
{
  const ChildNode ending("ending", {"_device:=cpu"});
  std::atomic<bool> has_said{false};
  const auto subscriber = ros::NodeHandle().subscribe<WatchState>(
      ending.service("watch"), 100,
      [&](const WatchState::ConstPtr& state)
      { has_said = state->verdict == WatchState::UNKNOWN && state->message.find("the node ends") == 0; });
  ASSERT_TRUE(becomes([&] { return subscriber.getNumPublishers() == 1; }));
  WatchTrajectory watched;
  watched.request = trajectory("turn");
  ASSERT_TRUE(callPersistently(ending.service("watch_trajectory"), watched));
  ASSERT_TRUE(watched.response.success) << watched.response.message;
  EXPECT_EQ(watched.response.state.verdict, WatchState::UNKNOWN) << "the node does not know the other joints";
  ending.interrupt();
  EXPECT_TRUE(becomes([&] { return has_said.load(); }));
}

TEST_F(Watch, ANodeThatEndsCancelsTheGoalsThatItWatches)
{
  const ChildNode ending("ending_beside_a_controller", {"_device:=cpu"});
  ApplyPlanningScene start;
  start.request.scene = diffScene();
  start.request.scene.robot_state = stateMessage(free_state);
  ASSERT_TRUE(callPersistently(ending.service("apply_planning_scene"), start));
  std::atomic<int> cancelled{0};
  const auto subscriber = ros::NodeHandle().subscribe<actionlib_msgs::GoalID>(
      "/controller/cancel", 10, [&](const actionlib_msgs::GoalIDConstPtr&) { ++cancelled; });
  WatchTrajectory watched;
  watched.request = trajectory("turn");
  watched.request.cancel_action = "/controller";
  ASSERT_TRUE(callPersistently(ending.service("watch_trajectory"), watched));
  EXPECT_EQ(watched.response.state.verdict, WatchState::FREE) << watched.response.message;
  ros::WallDuration(0.3).sleep();
  EXPECT_EQ(0, cancelled);
  ending.interrupt();
  EXPECT_TRUE(becomes([&] { return cancelled > 0; }));
}

TEST_F(Watch, ATrajectoryWithoutAStampBeginsWithTheFirstVerdict)
{
  std::unique_ptr<SimulatedRobot> late;
  std::thread starter(
      [&late]
      {
        ros::WallDuration(0.3).sleep();
        late = std::make_unique<SimulatedRobot>(names(), free_state);
      });
  WatchTrajectory::Request request = trajectory("turn");
  request.cancel_action = "/simulation";  // the node waits for this server
  const WatchTrajectory::Response response = watch(request);
  starter.join();
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_NEAR(response.state.free_for, kSeconds, 0.15);
}

TEST_F(Watch, AJointWhoseValuesHaveEndedMakesTheRestUnknown)
{
  const ros::Publisher states = ros::NodeHandle().advertise<sensor_msgs::JointState>("/joint_states", 1);
  ASSERT_TRUE(becomes([&] { return states.getNumSubscribers() > 0; }));
  ASSERT_TRUE(watch(trajectory("turn")).success);
  EXPECT_TRUE(comes(WatchState::FREE)) << last().message;
  sensor_msgs::JointState message;
  message.header.stamp = ros::Time::now();
  message.name = {names()[1]};
  message.position = {free_state[1]};
  states.publish(message);
  EXPECT_TRUE(comes(WatchState::UNKNOWN));
  EXPECT_NE(std::string::npos, last().message.find("no value of '" + names()[1] + "'")) << last().message;
}

TEST_F(Watch, NothingIsCancelledUnlessTheNodeIsToldTo)
{
  SimulatedRobot simulated(names(), free_state);
  apply(diffWith(boxAtTip(turned(4.5))));
  ASSERT_EQ(watch(trajectory("turn")).state.verdict, WatchState::COLLISION);
  ros::WallDuration(0.5).sleep();
  EXPECT_FALSE(simulated.brakes());
}

TEST_F(Watch, TwoTrajectoriesAreOneMotionInTime)
{
  // The second joint lifts the arm at 3 s, so the box, which the first joint would reach at 4.5 s, is not hit.
  apply(diffWith(boxAtTip(turned(4.5))));
  WatchTrajectory::Request lift = trajectory("a");
  lift.joint_trajectory.joint_names = {names()[1]};
  for (std::size_t i = 0; i < lift.joint_trajectory.points.size(); ++i)
    lift.joint_trajectory.points[i].positions = {free_state[1] - (i >= 3 ? 0.6 : 0.2 * static_cast<double>(i))};
  ASSERT_EQ(watch(lift).state.verdict, WatchState::FREE) << last().message;
  const WatchState both = watch(trajectory("turn")).state;
  EXPECT_EQ(both.ids, (std::vector<std::string>{"a", "turn"}));
  EXPECT_EQ(both.verdict, WatchState::FREE) << both.body_1 << " " << both.body_2;
  EXPECT_EQ(stopWatching("a").state.verdict, WatchState::COLLISION);
}

TEST_F(Watch, ManyChangesDoNotStopTheChecksAtTheRate)
{
  ASSERT_TRUE(watch(trajectory("turn")).success);
  for (int i = 0; i < 300; ++i)
    apply(diffWith(boxObject("box", farAway(), 0.1 + 0.001 * (i % 2))));
  const ros::Time after = ros::Time::now() + ros::Duration(0.5);
  EXPECT_TRUE(becomes([&] { return last().header.stamp > after; }));
  EXPECT_LT((ros::Time::now() - after).toSec(), 1.0);
}

TEST_F(Watch, SaysWhenTheRobotMustBrake)
{
  const std::uint64_t revision = apply(diffWith(boxAtTip(
      []
      {
        std::vector<double> state = free_state;
        state[0] += kRate * 4.5;
        return state;
      }())));
  const WatchState state = watch(trajectory("turn")).state;
  EXPECT_EQ(state.verdict, WatchState::COLLISION) << state.message;
  EXPECT_EQ(state.scene_revision, revision);
  EXPECT_GT(state.free_for, 1.0);
  EXPECT_LE(state.free_for, state.collision_in);
  EXPECT_LT(state.collision_in, 4.6);
  // At 0.25 rad/s and the limit of the joint, or 1 rad/s^2 without one.
  const double limit = robot->variables()[0].max_acceleration.value_or(1.0);
  EXPECT_NEAR(state.brake_in, state.free_for - 0.5 * kRate / limit, 1e-6);
  EXPECT_TRUE(stopWatching("turn").success);
}

TEST_F(Watch, ATrajectoryThatHasEndedIsNotWatchedAnyMore)
{
  WatchTrajectory::Request request = trajectory("short");
  request.joint_trajectory.header.stamp = ros::Time::now() - ros::Duration(kSeconds - 0.5);
  EXPECT_EQ(watch(request).state.verdict, WatchState::FREE);
  ASSERT_TRUE(comes(WatchState::NONE));
  EXPECT_EQ(last().ended, std::vector<std::string>{"short"});
  EXPECT_TRUE(last().ids.empty());
  const auto stopped = stopWatching("short");
  EXPECT_FALSE(stopped.success);
  EXPECT_EQ(stopped.status, AnswerStatus::INVALID_REQUEST);
}

TEST_F(Watch, ARobotThatIsLateByTheClockStaysWatchedUntilItArrives)
{
  SimulatedRobot simulated(names(), free_state);
  ASSERT_TRUE(isMeasured(simulated));
  WatchTrajectory::Request request = trajectory("turn");
  request.joint_trajectory.header.stamp = ros::Time::now() - ros::Duration(kSeconds + 0.5);
  request.max_deviation = 0.1;
  simulated.go();
  EXPECT_EQ(watch(request).state.verdict, WatchState::OFF_PATH) << "its time is over, and it begins to move";
  ros::WallDuration(2.0).sleep();
  EXPECT_EQ(last().ids, std::vector<std::string>{"turn"});
  ASSERT_TRUE(comes(WatchState::NONE));
  EXPECT_EQ(last().ended, std::vector<std::string>{"turn"});
  EXPECT_GT(simulated.time(), kSeconds - 0.5) << "it has arrived";
}

TEST_F(Watch, ARobotThatHasStoppedOnItsWayIsNotWatchedAfterTheEndOfItsTrajectory)
{
  SimulatedRobot simulated(names(), free_state);
  ASSERT_TRUE(isMeasured(simulated));
  WatchTrajectory::Request request = trajectory("turn");
  request.joint_trajectory.header.stamp = ros::Time::now() - ros::Duration(kSeconds + 0.5);
  request.max_deviation = 0.1;
  const ros::WallTime begin = ros::WallTime::now();
  EXPECT_EQ(watch(request).state.verdict, WatchState::OFF_PATH);
  ASSERT_TRUE(comes(WatchState::OFF_PATH));  // the last message of an earlier test has another verdict
  ASSERT_TRUE(comes(WatchState::NONE));
  EXPECT_GT((ros::WallTime::now() - begin).toSec(), 0.9);
}

TEST_F(Watch, TheWayBackOfARobotThatWasPushedBackCounts)
{
  SimulatedRobot simulated(names(), free_state);
  ASSERT_TRUE(isMeasured(simulated));
  WatchTrajectory::Request request = followed(0.6);
  ASSERT_EQ(watch(request).state.verdict, WatchState::FREE) << last().message;
  const double place = kRate * 3.0;
  simulated.error = place;  // as if it had moved there
  ASSERT_TRUE(becomes([&] { return last().free_for < 3.5; }));
  apply(diffWith(boxAtTip(turned(1.8))));
  ros::WallDuration(0.3).sleep();
  EXPECT_EQ(last().verdict, WatchState::FREE) << "the box is behind it";
  simulated.error = kRate * 0.7;
  ASSERT_TRUE(comes(WatchState::COLLISION));
  EXPECT_EQ(last().body_2, "box");
  EXPECT_EQ(last().free_for, 0.0);
  PlanningSceneMessage both = diffWith(boxAtTip(turned(5.5)));
  both.world.collision_objects[0].id = "ahead";
  apply(both);
  ros::WallDuration(0.3).sleep();
  EXPECT_EQ(last().body_2, "box") << "the first collision counts";
  EXPECT_EQ(last().collision_in, 0.0);
  EXPECT_LT(last().brake_in, 0.0);
  apply(diffWith(objectOperation("ahead", CollisionObject::REMOVE)));
  simulated.error = place;
  EXPECT_TRUE(comes(WatchState::FREE));
  apply(diffWith(objectOperation("box", CollisionObject::REMOVE)));
}

TEST_F(Watch, AMeasuredValueALittleBeyondItsLimitIsNoFault)
{
  std::vector<double> state = free_state;
  const auto grip = static_cast<std::size_t>(robot->variableIndex("grip"));
  state[grip] = robot->variables()[grip].lower - 0.002;
  SimulatedRobot simulated(names(), state);
  ASSERT_TRUE(isMeasured(simulated));
  WatchTrajectory::Request request = followed(0.05);
  request.joint_trajectory.joint_names.push_back("grip");
  for (auto& point : request.joint_trajectory.points)
    point.positions.push_back(robot->variables()[grip].lower);
  EXPECT_EQ(watch(request).state.verdict, WatchState::FREE) << last().message;
}

TEST_F(Watch, ValuesWithOldStampsAreNotMeasuredNow)
{
  SimulatedRobot simulated(names(), free_state);
  ASSERT_TRUE(isMeasured(simulated));
  WatchTrajectory::Request request = followed(0.1);
  ASSERT_EQ(watch(request).state.verdict, WatchState::FREE) << last().message;
  simulated.delay = 0.5;
  ASSERT_TRUE(comes(WatchState::UNKNOWN));
  EXPECT_NE(last().message.find("late"), std::string::npos) << last().message;
  simulated.delay = 0.0;
  EXPECT_TRUE(comes(WatchState::FREE));
}

TEST_F(Watch, ARobotBesideItsTrajectoryIsNotFree)
{
  SimulatedRobot simulated(names(), free_state);
  ASSERT_TRUE(isMeasured(simulated));
  WatchTrajectory::Request request = followed(0.05);
  ASSERT_EQ(watch(request).state.verdict, WatchState::FREE) << last().message;
  simulated.error = -0.2;
  ASSERT_TRUE(comes(WatchState::OFF_PATH));
  EXPECT_NEAR(last().deviations.at(0), 0.2, 0.01);
  EXPECT_EQ(last().free_for, 0.0);
  simulated.error = 0.0;
  EXPECT_TRUE(comes(WatchState::FREE));
}

TEST_F(Watch, ARobotThatIsNotMeasuredIsUnknown)
{
  ros::WallDuration(1.2).sleep();  // values of earlier tests are older than a second
  WatchTrajectory::Request request = followed(0.1);
  const WatchTrajectory::Response response = watch(request);
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_EQ(response.state.verdict, WatchState::UNKNOWN);
  EXPECT_NE(response.state.message.find("joint_states"), std::string::npos) << response.state.message;
}

TEST_F(Watch, WrongRequestsAreRefusedAndNothingElseIsWatched)
{
  const auto refuses = [](const WatchTrajectory::Request& request, const std::string& reason)
  {
    const auto response = watch(request);
    EXPECT_FALSE(response.success) << reason;
    EXPECT_EQ(response.status, AnswerStatus::INVALID_REQUEST) << response.message;
    EXPECT_NE(response.message.find(reason), std::string::npos) << response.message;
  };
  refuses(trajectory(""), "no name");
  WatchTrajectory::Request request = trajectory("a");
  request.joint_trajectory.points[2].time_from_start = ros::Duration(0.5);
  refuses(request, "row 2");
  request = trajectory("a");
  request.joint_trajectory.joint_names = {"no such joint"};
  refuses(request, "no such joint");
  request = trajectory("a");
  request.max_deviation = -1.0;
  refuses(request, "max_deviation");
  request = trajectory("a");
  request.joint_trajectory.points.clear();
  refuses(request, "points");
  request = trajectory("a");
  request.follow_joint_states = true;
  refuses(request, "needs max_deviation");
  request = trajectory("a");
  request.cancel_action = "/no_such_action";
  refuses(request, "nobody listens to /no_such_action/cancel");
  request = trajectory("a");
  request.joint_trajectory.header.stamp = ros::Time::now() + ros::Duration(20.0);
  request.joint_trajectory.points.erase(request.joint_trajectory.points.begin());
  refuses(request, "give a first point at 0 s");
  ASSERT_TRUE(watch(trajectory("a")).success);
  request = trajectory("b");
  request.follow_joint_states = true;
  request.max_deviation = 0.1;
  refuses(request, "follows joint_states");
  refuses(trajectory("b"), "is moved by the trajectory 'a'");
  EXPECT_TRUE(becomes([&] { return last().ids == std::vector<std::string>{"a"}; }));
  EXPECT_TRUE(watch(trajectory("a")).success) << "a trajectory of the same name is replaced";
}
}  // namespace
}  // namespace gpu_planning_scene::core
