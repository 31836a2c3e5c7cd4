// The node follows the scene of a move_group: MoveIt's own planning scene publishes, the node follows.

#include <atomic>
#include <chrono>
#include <set>
#include <thread>

#include <moveit_msgs/GetStateValidity.h>
#include <rosgraph_msgs/Log.h>
#include <sensor_msgs/JointState.h>

#include "node/child_node.h"
#include "node/moveit/move_group.h"
#include "node/moveit/moveit_client.h"
#include "node/node_client.h"

namespace gpu_planning_scene::core
{
namespace
{
using Clock = std::chrono::steady_clock;

constexpr double kLongest = 15.0;  // seconds: longest wait for the node
constexpr int kStates = 40;        // per comparison of verdicts

/// A move_group, and a node that follows it.
class Following : public testing::Test
{
 public:
  static void SetUpTestSuite() { model = moveItPanda(); }
  static void TearDownTestSuite() { model.reset(); }

  Following() : random_(1)
  {
    log_ = ros::NodeHandle().subscribe<rosgraph_msgs::Log>(
        "/rosout", 1000, [this](const rosgraph_msgs::LogConstPtr& message) { take(*message); });
  }

  void startNode(const std::string& period = "0.3", const std::string& timeout = "1.0")
  {
    node_ = std::make_unique<ChildNode>(
        "follower", std::vector<std::string>{"_device:=cpu", "_monitor:=/arm/move_group", "_monitor_period:=" + period,
                                             "_monitor_timeout:=" + timeout});
  }

  /// The node's scene as MoveIt's message. No value: the node refuses to answer.
  std::optional<moveit_msgs::PlanningScene> nodeScene() const
  {
    GetPlanningScene call;
    if (!callPersistently(node_->service("get_planning_scene"), call) || !call.response.success)
      return std::nullopt;
    return asMoveItMessage(call.response.scene);
  }

  /// The difference between the two scenes that remains.
  std::string remainingDifference()
  {
    std::string difference;
    for (const auto end = Clock::now() + std::chrono::duration<double>(kLongest); Clock::now() < end;)
    {
      const std::optional<moveit_msgs::PlanningScene> scene = nodeScene();
      difference = scene ? differenceOf(group_.whole(), *scene) : "the node refuses to answer";
      if (difference.empty())
        return "";
      ros::WallDuration(0.05).sleep();
    }
    return difference;
  }

  std::vector<moveit::core::RobotState> randomStates(int count)
  {
    std::vector<moveit::core::RobotState> states;
    random_numbers::RandomNumberGenerator numbers(random_());
    for (int i = 0; i < count; ++i)
    {
      states.emplace_back(model);
      states.back().setToDefaultValues();
      states.back().setToRandomPositions(model->getJointModelGroup("panda_arm"), numbers);
    }
    return states;
  }

  CheckStates::Response check(const std::vector<moveit::core::RobotState>& states) const
  {
    CheckStates call;
    for (const moveit::core::JointModel* joint : model->getActiveJointModels())
      for (const std::string& name : joint->getVariableNames())
        call.request.joint_names.push_back(name);
    for (const moveit::core::RobotState& state : states)
      for (const std::string& name : call.request.joint_names)
        call.request.positions.push_back(state.getVariablePosition(name));
    EXPECT_TRUE(callPersistently(node_->service("check_states"), call));
    return call.response;
  }

  /// Returns the number of colliding states. The node may refuse to answer for a moment: it can notice late that the
  /// publisher was restarted, after it has fetched the scene of the new one.
  int expectSameVerdicts()
  {
    const std::vector<moveit::core::RobotState> states = randomStates(kStates);
    CheckStates::Response answer = check(states);
    for (const auto end = Clock::now() + std::chrono::duration<double>(kLongest);
         !answer.success && Clock::now() < end;)
    {
      ros::WallDuration(0.05).sleep();
      answer = check(states);
    }
    EXPECT_TRUE(answer.success) << answer.message;
    const std::vector<bool> expected = group_.verdicts(states);
    int colliding = 0;
    for (std::size_t i = 0; i < states.size() && answer.success; ++i)
    {
      EXPECT_EQ(expected[i], answer.valid[i] != 0)
          << "state " << i << ": " << answer.body_1[i] << " - " << answer.body_2[i];
      colliding += expected[i] ? 0 : 1;
    }
    return colliding;
  }

