// Nodes that follow a leader, and a client that checks with all of them.

#include <atomic>
#include <map>
#include <thread>

#include "gpu_planning_scene/client/sharded_checker.h"
#include "node/child_node.h"
#include "node/follow/relay.h"
#include "node/messages/exact_numbers.h"
#include "node/node_client.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr char kLeader[] = "/planning_scene";

/// A leader, and a node that follows it.
class Replicas : public RunningNode
{
 public:
  static void SetUpTestSuite()
  {
    leader = std::make_unique<ChildNode>("planning_scene", std::vector<std::string>{"_device:=cpu"});
    replica = follower("replica", kLeader);
    RunningNode::SetUpTestSuite();
  }
  static void TearDownTestSuite()
  {
    RunningNode::TearDownTestSuite();
    replica.reset();
    leader.reset();
  }

  static std::unique_ptr<ChildNode> follower(const std::string& name, const std::string& of,
                                             const std::string& period = "0.3")
  {
    return std::make_unique<ChildNode>(
        name, std::vector<std::string>{"_device:=cpu", "_follow:=" + of, "_follow_period:=" + period});
  }

  static CheckStates::Response checkWith(const ChildNode& node, const CheckStates::Request& request)
  {
    CheckStates call;
    call.request = request;
    EXPECT_TRUE(callPersistently(node.service("check_states"), call));
    return call.response;
  }

  static CheckStates::Request freeStateAt(std::uint64_t revision)
  {
    CheckStates::Request request = stateRequest(free_state);
    request.scene_revision = revision;
    return request;
  }

  /// The whole scene with the fields for followers.
  static PlanningSceneMessage wholeScene(const ChildNode& node)
  {
    GetPlanningScene call;
    call.request.components.components = 2 * kForFollowers - 1;
    EXPECT_TRUE(callPersistently(node.service("get_planning_scene"), call));
    EXPECT_EQ(AnswerStatus::OK, call.response.status) << call.response.message;
    return call.response.scene;
  }

  static bool reaches(const ChildNode& node, std::uint64_t revision)
  {
    return becomes([&] { return checkWith(node, freeStateAt(revision)).success != 0; });
  }

  static CollisionObject boxAtTip() { return boxObject("box", tipPoint(), 0.2); }

  static std::unique_ptr<ChildNode> leader;
  static std::unique_ptr<ChildNode> replica;
};
std::unique_ptr<ChildNode> Replicas::leader;
std::unique_ptr<ChildNode> Replicas::replica;

TEST_F(Replicas, HaveTheSceneAndTheRevisionOfTheLeader)
{
  PlanningSceneMessage change = diffWith(boxAtTip());
  CollisionObject turned = boxObject("turned", farAway(), 0.1);
  turned.pose.orientation.x = 0.3;
  turned.header.frame_id = tip;
  turned.primitive_poses[0].orientation.z = 0.7;
  change.world.collision_objects.push_back(turned);
  CollisionObject floor = objectOperation("floor", CollisionObject::ADD);
  floor.planes.resize(1);
  floor.planes[0].coef = {0.1, 0.2, 0.9, 5.0};
  change.world.collision_objects.push_back(floor);
  change.link_padding.resize(1);
  change.link_padding[0].link_name = tip;
  change.link_padding[0].padding = 0.01;
  apply(change);
  AttachedCollisionObject carried;
  carried.link_name = tip;
  carried.object = objectOperation("turned", CollisionObject::ADD);
  apply(diffWith(carried));
  PlanningSceneMessage state = diffScene();
  state.robot_state = stateMessage(free_state);
  state.robot_state.is_diff = true;
  state.robot_state.joint_state.position[0] += 0.01;
  const std::uint64_t revision = apply(state);
  ASSERT_TRUE(reaches(*replica, revision));
  EXPECT_EQ(revision, wholeScene(*replica).scene_revision);
  EXPECT_EQ(wholeScene(*leader), wholeScene(*replica));
  EXPECT_EQ(checkWith(*leader, {}).valid, checkWith(*replica, {}).valid) << "the current state";

  PlanningSceneMessage nameless;  // no difference leads to this scene
  nameless.robot_state = stateMessage(free_state);
  ASSERT_TRUE(reaches(*replica, apply(nameless)));
  EXPECT_EQ(wholeScene(*leader), wholeScene(*replica));
}

TEST_F(Replicas, SayThatASensorOfTheLeaderIsSilent)
{
  XmlRpc::XmlRpcValue sensors;
  sensors[0]["point_cloud_topic"] = "/silent/points";
  sensors[0]["max_range"] = 2.0;
  ros::param::set("/seeing/sensors", sensors);
  const ChildNode seeing("seeing", {"_device:=cpu"});
  const std::unique_ptr<ChildNode> listening = follower("listening", "/seeing");
  for (const ChildNode* node : std::initializer_list<const ChildNode*>{&seeing, listening.get()})
    EXPECT_TRUE(becomes(
        [&]
        {
          const std::string message = checkWith(*node, stateRequest(free_state)).message;
          return message.find("no measurement of sensor /silent/points was used yet") != std::string::npos;
        }));
  ros::param::del("/seeing/sensors");
}

TEST_F(Replicas, AnswerForTheRevisionThatARequestNames)
{
  const std::uint64_t before = apply(diffWith(boxObject("box", farAway(), 0.2)));
  const std::uint64_t hit = apply(diffWith(boxAtTip()));
  for (const ChildNode* node : {leader.get(), replica.get()})
  {
    for (const auto& [revision, is_free] : std::map<std::uint64_t, bool>{{before, true}, {hit, false}})
    {
      const CheckStates::Response response = checkWith(*node, freeStateAt(revision));
      ASSERT_TRUE(response.success) << response.message;
      EXPECT_EQ(revision, response.scene_revision);
      EXPECT_EQ(is_free, response.valid.at(0) != 0);
    }
    const CheckStates::Response missing = checkWith(*node, freeStateAt(1));
    EXPECT_FALSE(missing.success);
    EXPECT_EQ(AnswerStatus::UNKNOWN_REVISION, missing.status);
    EXPECT_EQ(hit, missing.scene_revision);
    EXPECT_EQ(0U, missing.message.find("revision 1 of the scene is not kept; the newest is ")) << missing.message;
  }
  CheckStates::Response response;
  std::thread waiting([&] { response = checkWith(*replica, freeStateAt(hit + 1)); });
  ros::WallDuration(0.1).sleep();
  EXPECT_EQ(hit + 1, apply(diffWith(objectOperation("box", CollisionObject::REMOVE))));
  waiting.join();
  EXPECT_EQ(hit + 1, response.scene_revision) << response.message;
}

TEST_F(Replicas, RefuseChangesAndNameTheLeader)
{
  ASSERT_TRUE(reaches(*replica, scene().scene_revision));
  const PlanningSceneMessage before = wholeScene(*replica);
  const std::string reason = "the node follows the scene of /planning_scene (~follow); change the scene there";
  ApplyPlanningScene change;
  change.request.scene = diffWith(boxAtTip());
  ASSERT_TRUE(callPersistently(replica->service("apply_planning_scene"), change));
  EXPECT_FALSE(change.response.success);
  EXPECT_EQ(AnswerStatus::INVALID_REQUEST, change.response.status);
  EXPECT_EQ(reason, change.response.message);
  Clear clear;
  ASSERT_TRUE(callPersistently(replica->service("clear"), clear));
  EXPECT_EQ(AnswerStatus::INVALID_REQUEST, clear.response.status);
  EXPECT_EQ(reason, clear.response.message);
  EXPECT_EQ(before, wholeScene(*replica));
}