  /// The message of the answer that the node gives instead of verdicts; waits for it.
  std::string refusal()
  {
    for (const auto end = Clock::now() + std::chrono::duration<double>(kLongest); Clock::now() < end;)
    {
      const CheckStates::Response answer = check(randomStates(1));
      if (!answer.success)
        return answer.message;
      ros::WallDuration(0.02).sleep();
    }
    return "";
  }

  /// The answer for the current state.
  CheckStates::Response checkCurrent() const
  {
    CheckStates call;
    EXPECT_TRUE(callPersistently(node_->service("check_states"), call));
    return call.response;
  }

  void change() { group_.change(std::ref(changes_)); }
  void changeObject(const std::string& id)
  {
    group_.change(
        [&](planning_scene::PlanningScene& scene)
        {
          moveit_msgs::CollisionObject box = moveItBox(id, 0.6, 0.05);
          scene.processCollisionObjectMsg(box);
        });
  }

  std::vector<std::string> warnings()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return warnings_;
  }
  int warningsWith(const std::string& text)
  {
    int count = 0;
    for (const std::string& warning : warnings())
      count += warning.find(text) != std::string::npos ? 1 : 0;
    return count;
  }
  bool waitForWarning(const std::string& text)
  {
    for (const auto end = Clock::now() + std::chrono::duration<double>(kLongest); Clock::now() < end;)
    {
      if (warningsWith(text) != 0)
        return true;
      ros::WallDuration(0.05).sleep();
    }
    return false;
  }

  static moveit::core::RobotModelPtr model;

 protected:
  MoveGroup group_{model, "/arm/move_group"};
  RandomChanges changes_{1};
  std::mt19937 random_;
  std::unique_ptr<ChildNode> node_;

 private:
  void take(const rosgraph_msgs::Log& message)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (message.level == rosgraph_msgs::Log::WARN && message.name == "/follower")
      warnings_.push_back(message.msg);
  }

  std::mutex mutex_;  // guards warnings_
  std::vector<std::string> warnings_;
  ros::Subscriber log_;
};
moveit::core::RobotModelPtr Following::model;

TEST_F(Following, TheScenesAreEqualAfterTenThousandDifferencesWithLossesAndRestarts)
{
  for (int i = 0; i < 20; ++i)
    change();
  group_.publish();
  startNode();
  ASSERT_EQ("", remainingDifference());
  std::uniform_int_distribution<int> percent(0, 99);
  std::vector<moveit_msgs::PlanningScene> old;
  int lost = 0, restarts = 0, late = 0, colliding = 0;
  for (int i = 1; i <= 10000; ++i)
  {
    change();
    const bool is_lost = percent(random_) < 2;
    lost += is_lost ? 1 : 0;
    group_.publish(is_lost);
    if (i % 97 == 0)
      old.push_back(group_.whole());
    if (!old.empty() && i % 211 == 0)
    {
      group_.publish(old[static_cast<std::size_t>(percent(random_)) % old.size()]);  // a whole scene of the past
      ++late;
    }
    if (i % 1250 == 0)
    {
      group_.stop();
      for (int k = 0; k < 5; ++k)
        change();
      group_.publish();
      group_.start();
      ++restarts;
    }
    if (i % 10 == 0)
      ros::WallDuration(0.002).sleep();
    if (i % 500 == 0)
    {
      ASSERT_EQ("", remainingDifference()) << "after " << i << " differences";
      colliding += expectSameVerdicts();
    }
  }
  EXPECT_GT(lost, 100);
  EXPECT_GT(late, 30);
  EXPECT_EQ(8, restarts);
  EXPECT_GT(colliding, kStates);
  EXPECT_LT(colliding, 20 * kStates);
}