TEST_F(Replicas, NoticeAMissedDifference)
{
  Relay relay("/relay", kLeader);
  const std::unique_ptr<ChildNode> node = follower("missing", "/relay");
  ASSERT_TRUE(reaches(*node, scene().scene_revision));
  ASSERT_TRUE(becomes([&] { return relay.hasSubscriber(); }));
  ASSERT_TRUE(reaches(*node, apply(diffWith(boxObject("first", farAway(), 0.1)))));
  EXPECT_EQ(1, relay.fetches()) << "a difference needs no fetch";

  relay.loseNext();
  apply(diffWith(boxObject("second", farAway(), 0.2)));
  ASSERT_TRUE(becomes([&] { return relay.hasLost(); }));
  ASSERT_TRUE(reaches(*node, apply(diffWith(boxObject("third", farAway(), 0.3)))));
  EXPECT_EQ(wholeScene(*leader), wholeScene(*node));
  EXPECT_EQ(2, relay.fetches());

  relay.loseNext();  // and no difference follows
  ASSERT_TRUE(reaches(*node, apply(diffWith(boxObject("fourth", farAway(), 0.4)))));
  EXPECT_EQ(wholeScene(*leader), wholeScene(*node));
  EXPECT_EQ(3, relay.fetches());
}

TEST_F(Replicas, HaveTheRevisionOfTheLeaderAfterEachKindOfChange)
{
  Relay relay("/exact_relay", kLeader);
  const std::unique_ptr<ChildNode> node = follower("exact", "/exact_relay", "1000");
  ASSERT_TRUE(reaches(*node, scene().scene_revision));
  // After the first comparison of the revisions, the next one comes in 1000 s. So none repairs a wrong revision.
  ASSERT_TRUE(becomes([&] { return relay.hasSubscriber() && relay.comparisons() == 1; }));
  const int fetches = relay.fetches();

  AttachedCollisionObject carried;
  carried.link_name = tip;
  carried.object = objectOperation("box", CollisionObject::ADD);
  PlanningSceneMessage padding = diffScene();
  padding.link_padding.resize(1);
  padding.link_padding[0].link_name = tip;
  padding.link_padding[0].padding = 0.01;
  PlanningSceneMessage state = diffScene();
  state.robot_state = stateMessage(free_state);
  state.robot_state.is_diff = true;
  state.robot_state.joint_state.position[0] += 0.01;
  PlanningSceneMessage named = diffScene();
  named.name = "named";
  PlanningSceneMessage nameless;  // no difference leads to this scene
  nameless.robot_state = stateMessage(free_state);
  for (const PlanningSceneMessage& change :
       {diffWith(boxObject("box", farAway(), 0.2)), diffWith(carried), padding, state, named, nameless,
        diffWith(boxObject("box", farAway(), 0.1)), diffWith(objectOperation("box", CollisionObject::REMOVE))})
  {
    const std::uint64_t revision = apply(change);
    ASSERT_TRUE(reaches(*node, revision));
    EXPECT_EQ(revision, wholeScene(*node).scene_revision);
    EXPECT_EQ(wholeScene(*leader), wholeScene(*node));
  }
  EXPECT_EQ(fetches, relay.fetches());
  EXPECT_EQ(1, relay.comparisons());
}

TEST_F(Replicas, RefuseRequestsWhileTheLeaderIsAwayAndTakeTheSceneOfItsNextRun)
{
  const std::unique_ptr<ChildNode> node = follower("waiting", "/other");
  const CheckStates::Response none = checkWith(*node, stateRequest(free_state));
  EXPECT_FALSE(none.success);
  EXPECT_EQ(AnswerStatus::UNAVAILABLE, none.status);
  EXPECT_EQ(0U, none.message.find("the scene of /other is not known: ")) << none.message;
  GetPlanningScene get;
  ASSERT_TRUE(callPersistently(node->service("get_planning_scene"), get));
  EXPECT_FALSE(get.response.success);
  EXPECT_EQ(AnswerStatus::UNAVAILABLE, get.response.status);
  EXPECT_TRUE(get.response.scene.is_diff) << "a full scene without objects must not come back to a node";
  EXPECT_EQ(std::string::npos, none.message.find('\n'));

  std::vector<std::uint64_t> revisions;
  for (const bool has_box : {true, false})
  {
    const ChildNode other("other", {"_device:=cpu"});
    if (has_box)
    {
      ApplyPlanningScene change;
      change.request.scene = diffWith(boxAtTip());
      ASSERT_TRUE(callPersistently(other.service("apply_planning_scene"), change));
      ASSERT_TRUE(change.response.success) << change.response.message;
    }
    revisions.push_back(wholeScene(other).scene_revision);
    ASSERT_TRUE(reaches(*node, revisions.back()));
    EXPECT_EQ(wholeScene(other), wholeScene(*node));
    EXPECT_EQ(has_box, checkWith(*node, stateRequest(free_state)).valid.at(0) == 0);
  }
  EXPECT_LT(revisions[0], revisions[1]) << "each run has revisions of its own";
  EXPECT_TRUE(becomes([&] { return checkWith(*node, stateRequest(free_state)).success == 0; })) << "the leader is gone";
}

TEST_F(Replicas, DoNotFollowANodeWithAnotherRobotOrOtherSettings)
{
  ros::NodeHandle().setParam("/other_padding", 0.01);
  const ChildNode other("other", {"_device:=cpu", "_follow:=/planning_scene",
                                  "robot_description_planning/default_object_padding:=/other_padding"});
  std::string message;
  EXPECT_TRUE(becomes(
      [&]
      {
        message = checkWith(other, stateRequest(free_state)).message;
        return message.find("another robot, or other default paddings") != std::string::npos;
      }))
      << message;
}

/// Changes the scene all the time: with an odd number of changes, a box is at the tip.
class Sharding : public Replicas
{
 public:
  void changeAllTheTime(std::atomic<bool>& done)
  {
    for (bool hits = true; !done; hits = !hits)
    {
      CollisionObject moved = hits ? boxAtTip() : boxObject("box", farAway(), 0.2);
      const std::uint64_t revision = apply(diffWith(moved));
      const std::lock_guard<std::mutex> lock(mutex_);
      is_free_[revision] = !hits;
    }
  }

  /// Whether all verdicts are those of the scene that the answer names.
  void expectOfOneScene(const CheckStates::Response& response, std::size_t count)
  {
    ASSERT_TRUE(response.success) << response.message;
    ASSERT_EQ(count, response.valid.size());
    std::set<int> verdicts(response.valid.begin(), response.valid.end());
    ASSERT_EQ(1U, verdicts.size()) << "an answer with verdicts of several scenes";
    const std::lock_guard<std::mutex> lock(mutex_);
    if (const auto known = is_free_.find(response.scene_revision); known != is_free_.end())
    {
      EXPECT_EQ(known->second, *verdicts.begin() != 0);
      ++judged;
    }
  }

  static CheckStates::Request manyStates(std::size_t count)
  {
    std::vector<double> states;
    for (std::size_t i = 0; i < count; ++i)
      states.insert(states.end(), free_state.begin(), free_state.end());
    return stateRequest(states);
  }

  int judged = 0;

 private:
  std::mutex mutex_;
  std::map<std::uint64_t, bool> is_free_;
};

TEST_F(Sharding, NoAnswerIsLostOrMixedWhileTheSceneChangesAndANodeIsKilled)
{
  constexpr std::size_t kStates = 20000;
  std::unique_ptr<ChildNode> victim = follower("victim", kLeader);
  ShardedCheckerOptions options;
  options.part_states = 2000;
  ShardedChecker checker({kLeader, "/replica", "/victim"}, options);
  std::atomic<bool> done{false};
  std::thread changes([&] { changeAllTheTime(done); });
  for (int i = 0; i < 40; ++i)
  {
    std::thread killer;
    if (i == 15)
      killer = std::thread(
          [&]
          {
            ros::WallDuration(0.01).sleep();
            victim.reset();
          });
    expectOfOneScene(checker.check(manyStates(kStates)), kStates);
    if (killer.joinable())
      killer.join();
  }
  done = true;
  changes.join();
  EXPECT_GT(judged, 20);
}