TEST_F(Following, ALostDifferenceIsNoticedAndNamedOnce)
{
  startNode();
  ASSERT_EQ("", remainingDifference());
  ros::WallDuration(1.0).sleep();  // the publisher sends to the node now
  changeObject("seen");
  group_.publish();
  ASSERT_EQ("", remainingDifference());
  changeObject("missed");
  group_.publish(true);
  EXPECT_EQ("", remainingDifference());
  EXPECT_TRUE(waitForWarning("was missed"));
  ros::WallDuration(1.0).sleep();
  EXPECT_EQ(1, warningsWith("was missed"));
  EXPECT_EQ(1, warningsWith("object 'missed'"));
  EXPECT_EQ(0, warningsWith("object 'seen'"));
}

TEST_F(Following, ADifferenceThatComesSoonAfterAFetchIsNotCalledLost)
{
  startNode("1.5");
  ASSERT_EQ("", remainingDifference());
  ros::WallDuration(1.0).sleep();  // the publisher sends to the node now
  for (int i = 0; i < 8; ++i)
  {
    // MoveIt collects changes for up to half a second, so that the service often has them before the topic.
    changeObject("box" + std::to_string(i));
    ros::WallDuration(0.5).sleep();
    group_.publish();
  }
  ASSERT_EQ("", remainingDifference());
  ros::WallDuration(2.0).sleep();
  EXPECT_EQ(0, warningsWith("was missed"));
}

TEST_F(Following, ADifferenceThatCannotBeAppliedLeadsToTheWholeScene)
{
  startNode("60.0");
  changeObject("box");
  group_.publish();
  ASSERT_EQ("", remainingDifference());
  ros::WallDuration(0.7).sleep();  // the second fetch is over
  changeObject("other");
  group_.publish(true);
  moveit_msgs::PlanningScene broken;
  broken.is_diff = true;
  broken.robot_state.is_diff = true;
  broken.world.collision_objects.push_back(moveItBox("box", 0.6, -1.0));
  group_.publish(broken);
  EXPECT_EQ("", remainingDifference());
  EXPECT_TRUE(waitForWarning("cannot be applied"));
  EXPECT_EQ(1, warningsWith("object 'other'"));
}

TEST_F(Following, ARemovalThatTheFetchedSceneHasAlreadyIsNoFault)
{
  startNode("60.0");
  ASSERT_EQ("", remainingDifference());
  ros::WallDuration(1.0).sleep();  // the second fetch is over
  moveit_msgs::PlanningScene removal;
  removal.is_diff = true;
  removal.robot_state.is_diff = true;
  removal.world.collision_objects.push_back(moveItBox("gone", 0.6, 0.1));
  removal.world.collision_objects[0].operation = moveit_msgs::CollisionObject::REMOVE;
  moveit_msgs::AttachedCollisionObject detached;
  detached.link_name = "panda_hand";
  detached.object = removal.world.collision_objects[0];
  detached.object.id = "dropped";
  removal.robot_state.attached_collision_objects.push_back(detached);
  removal.world.collision_objects.push_back(moveItBox("new", 0.6, 0.1));
  group_.publish(removal);
  const auto has_new = [this]
  {
    const std::optional<moveit_msgs::PlanningScene> scene = nodeScene();
    return scene && !scene->world.collision_objects.empty();
  };
  for (const auto end = Clock::now() + std::chrono::duration<double>(kLongest); !has_new() && Clock::now() < end;)
    ros::WallDuration(0.05).sleep();
  EXPECT_TRUE(has_new()) << "the rest of the message counts";
  EXPECT_EQ(0, warningsWith("cannot be applied"));
}

TEST_F(Following, WithoutThePublisherRequestsAreRefused)
{
  startNode();
  changeObject("box");
  group_.publish();
  ASSERT_EQ("", remainingDifference());
  group_.stop();
  EXPECT_EQ(0U, refusal().rfind("the scene of /arm/move_group is not known: ", 0));
  EXPECT_FALSE(nodeScene());
  moveit_msgs::GetStateValidity validity;
  EXPECT_FALSE(callPersistently(node_->service("check_state_validity"), validity));
  PlanMotion plan;
  ASSERT_TRUE(callPersistently(node_->service("plan"), plan));
  EXPECT_NE(std::string::npos, plan.response.message.find("is not known"));
  EXPECT_EQ(AnswerStatus::UNAVAILABLE, plan.response.status);
  changeObject("another");
  group_.start();
  EXPECT_EQ("", remainingDifference());
  EXPECT_TRUE(waitForWarning("object 'another'"));
}

TEST_F(Following, WhileTheServiceHangsRequestsAreRefused)
{
  startNode();
  ASSERT_EQ("", remainingDifference());
  group_.hang(true);
  const std::string why = refusal();
  group_.hang(false);
  EXPECT_NE(std::string::npos, why.find("does not answer")) << why;
  EXPECT_EQ("", remainingDifference());
}

TEST_F(Following, DuringASlowFetchRequestsAreRefusedIfMessagesWait)
{
  startNode("0.3", "30.0");
  ASSERT_EQ("", remainingDifference());
  ros::WallDuration(1.0).sleep();  // the publisher sends to the node now
  group_.hang(true);
  ros::WallDuration(1.5).sleep();  // a fetch has begun more than half a second ago
  EXPECT_TRUE(checkCurrent().success) << "the scene has not changed";
  changeObject("new");
  group_.publish();
  const std::string why = refusal();
  group_.hang(false);
  EXPECT_NE(std::string::npos, why.find("it changes while it is being fetched")) << why;
  EXPECT_EQ("", remainingDifference());
  EXPECT_TRUE(checkCurrent().success);
}

TEST_F(Following, ARequestDuringWhichTheSceneIsLostIsRefused)
{
  startNode();
  ASSERT_EQ("", remainingDifference());
  PlanMotion plan;
  plan.request.group = "panda_arm";
  plan.request.planner = "geometric::RRTstar";  // uses all of its time
  plan.request.allowed_planning_time = 3.0;
  plan.request.named_start = "ready";
  plan.request.goal_names = {"panda_joint1"};
  plan.request.goals = {0.5};
  std::thread losing(
      [this]
      {
        ros::WallDuration(1.0).sleep();
        group_.stop();
      });
  EXPECT_TRUE(callPersistently(node_->service("plan"), plan));
  losing.join();
  EXPECT_FALSE(plan.response.success);
  EXPECT_EQ(0U, plan.response.message.rfind("the scene of /arm/move_group is not known: ", 0)) << plan.response.message;
  group_.start();
  EXPECT_EQ("", remainingDifference());
  EXPECT_TRUE(callPersistently(node_->service("plan"), plan));
  EXPECT_TRUE(plan.response.success) << plan.response.message;
}

TEST_F(Following, AnEmptyMatrixAllowsNothing)
{
  startNode();
  ASSERT_EQ("", remainingDifference());
  EXPECT_NE(0U, nodeScene()->allowed_collision_matrix.entry_names.size());
  group_.change([](planning_scene::PlanningScene& scene) { scene.getAllowedCollisionMatrixNonConst().clear(); });
  group_.publish();
  EXPECT_EQ("", remainingDifference());
  // Neighbouring links touch in all states.
  EXPECT_EQ(kStates, expectSameVerdicts());
}