TEST_F(Sharding, TheAnswerIsThatOfOneNode)
{
  const std::uint64_t revision = apply(diffWith(boxAtTip()));
  ASSERT_TRUE(reaches(*replica, revision));
  ShardedCheckerOptions options;
  options.part_states = 1700;
  ShardedChecker checker({kLeader, "/replica"}, options);
  std::mt19937_64 generator(1);
  const std::size_t width = robot->variables().size();
  std::vector<double> states(10000 * width);
  for (std::size_t i = 0; i < states.size(); i += width)
    robot->randomState(generator, states.data() + i);
  CheckStates::Request request = stateRequest(states);
  request.max_contacts = 1;
  const CheckStates::Response expected = checkWith(*leader, request);
  const CheckStates::Response found = checker.check(request);
  ASSERT_TRUE(found.success) << found.message;
  EXPECT_EQ(revision, found.scene_revision);
  EXPECT_EQ(expected.valid, found.valid);
  ASSERT_EQ(expected.contacts.size(), found.contacts.size());
  for (std::size_t i = 0; i < expected.contacts.size(); ++i)
    ASSERT_EQ(expected.contacts[i].state, found.contacts[i].state);

  // The second joint has its value of the current state.
  CheckStates::Request partial = manyStates(5000);
  partial.joint_names.resize(1);
  partial.positions.resize(5000);
  EXPECT_EQ(checkWith(*leader, partial).valid, checker.check(partial).valid);

  request.joint_names[0] = "no such joint";
  const CheckStates::Response refused = checker.check(request);
  EXPECT_FALSE(refused.success);
  EXPECT_EQ(AnswerStatus::INVALID_REQUEST, refused.status);
  EXPECT_NE(std::string::npos, refused.message.find("no such joint")) << refused.message;
}

TEST_F(Sharding, WithoutAnAnswerTheStatusIsThatOfTheLastReason)
{
  ShardedCheckerOptions impatient;
  impatient.patience = 0.1;
  CheckStates::Request request = stateRequest(free_state);
  const auto expect_status = [&](const std::vector<std::string>& nodes, std::uint8_t status)
  {
    ShardedChecker checker(nodes, impatient);
    const CheckStates::Response response = checker.check(request);
    EXPECT_FALSE(response.success);
    EXPECT_EQ(status, response.status) << response.message;
  };
  expect_status({"/no_such_node"}, AnswerStatus::UNAVAILABLE);
  request.scene_revision = 1;
  expect_status({kLeader}, AnswerStatus::UNKNOWN_REVISION);
  impatient.patience = 1000.0;
  expect_status({kLeader, "/replica"}, AnswerStatus::UNKNOWN_REVISION);  // at once: it will not come back
}

TEST_F(Sharding, ANodeThatHangsIsGivenUpAfterTheTimeout)
{
  const std::unique_ptr<ChildNode> frozen = follower("frozen", kLeader);
  ASSERT_TRUE(reaches(*frozen, scene().scene_revision));
  ShardedCheckerOptions options;
  options.timeout = 2.0;
  options.patience = 60.0;  // on a busy machine, the leader too may need more than the timeout
  ShardedChecker connected({kLeader, "/frozen"}, options);
  for (int i = 0; i < 2; ++i)  // one request to each node
    ASSERT_TRUE(connected.check(stateRequest(free_state)).success);
  frozen->freeze();
  ShardedChecker unconnected({kLeader, "/frozen"}, options);
  for (ShardedChecker* checker : {&connected, &unconnected})
  {
    for (int i = 0; i < 2; ++i)
      EXPECT_TRUE(checker->check(stateRequest(free_state)).success);
    expectOfOneScene(checker->check(manyStates(20000)), 20000);
  }
  options.patience = 0.0;
  const CheckStates::Response none = ShardedChecker({"/frozen"}, options).check(stateRequest(free_state));
  EXPECT_EQ(AnswerStatus::UNAVAILABLE, none.status);
  EXPECT_NE(std::string::npos, none.message.find("/frozen: ")) << none.message;
  EXPECT_NE(std::string::npos, none.message.find("has not answered within 2 s")) << none.message;
}

TEST_F(Sharding, AnOlderRevisionCanBeNamed)
{
  const std::uint64_t before = apply(diffWith(boxObject("box", farAway(), 0.2)));
  const std::uint64_t hit = apply(diffWith(boxAtTip()));
  ShardedChecker checker({kLeader, "/replica"});
  for (const std::uint64_t revision : {before, hit})
  {
    CheckStates::Request request = manyStates(10000);
    request.scene_revision = revision;
    const CheckStates::Response response = checker.check(request);
    EXPECT_EQ(revision, response.scene_revision) << response.message;
    EXPECT_EQ(std::vector<std::uint8_t>(10000, revision == before ? 1 : 0), response.valid);
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