TEST_F(Following, TheCurrentStateIsCheckedInItsOwnScene)
{
  // With each change, the arm turns away from the place to which the box goes.
  const auto turn = [this](double angle)
  {
    group_.change(
        [angle](planning_scene::PlanningScene& scene)
        {
          moveit::core::RobotState& state = scene.getCurrentStateNonConst();
          state.setToDefaultValues(model->getJointModelGroup("panda_arm"), "ready");
          state.setVariablePosition("panda_joint1", angle);
          state.update();
          const Eigen::Vector3d hand = state.getGlobalLinkTransform("panda_hand").translation();
          moveit_msgs::CollisionObject box = moveItBox("box", -hand.x(), 0.1);
          box.pose.position.y = -hand.y();
          box.pose.position.z = hand.z();
          scene.processCollisionObjectMsg(box);
        });
    group_.publish();
  };
  turn(1.5);
  startNode();
  ASSERT_EQ("", remainingDifference());
  ASSERT_TRUE(checkCurrent().success) << checkCurrent().message;
  std::atomic<bool> done{false};
  std::atomic<int> answered{0};
  std::set<std::uint64_t> revisions;
  std::thread client(
      [&]
      {
        for (; !done; ++answered)
        {
          const CheckStates::Response answer = checkCurrent();
          if (answer.success)
          {
            EXPECT_EQ(std::vector<std::uint8_t>{1}, answer.valid)
                << answer.body_1.at(0) << " - " << answer.body_2.at(0);
            revisions.insert(answer.scene_revision);
          }
        }
      });
  for (int i = 0; i < 1000; ++i)
  {
    turn(i % 2 == 0 ? -1.6416 : 1.5);
    ros::WallDuration(0.003).sleep();
  }
  done = true;
  client.join();
  EXPECT_GT(answered, 100);
  EXPECT_GT(revisions.size(), 50U);
  EXPECT_EQ("", remainingDifference());
}

TEST_F(Following, AWholeSceneThatCannotBeTakenOverIsRefusedUntilItCan)
{
  startNode();
  ASSERT_EQ("", remainingDifference());
  // MoveIt accepts an attached plane, which this package does not have.
  group_.change(
      [](planning_scene::PlanningScene& scene)
      {
        scene.getCurrentStateNonConst().attachBody(
            "plane", Eigen::Isometry3d::Identity(), {std::make_shared<shapes::Plane>(0.0, 0.0, 1.0, 0.0)},
            {Eigen::Isometry3d::Identity()}, std::set<std::string>(), "panda_hand");
      });
  group_.publish();
  const std::string why = refusal();
  EXPECT_NE(std::string::npos, why.find("plane")) << why;
  group_.change([](planning_scene::PlanningScene& scene)
                { scene.getCurrentStateNonConst().clearAttachedBody("plane"); });
  EXPECT_EQ("", remainingDifference());
  EXPECT_TRUE(check(randomStates(1)).success);
}

TEST_F(Following, AnAnswerThatIsNoWholeSceneIsRefused)
{
  startNode();
  ASSERT_EQ("", remainingDifference());
  group_.alterAnswers([](moveit_msgs::PlanningScene& scene) { scene.is_diff = true; });
  std::string why = refusal();
  EXPECT_NE(std::string::npos, why.find("is not a whole scene")) << why;
  group_.alterAnswers([](moveit_msgs::PlanningScene& scene) { scene = moveit_msgs::PlanningScene(); });
  for (const auto end = Clock::now() + std::chrono::duration<double>(kLongest);
       why.find("names no robot") == std::string::npos && Clock::now() < end;)
    why = refusal();
  EXPECT_NE(std::string::npos, why.find("names no robot")) << why;
  group_.alterAnswers({});
  EXPECT_EQ("", remainingDifference());
  EXPECT_TRUE(check(randomStates(1)).success);
}

TEST_F(Following, WhileTwoNodesPublishTheSceneRequestsAreRefused)
{
  startNode();
  ASSERT_EQ("", remainingDifference());
  {
    ChildNode other("other", {"_device:=cpu", "_moveit_names:=true",
                              "move_group/monitored_planning_scene:=/arm/move_group/monitored_planning_scene"});
    const std::string why = refusal();
    EXPECT_NE(std::string::npos, why.find("several nodes publish")) << why;
    other.askToShutDown();
    other.wait(kLongest);
  }
  EXPECT_EQ("", remainingDifference());
  EXPECT_TRUE(check(randomStates(1)).success);
}

TEST_F(Following, AJointAwayFromTheJointThatItFollowsIsReported)
{
  startNode();
  ASSERT_EQ("", remainingDifference());
  group_.change(
      [](planning_scene::PlanningScene& scene)
      {
        moveit::core::RobotState& state = scene.getCurrentStateNonConst();
        std::vector<double> values(state.getVariablePositions(),
                                   state.getVariablePositions() + state.getVariableCount());
        values[static_cast<std::size_t>(model->getVariableIndex("panda_finger_joint2"))] += 0.02;
        state.setVariablePositions(values);
      });
  group_.publish();
  EXPECT_TRUE(waitForWarning("'panda_finger_joint2' follows 'panda_finger_joint1'"));
  EXPECT_TRUE(check(randomStates(1)).success);
}

TEST_F(Following, ChangesThroughTheNodeAreRefused)
{
  startNode();
  ASSERT_EQ("", remainingDifference());
  ApplyPlanningScene apply;
  apply.request.scene = diffWith(boxObject("box", {0.5, 0.0, 0.5}, 0.1));
  ASSERT_TRUE(callPersistently(node_->service("apply_planning_scene"), apply));
  EXPECT_FALSE(apply.response.success);
  EXPECT_NE(std::string::npos, apply.response.message.find("follows the scene of /arm/move_group"));
  Clear clear;
  ASSERT_TRUE(callPersistently(node_->service("clear"), clear));
  EXPECT_FALSE(clear.response.success);
  EXPECT_EQ("", remainingDifference());
}

TEST_F(Following, TheTopicOfJointStatesStillSetsTheJoints)
{
  startNode();
  ASSERT_EQ("", remainingDifference());
  ros::Publisher joints = ros::NodeHandle().advertise<sensor_msgs::JointState>("joint_states", 1);
  std::atomic<bool> done{false};
  std::thread robot(
      [&]
      {
        sensor_msgs::JointState state;
        state.name = {"panda_joint1"};
        state.position = {1.25};
        for (; !done; ros::WallDuration(0.05).sleep())
          joints.publish(state);
      });
  const auto joint1 = [this]
  {
    const std::optional<moveit_msgs::PlanningScene> scene = nodeScene();
    const sensor_msgs::JointState& values = scene->robot_state.joint_state;
    return values.position.at(static_cast<std::size_t>(
        std::find(values.name.begin(), values.name.end(), "panda_joint1") - values.name.begin()));
  };
  const auto wait_for = [&joint1](double value)
  {
    for (const auto end = Clock::now() + std::chrono::duration<double>(kLongest);
         joint1() != value && Clock::now() < end;)
      ros::WallDuration(0.05).sleep();
    return joint1();
  };
  EXPECT_EQ(1.25, wait_for(1.25));
  // The move_group has other values. They do not replace those of the topic.
  group_.change([](planning_scene::PlanningScene& scene)
                { scene.getCurrentStateNonConst().setVariablePosition("panda_joint1", -1.0); });
  changeObject("box");
  group_.publish();
  EXPECT_EQ("", remainingDifference());
  ros::WallDuration(1.0).sleep();  // several fetches
  EXPECT_EQ(1.25, joint1());
  done = true;
  robot.join();
  EXPECT_EQ(-1.0, wait_for(-1.0)) << "the topic has ended";
}
}  // namespace
}  // namespace gpu_planning_scene::core
