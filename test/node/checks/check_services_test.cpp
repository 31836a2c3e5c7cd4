// The answers of check_states, check_motions and get_report. No ROS master is needed.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include "collision/report/scene_text.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "model/model_testing.h"
#include "node/checks/answering_scene.h"
#include "node/checks/check_services.h"
#include "node/messages/requested_states.h"
#include "scene/slider_robot.h"
#include "service/gated_checker.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kInfinity = std::numeric_limits<double>::infinity();

CheckStates::Request request(const std::vector<std::string>& names, const std::vector<double>& positions)
{
  CheckStates::Request result;
  result.joint_names = names;
  result.positions = positions;
  return result;
}

class Service : public testing::Test
{
 public:
  CheckStates::Response answer(const CheckStates::Request& asked) { return services.checkStates(asked); }

  void expectRefusal(const CheckStates::Request& asked, const std::string& reason,
                     std::uint8_t status = AnswerStatus::INVALID_REQUEST)
  {
    const CheckStates::Response response = answer(asked);
    EXPECT_FALSE(response.success);
    EXPECT_EQ(status, response.status);
    EXPECT_NE(std::string::npos, response.message.find(reason)) << response.message;
    EXPECT_EQ(std::string::npos, response.message.find('\n')) << response.message;
    EXPECT_TRUE(response.valid.empty());
  }

  SceneStore store{sliderAndWall(5), {}, {}};
  CheckServer server{store,
                     [](std::shared_ptr<const PlanningScene> scene)
                     { return std::make_shared<CpuChecker>(std::move(scene)); },
                     {}};
  MemoryGuard memory{0};
  CheckServices services{store, server, memory, {1000, 1000000, 10}, {}};
};

TEST_F(Service, AnswersEachStateInOrder)
{
  const CheckStates::Response response = answer(request({"turn", "slide"}, {0.5, 0.0, 0.5, 1.0, 1.0, 0.5}));
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_EQ(AnswerStatus::OK, response.status);
  EXPECT_EQ("", response.message);
  EXPECT_EQ((std::vector<std::uint8_t>{1, 0, 1}), response.valid);
  ASSERT_EQ(3u, response.body_1.size());
  ASSERT_EQ(3u, response.body_2.size());
  EXPECT_EQ("", response.body_1[0] + response.body_2[0]);
  EXPECT_EQ("cartwall",
            std::min(response.body_1[1], response.body_2[1]) + std::max(response.body_1[1], response.body_2[1]));
  EXPECT_EQ(5u, response.scene_revision);
}

TEST_F(Service, ARequestCanNameARevision)
{
  CheckStates::Request asked = request({"turn", "slide"}, {0.5, 1.0});
  EXPECT_EQ(6u, store.clear().revision);
  for (const std::uint64_t revision : {5, 6})
  {
    asked.scene_revision = revision;
    const CheckStates::Response response = answer(asked);
    EXPECT_EQ(revision, response.scene_revision) << response.message;
    EXPECT_EQ(std::vector<std::uint8_t>{revision == 5 ? std::uint8_t{0} : std::uint8_t{1}}, response.valid);
  }
  asked.scene_revision = 4;
  expectRefusal(asked, "revision 4 of the scene is not kept; the newest is 6", AnswerStatus::UNKNOWN_REVISION);
  EXPECT_EQ(6u, answer(asked).scene_revision) << "above the requested one: the node will not have that one again";
  asked.scene_revision = 7;
  expectRefusal(asked, "revision 7 of the scene has not arrived; the newest is 6", AnswerStatus::UNKNOWN_REVISION);
  EXPECT_EQ(6u, answer(asked).scene_revision) << "below the requested one, which may still arrive";
  asked.scene_revision = 0;
  EXPECT_EQ(6u, answer(asked).scene_revision);
}

/// A service whose requests wait up to a minute for their revision, at most one at a time.
class WaitingForARevision : public Service
{
 public:
  std::future<CheckStates::Response> ask(std::uint64_t revision)
  {
    CheckStates::Request asked = request({"turn", "slide"}, {0.5, 0.0});
    asked.scene_revision = revision;
    return std::async(std::launch::async, [this, asked] { return patient.checkStates(asked); });
  }

  static CheckServicesOptions few()
  {
    CheckServicesOptions options;
    options.revision_wait = std::chrono::minutes(1);
    options.max_revision_waits = 1;
    return options;
  }

  CheckServices patient{store, server, memory, few(), {}};
};

TEST_F(WaitingForARevision, EndsWithTheNode)
{
  std::future<CheckStates::Response> waiting = ask(9);
  EXPECT_EQ(std::future_status::timeout, waiting.wait_for(std::chrono::milliseconds(200)));
  patient.stop();
  ASSERT_EQ(std::future_status::ready, waiting.wait_for(std::chrono::seconds(20)));
  EXPECT_EQ(AnswerStatus::SHUTTING_DOWN, waiting.get().status);
  EXPECT_EQ(AnswerStatus::SHUTTING_DOWN, ask(9).get().status);
}

TEST_F(WaitingForARevision, IsForFewRequestsAtATime)
{
  std::future<CheckStates::Response> first = ask(6);
  std::future<CheckStates::Response> second = ask(6);
  const auto is_ready = [](const auto& answer)
  { return answer.wait_for(std::chrono::seconds(0)) == std::future_status::ready; };
  while (!is_ready(first) && !is_ready(second))
    std::this_thread::yield();
  store.clear();
  std::vector<std::uint8_t> statuses = {first.get().status, second.get().status};
  std::sort(statuses.begin(), statuses.end());
  EXPECT_EQ((std::vector<std::uint8_t>{AnswerStatus::OK, AnswerStatus::BUSY}), statuses);
}

TEST_F(Service, OtherVariablesTakeTheCurrentState)
{
  expectRefusal(
      request({"turn"}, {0.0}),
      "no value for slide; give values for all joints (a named state takes no further values), or set the "
      "current state: "
      "with robot_state.joint_state in the scene file, or, for a node, with the topic joint_states or "
      "~apply_planning_scene; list joints that nobody measures, such as casters, as <passive_joint> in the SRDF",
      AnswerStatus::UNAVAILABLE);
  store.updateState({{"slide", 1.0}});
  EXPECT_EQ((std::vector<std::uint8_t>{0}), answer(request({"turn"}, {0.5})).valid);
}

TEST(MotionsOfADifferentialDrive, AreRefusedIfTheyGoSideways)
{
  const auto robot = RobotModel::fromXml(
      "<robot name='r'>" + boxLink("body") + "</robot>",
      "<robot name='r'><virtual_joint name='drive' type='planar' parent_frame='world' child_link='body'/>"
      "<joint_property joint_name='drive' property_name='motion_model' value='diff_drive'/></robot>",
      {});
  AnsweringScene answering{PlanningScene(robot)};
  CheckServices& services = answering.services;
  CheckMotions::Request motions;
  motions.joint_names = {"drive/x", "drive/y", "drive/theta"};
  motions.starts = {0.0, 0.0, 0.0};
  motions.ends = {0.5, 0.0, 0.0};
  motions.resolution = motions.translation_resolution = 0.05;
  CheckMotions::Response response = services.checkMotions(motions);
  EXPECT_TRUE(response.success) << response.message;
  motions.ends = {0.5, 0.1, 0.0};
  response = services.checkMotions(motions);
  EXPECT_FALSE(response.success);
  EXPECT_EQ(0u, response.message.find("motion 0: joint 'drive' moves 0.1 m sideways")) << response.message;

  CheckTrajectory::Request trajectory;
  trajectory.resolution = trajectory.translation_resolution = 0.05;
  trajectory.joint_trajectory.joint_names = motions.joint_names;
  trajectory.joint_trajectory.points.resize(2);
  trajectory.joint_trajectory.points[0].positions = motions.starts;
  trajectory.joint_trajectory.points[1].positions = motions.ends;
  const CheckTrajectory::Response followed = services.checkTrajectory(trajectory);
  EXPECT_TRUE(followed.success && followed.valid) << followed.message;
  EXPECT_NE(std::string::npos, followed.message.find("part 1: joint 'drive' moves 0.1 m sideways")) << followed.message;
}

TEST(MotionsUnderPathConstraints, AreValidOnlyIfTheyAreProvenToFulfilThem)
{
  const auto robot = RobotModel::fromXml(
      "<robot name='r'>" + boxLink("base") + "<link name='pole'/><joint name='turn' type='revolute'>" +
          "<parent link='base'/><child link='pole'/><axis xyz='0 0 1'/><limit lower='-3' upper='3' effort='1' "
          "velocity='1'/></joint></robot>",
      "<robot name='r'><group name='mast'><joint name='turn'/></group></robot>", {});
  const OtherFrames tf{[](const StampedFrame&) { return Eigen::Isometry3d::Identity(); },
                       [](const std::string& frame) {
                         return frame == "camera" ? std::vector<std::string>{"bracket", "pole", "base"}
                                                  : std::vector<std::string>{"base"};
                       }};
  AnsweringScene answering(PlanningScene(robot), 1000000, tf);
  CheckServices& services = answering.services;
  CheckMotions::Request motions;
  motions.group = "mast";
  motions.joint_names = {"turn"};
  motions.starts = {0.0, -0.5, 0.0};
  motions.ends = {0.05, 0.5, 0.3};
  motions.resolution = motions.translation_resolution = 0.05;
  CheckMotions::Response response = services.checkMotions(motions);
  EXPECT_EQ((std::vector<std::uint8_t>{1, 1, 1}), response.valid) << response.message;
  EXPECT_TRUE(response.fulfils_constraints.empty());
  auto& orientation = motions.path_constraints.orientation_constraints.emplace_back();
  orientation.link_name = "pole";
  orientation.orientation.w = 1.0;
  orientation.absolute_x_axis_tolerance = orientation.absolute_y_axis_tolerance =
      orientation.absolute_z_axis_tolerance = 0.1;
  response = services.checkMotions(motions);
  EXPECT_EQ((std::vector<std::uint8_t>{1, 0, 0}), response.valid) << response.message;
  EXPECT_EQ((std::vector<std::uint8_t>{1, 0, 0}), response.fulfils_constraints);
  orientation.header.frame_id = "pole";
  response = services.checkMotions(motions);
  EXPECT_FALSE(response.success);
  EXPECT_EQ(0u, response.message.find("path_constraints: the frame 'pole' moves with the group 'mast'"))
      << response.message;
  orientation.header.frame_id = "camera";
  EXPECT_EQ(
      "path_constraints: the frame 'camera' moves with the group 'mast', because it hangs on the link 'pole'; give the "
      "constraints in a frame that stands still during the motion",
      services.checkMotions(motions).message);
  orientation.header.frame_id = "board";
  response = services.checkMotions(motions);
  EXPECT_EQ((std::vector<std::uint8_t>{1, 0, 0}), response.fulfils_constraints) << response.message;
  orientation.header.frame_id = "";
  motions.group = "";
  EXPECT_EQ("path_constraints need the group that moves; give `group`", services.checkMotions(motions).message);
}

TEST(MotionsBesideAFloor, ThatAreNotProvenSaySo)
{
  RobotModelOptions options;
  options.joint_limits = {{"drive/x", -100.0, 100.0}};
  const auto robot = RobotModel::fromXml(
      "<robot name='r'>" + boxLink("body") + "</robot>",
      "<robot name='r'><virtual_joint name='drive' type='planar' parent_frame='world' child_link='body'/></robot>",
      options);
  PlanningScene scene(robot);
  WorldObject floor;
  floor.id = "floor";
  floor.shapes = {{HalfSpace{Eigen::Vector3d::UnitZ(), -0.50001}}};
  scene.objects = {floor};
  AnsweringScene answering(std::move(scene));
  CheckServices& services = answering.services;
  CheckMotions::Request motions;
  motions.joint_names = {"drive/x", "drive/y", "drive/theta"};
  motions.starts = {0.0, 0.0, 0.0};
  motions.ends = {20.0, 0.0, 0.0};
  motions.resolution = motions.translation_resolution = 0.05;
  CheckMotions::Response response = services.checkMotions(motions);
  ASSERT_TRUE(response.success) << response.message;
  ASSERT_EQ(std::vector<std::uint8_t>{0}, response.valid) << "a centimetre of the way is proven by each check";
  EXPECT_EQ(0u, response.message.find("1 of 1 motions are neither proven free nor found in collision; the first is "
                                      "motion 0. Two bodies pass each other too closely for its length"))
      << response.message;
  motions.ends = {0.5, 0.0, 90.0};
  motions.motion_rule = "samples";
  EXPECT_EQ("motion 0: joint 'drive/theta' is 90 rad, more than one turn; 90 degrees are 1.5708 rad",
            services.checkMotions(motions).message);
}

/// A request is queued while a change sets the scene and the robot's state together.
class WaitingService : public Service
{
 public:
  template <class Ask>
  auto answerAfterTheCartMovedTo(double slide, Ask ask)
  {
    store.updateState({{"slide", 0.5}, {"turn", 0.0}});
    gate.close();
    auto first = std::async(std::launch::async,
                            [this] {
                              return gated.checkStates(request({"slide", "turn"}, {0, 0}));
                            });
    gate.waitForChecks(1);
    auto waiting = std::async(std::launch::async, ask);
    while (gated_server.statistics().waiting_requests == 0)
      std::this_thread::yield();
    SceneChange change;
    change.is_diff = true;
    change.state.variables = {{"slide", slide}};
    store.apply(change, nullptr);
    gate.open();
    first.get();
    return waiting.get();
  }

  Gate gate;
  CheckServer gated_server{store,
                           [this](std::shared_ptr<const PlanningScene> scene)
                           { return std::make_shared<GatedChecker>(std::move(scene), gate); },
                           {}};
  CheckServices gated{store, gated_server, memory, {1000, 1000000, 10}, {}};
};

TEST_F(WaitingService, VariablesThatARequestLeavesOutAreThoseOfTheRevisionThatItNames)
{
  const CheckStates::Response response =
      answerAfterTheCartMovedTo(-0.5, [this] { return gated.checkStates(request({"turn"}, {0.5})); });
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(6u, response.scene_revision);
  EXPECT_EQ((std::vector<std::uint8_t>{0}), response.valid) << "the gate lets no cart left of 0 through";
}

TEST_F(WaitingService, VariablesThatAMotionLeavesOutAreThoseOfTheRevisionThatItNames)
{
  CheckMotions::Request asked;
  asked.joint_names = {"turn"};
  asked.starts = {0.0};
  asked.ends = {0.5};
  asked.resolution = 0.1;
  asked.translation_resolution = 0.1;
  asked.motion_rule = "samples";
  const CheckMotions::Response response = answerAfterTheCartMovedTo(-0.5, [&] { return gated.checkMotions(asked); });
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(6u, response.scene_revision);
  EXPECT_EQ(6u, response.states_checked);
  EXPECT_EQ((std::vector<std::uint8_t>{0}), response.valid);
}

/// Requests for contacts. Two may be answered at a time and one may be queued. Their checks wait at a closed gate.
class WaitingInspections : public WaitingService
{
 public:
  WaitingInspections() { gate.close(); }

  void ask()
  {
    CheckStates::Request asked = request({"turn", "slide"}, {0.0, 0.5});
    asked.max_contacts = 1;
    answers.push_back(std::async(std::launch::async, [this, asked] { return bounded.checkStates(asked); }));
  }

  CheckServices bounded{store, gated_server, memory, {1000, 1000000, 10, 10, 1}, {}};
  std::vector<std::future<CheckStates::Response>> answers;
};

TEST_F(WaitingInspections, AreRejectedWhenTheQueueIsFull)
{
  for (int i = 0; i < 4; ++i)
    ask();
  const auto answered = [](const std::future<CheckStates::Response>& answer)
  { return answer.wait_for(std::chrono::seconds(0)) == std::future_status::ready; };
  while (std::none_of(answers.begin(), answers.end(), answered))
    std::this_thread::yield();
  EXPECT_LE(gate.batches().size() + gated_server.statistics().waiting_requests, 2u);
  gate.open();
  int busy = 0;
  for (auto& answer : answers)
  {
    const CheckStates::Response response = answer.get();
    busy += response.status == AnswerStatus::BUSY ? 1 : 0;
    EXPECT_TRUE(response.success || response.status == AnswerStatus::BUSY) << response.message;
  }
  EXPECT_EQ(1, busy);
}

TEST_F(WaitingInspections, StopRejectsThemWhileACheckerHangs)
{
  for (int i = 0; i < 3; ++i)
    ask();
  gate.waitForChecks(1);
  bounded.stop();
  for (auto& answer : answers)
  {
    const CheckStates::Response response = answer.get();
    EXPECT_FALSE(response.success);
    EXPECT_EQ(AnswerStatus::SHUTTING_DOWN, response.status);
    EXPECT_EQ("shutting down: the request was not answered", response.message);
  }
  gate.open();
}

TEST_F(Service, TooManyStatesAreRefusedBeforeAnythingIsMadeOfThem)
{
  CheckServerOptions options;
  options.max_states = 2;
  CheckServer small(
      store, [](auto scene) { return std::make_shared<CpuChecker>(std::move(scene)); }, options);
  CheckServices bounded(store, small, memory, {}, {});
  EXPECT_NE(std::string::npos,
            bounded.checkStates(request({"turn"}, {0.0, 0.0, std::nan("")})).message.find("limits/request_states"));
  CheckMotions::Request motions;
  motions.joint_names = {"turn"};
  motions.starts = {0.0, 0.0, std::nan("")};
  motions.ends = motions.starts;
  EXPECT_NE(std::string::npos, bounded.checkMotions(motions).message.find("limits/request_states"));
}

TEST(RequestedStates, AMotionNeedsAllOfARotationOrNothing)
{
  const auto robot = RobotModel::fromXml(R"(<robot name="boat">
      <link name="sea"/><link name="hull"/><link name="mast"/>
      <joint name="swim" type="floating"><parent link="sea"/><child link="hull"/></joint>
      <joint name="turn" type="continuous"><parent link="hull"/><child link="mast"/><axis xyz="0 0 1"/></joint>
      </robot>)",
                                         "", {});
  ASSERT_EQ(8u, robot->variables().size());
  const int first = robot->joints()[static_cast<std::size_t>(robot->jointIndex("swim"))].first_variable;
  const int turn = robot->joints()[static_cast<std::size_t>(robot->jointIndex("turn"))].first_variable;
  EXPECT_NO_THROW(requireWholeRotations(*robot, {turn, first, first + 1}));
  EXPECT_NO_THROW(requireWholeRotations(*robot, {first + 6, first + 5, first + 4, first + 3}));
  EXPECT_NE(std::string::npos, errorOf([&] { requireWholeRotations(*robot, {turn, first + 4}); }).find("'swim'"));
}

TEST_F(Service, NamesWithoutValuesAreRefused)
{
  store.updateState({{"slide", 0.0}, {"turn", 0.5}});
  expectRefusal(request({"turn", "slide"}, {}),
                "positions is empty, but joint_names names turn, slide; give rows of 2 values, one per name, or leave "
                "out both for the current state");
  CheckMotions::Request motions;
  motions.joint_names = {"turn"};
  motions.resolution = motions.translation_resolution = 0.1;
  const auto refusal = [&]
  {
    const CheckMotions::Response response = services.checkMotions(motions);
    EXPECT_FALSE(response.success);
    EXPECT_EQ(AnswerStatus::INVALID_REQUEST, response.status);
    return response.message;
  };
  EXPECT_EQ("starts is empty, but joint_names names turn; give rows of 1 value", refusal());
  motions.named_start = "left";
  EXPECT_EQ("ends is empty, but joint_names names turn; give rows of 1 value", refusal());
  std::swap(motions.named_start, motions.named_end);
  EXPECT_EQ("starts is empty, but joint_names names turn; give rows of 1 value", refusal());
  motions.named_end.clear();
  motions.starts = {0.0};
  EXPECT_EQ("1 values in starts and 0 in ends; give one row of each per motion", refusal());
}

TEST_F(Service, ARequestWithoutStatesChecksTheCurrentState)
{
  expectRefusal(request({}, {}), "no value for slide", AnswerStatus::UNAVAILABLE);
  store.updateState({{"slide", 0.0}, {"turn", 0.5}});
  EXPECT_EQ(std::vector<std::uint8_t>{1}, answer(request({}, {})).valid);
  store.updateState({{"slide", 1.0}});
  const CheckStates::Response colliding = answer(request({}, {}));
  EXPECT_TRUE(colliding.success) << colliding.message;
  EXPECT_EQ(std::vector<std::uint8_t>{0}, colliding.valid);
}

TEST_F(Service, WrongRequestsAreRefusedWithTheReason)
{
  expectRefusal(request({}, {1.0}), "joint_names is empty");
  expectRefusal(request({"turn", "slide"}, {0.0, 0.0, 0.0}), "3 positions are not rows of 2");
  expectRefusal(request({"turn", "slid"}, {0.0, 0.0}), "no variable 'slid'");
  expectRefusal(request({"turn", "flag"}, {0.0, 0.0}),
                "joint 'flag' mimics joint 'turn', from which its value follows; leave it out; the robot's variables "
                "are slide, turn");
  expectRefusal(request({"turn", "turn"}, {0.0, 0.0}), "'turn' is given twice");
  expectRefusal(request({"turn", "slide"}, {0.0, 0.0, std::nan(""), 0.0}), "state 1: the position of 'turn'");
  expectRefusal(request({"turn", "slide"}, {0.0, kInfinity}), "state 0: the position of 'slide'");
  CheckStates::Request unknown_group = request({"turn", "slide"}, {0.0, 0.0});
  unknown_group.group = "sails";
  expectRefusal(unknown_group, "sails");
  CheckStates::Request of_other_group = request({"slide"}, {0.0});
  of_other_group.group = "mast";
  expectRefusal(of_other_group, "the state sets no variable of the group 'mast'; for example, 'slide' is not in it");
}

TEST_F(Service, NamesInAnswersAreShortAndOnOneLine)
{
  expectRefusal(request({"turn", "sli\nde"}, {}), "no variable 'sli de'");
  CheckStates::Request unknown_group = request({"turn", "slide"}, {0.0, 0.0});
  unknown_group.group = "sa\nils";
  expectRefusal(unknown_group, "sa ils");
  EXPECT_GT(3000u, answer(request({std::string(100000, 'x')}, {})).message.size());
}

TEST_F(Service, AMatrixOfARequestHasNoMoreEntriesThanTheLimit)
{
  SceneLimits limits;
  limits.matrix_entries = 3;
  SceneStore strict(sliderAndWall(), {}, limits);
  CheckStates::Request asked = request({"turn", "slide"}, {0.0, 0.0});
  asked.allowed_collision_matrix.entry_names = {"cart", "wall"};
  asked.allowed_collision_matrix.entry_values.resize(2);
  for (AllowedCollisionEntry& row : asked.allowed_collision_matrix.entry_values)
    row.enabled = {0, 0};
  EXPECT_TRUE(answer(asked).success);
  const std::string message = CheckServices(strict, server, memory, {1000, 1000000, 10}, {}).checkStates(asked).message;
  EXPECT_NE(std::string::npos, message.find("limits/matrix_entries")) << message;
}

TEST_F(Service, ContactsAreGivenOfCollidingStatesAlone)
{
  CheckStates::Request with_contacts = request({"turn", "slide"}, {0.0, 0.0, 0.0, 1.0});
  with_contacts.max_contacts = 10;
  const CheckStates::Response response = answer(with_contacts);
  EXPECT_EQ((std::vector<std::uint8_t>{1, 0}), response.valid);
  ASSERT_FALSE(response.contacts.empty());
  for (const ContactInformation& contact : response.contacts)
  {
    EXPECT_EQ(1u, contact.state);
    EXPECT_EQ("cart", contact.contact_body_1);
    EXPECT_EQ("wall", contact.contact_body_2);
    EXPECT_EQ(ContactInformation::WORLD_OBJECT, contact.body_type_2);
    EXPECT_EQ("rail", contact.header.frame_id);
  }
}

TEST_F(Service, ClearanceIsGivenWhereAsked)
{
  CheckStates::Request asked = request({"turn", "slide"}, {0.0, 0.5, 0.0, 1.0});
  EXPECT_TRUE(answer(asked).clearance_world.empty());
  asked.clearance = true;
  const CheckStates::Response response = answer(asked);
  ASSERT_EQ(2u, response.clearance_world.size());
  EXPECT_NEAR(0.3, response.clearance_world[0], 2e-6) << "the cart reaches to 0.6 m, the wall begins at 0.9 m";
  EXPECT_EQ(0.0, response.clearance_world[1]);
  EXPECT_EQ(2u, response.clearance_self.size());
}

TEST_F(Service, TheNearestPairHasASignedDistanceAndPoints)
{
  CheckStates::Request asked = request({"turn", "slide"}, {0.0, 0.5, 0.0, 0.9});
  asked.nearest = 1;
  const CheckStates::Response response = answer(asked);
  ASSERT_EQ(2u, response.nearest_world.size()) << response.message;
  EXPECT_TRUE(response.clearance_world.empty());
  const NearestPairMessage& apart = response.nearest_world[0];
  EXPECT_EQ("cart", apart.body_1);
  EXPECT_EQ("wall", apart.body_2);
  EXPECT_EQ(ContactInformation::WORLD_OBJECT, apart.body_type_2);
  EXPECT_NEAR(0.3, apart.distance, 2e-6) << "the cart reaches to 0.6 m, the wall begins at 0.9 m";
  EXPECT_NEAR(0.6, apart.point_1.x, 1e-6);
  EXPECT_NEAR(0.9, apart.point_2.x, 1e-6);
  const NearestPairMessage& deep = response.nearest_world[1];
  EXPECT_NEAR(-0.1, deep.distance, 1e-6) << "the cart reaches to 1.0 m";
  EXPECT_EQ("wall", deep.body_2);
  EXPECT_EQ(deep.point_1, deep.point_2);
  ASSERT_EQ(2u, response.nearest_self.size());
  const NearestPairMessage& self = response.nearest_self[0];
  EXPECT_EQ(self.body_1.empty(), std::isinf(self.distance));
}

TEST_F(Service, DistancesHavePointsNormalsAndGradientsOfTheRequestsVariables)
{
  CheckStates::Request asked = request({"slide", "turn"}, {0.5, 0.0, 0.9, 0.0});
  asked.distances = CheckStates::Request::ALL_PAIRS;
  asked.distance_range = 0.35;
  const CheckStates::Response response = answer(asked);
  const std::vector<std::string> names = {"slide", "turn"};
  EXPECT_EQ(names, response.gradient_names);
  const auto of_state = [&](std::uint32_t state)
  {
    return *std::find_if(response.distances.begin(), response.distances.end(),
                         [&](const BodyDistanceMessage& each) { return each.state == state && each.body_2 == "wall"; });
  };
  const BodyDistanceMessage apart = of_state(0);
  EXPECT_EQ("cart", apart.body_1);
  EXPECT_EQ(ContactInformation::WORLD_OBJECT, apart.body_type_2);
  EXPECT_NEAR(0.3, apart.distance, 2e-6) << "the cart reaches to 0.6 m, the wall begins at 0.9 m";
  EXPECT_FALSE(apart.collides);
  EXPECT_NEAR(0.9, apart.point_2.x, 1e-6);
  EXPECT_NEAR(1.0, apart.normal.x, 1e-9);
  ASSERT_EQ(2u, apart.gradient.size());
  EXPECT_NEAR(-1.0, apart.gradient[0], 1e-9) << "the slide moves the cart to the wall";
  const BodyDistanceMessage deep = of_state(1);
  EXPECT_NEAR(-0.1, deep.distance, 1e-6) << "the cart reaches to 1.0 m";
  EXPECT_TRUE(deep.collides);
  EXPECT_NEAR(0.1, deep.depth_at_least, 1e-6) << "two boxes: the depth is exact";
  EXPECT_NEAR(-1.0, deep.gradient[0], 1e-6);
  asked.distance_range = 0.25;
  EXPECT_EQ(1u, answer(asked).distances.front().state) << "the first state is farther from all bodies";
}

TEST_F(Service, DistancesOfEachBodyAreThoseOfItsNearestPair)
{
  CheckStates::Request asked = request({"turn", "slide"}, {0.0, 0.5});
  asked.distances = CheckStates::Request::NEAREST_OF_EACH_BODY;
  const CheckStates::Response response = answer(asked);
  ASSERT_FALSE(response.distances.empty());
  EXPECT_EQ(1, std::count_if(response.distances.begin(), response.distances.end(),
                             [](const BodyDistanceMessage& each) { return each.body_1 == "cart"; }));
}

TEST_F(Service, AWrongRequestForDistancesIsRefused)
{
  CheckStates::Request asked = request({"turn", "slide"}, {0.0, 0.5});
  asked.distances = 3;
  expectRefusal(asked, "NEAREST_OF_EACH_BODY");
  asked.distances = CheckStates::Request::NO_DISTANCES;
  asked.distance_range = 0.1;
  expectRefusal(asked, "NO_DISTANCES");
  asked.distances = CheckStates::Request::ALL_PAIRS;
  for (const double range : {-1.0, std::nan("")})
  {
    asked.distance_range = range;
    expectRefusal(asked, "distance_range");
  }
  CheckServices bounded(store, server, memory, {1000, 1000000, 10, 2}, {});
  asked = request({"turn", "slide"}, {0.0, 0.5, 0.0, 0.5, 0.0, 0.5});
  asked.distances = CheckStates::Request::ALL_PAIRS;
  const CheckStates::Response refused = bounded.checkStates(asked);
  EXPECT_FALSE(refused.success);
  EXPECT_NE(std::string::npos, refused.message.find("limits/contacts")) << refused.message;
}

TEST_F(Service, NoMoreStatesAreInspectedThanTheLimit)
{
  CheckStates::Request asked = request({"turn", "slide"}, std::vector<double>(22, 0.0));
  asked.max_contacts = 1;
  EXPECT_TRUE(answer(asked).success) << "none of them collides";
  asked.clearance = true;
  expectRefusal(asked, "limits/inspected_states");
}

TEST_F(Service, MoreContactsThanTheLimitAreRefusedAndNotCutOff)
{
  CheckServices bounded(store, server, memory, {1000, 1000000, 10, 2}, {});
  CheckStates::Request asked = request({"turn", "slide"}, {0.0, 1.0, 0.0, 1.0, 0.0, 1.0});
  asked.max_contacts = 1;
  const CheckStates::Response refused = bounded.checkStates(asked);
  EXPECT_FALSE(refused.success);
  EXPECT_NE(std::string::npos, refused.message.find("limits/contacts")) << refused.message;
  EXPECT_TRUE(refused.contacts.empty());
  asked.positions.resize(4);
  EXPECT_EQ(2u, bounded.checkStates(asked).contacts.size()) << "as many as the limit";
  asked.max_contacts = std::numeric_limits<std::uint32_t>::max();
  asked.max_contacts_per_pair = 1;
  EXPECT_EQ(2u, bounded.checkStates(asked).contacts.size()) << "what is found counts, not what is asked for";
}

TEST_F(Service, AMotionIsAnsweredWithWhereItIsBlockedAndByWhat)
{
  CheckMotions::Request asked;
  asked.joint_names = {"slide", "turn"};
  asked.starts = {0.0, 0.0, 0.0, 0.0};
  asked.ends = {0.5, 0.0, 1.0, 0.0};
  asked.resolution = 0.1;
  asked.translation_resolution = 0.1;
  asked.motion_rule = "samples";
  const CheckMotions::Response response = services.checkMotions(asked);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ((std::vector<std::uint8_t>{1, 0}), response.valid);
  // The cart hits the wall at 0.8 m, up to rounding.
  EXPECT_NEAR(0.75, response.last_valid_fraction.at(1), 0.06);
  EXPECT_NEAR(0.1, response.first_invalid_fraction.at(1) - response.last_valid_fraction.at(1), 1e-9);
  EXPECT_EQ("", response.body_1.at(0));
  EXPECT_EQ("cart", response.body_1.at(1));
  EXPECT_EQ("wall", response.body_2.at(1));
  EXPECT_EQ(5u, response.scene_revision);
  asked.group = "mast";
  const CheckMotions::Response of_other_group = services.checkMotions(asked);
  EXPECT_EQ(AnswerStatus::INVALID_REQUEST, of_other_group.status);
  EXPECT_EQ(0u, of_other_group.message.find("motion 0 moves slide, which is not in group 'mast'"))
      << of_other_group.message;
  asked.ends.pop_back();
  EXPECT_NE(std::string::npos, services.checkMotions(asked).message.find("4 values in starts and 3 in ends"));
}

TEST_F(Service, MotionsAreProvenByTheRuleOfTheRequestOrByTheNodes)
{
  CheckMotions::Request asked;
  asked.joint_names = {"slide", "turn"};
  asked.starts = {0.0, 0.0, 0.0, 0.0};
  asked.ends = {0.5, 0.0, 1.0, 0.0};
  asked.resolution = 0.3;
  asked.translation_resolution = 0.3;
  asked.motion_rule = "samples";
  const CheckMotions::Response sampled = services.checkMotions(asked);
  asked.motion_rule = "bound";
  const CheckMotions::Response proven = services.checkMotions(asked);
  asked.motion_rule = "";
  const CheckMotions::Response unnamed = services.checkMotions(asked);
  for (const CheckMotions::Response& response : {sampled, proven, unnamed})
    EXPECT_EQ((std::vector<std::uint8_t>{1, 0}), response.valid) << response.message;
  EXPECT_GT(proven.states_checked, sampled.states_checked);
  EXPECT_EQ(proven.states_checked, unnamed.states_checked) << "the node's own rule is the bound";
  asked.ends[0] = 7.0;
  const CheckMotions::Response beyond = services.checkMotions(asked);
  EXPECT_TRUE(beyond.success);
  EXPECT_EQ(0, beyond.valid.at(0));
  EXPECT_NE(std::string::npos,
            beyond.message.find("motion 0: joint 'slide' is 7, outside its limits -2 to 2; the motion rule"))
      << beyond.message;
  asked.motion_rule = "samples";
  asked.ends[0] = 90.0;
  EXPECT_EQ(0u, services.checkMotions(asked).message.find("motion 0: joint 'slide' is 90, outside its limits -2 to 2"));
  asked.ends[0] = 1e7;
  EXPECT_EQ(0u, services.checkMotions(asked).message.find("motion 0: the value of variable 'slide' is 10000000;"));
  asked.ends[0] = 0.5;
  asked.motion_rule = "sample";
  EXPECT_NE(std::string::npos, services.checkMotions(asked).message.find("must be samples or bound"));
  asked.motion_rule = "bound";
  asked.translation_resolution = 1e-5;
  EXPECT_NE(std::string::npos, services.checkMotions(asked).message.find("motion 0 has more than 20000 samples"));
  asked.motion_rule = "samples";
  asked.translation_resolution = 1e-9;
  const std::string message = services.checkMotions(asked).message;
  EXPECT_NE(std::string::npos, message.find("more than 1000 samples")) << message;
}

TEST_F(Service, AMissingStepOfMotionsIsNamedAsInTheRequest)
{
  CheckMotions::Request asked;
  asked.joint_names = {"slide", "turn"};
  asked.starts = {0.0, 0.0};
  asked.ends = {0.5, 0.0};
  asked.translation_resolution = 0.1;
  EXPECT_EQ(
      "resolution is 0; give the largest step between two samples: a finite number of radians above 0, for "
      "example 0.02",
      services.checkMotions(asked).message);
  asked.resolution = 0.1;
  asked.translation_resolution = -1.0;
  EXPECT_EQ(0u, services.checkMotions(asked).message.find("translation_resolution is -1; "));
}

TEST_F(Service, ANamedStateOfFixedJointsIsRefused)
{
  std::string srdf = sliderSrdf();
  srdf.insert(srdf.find("</robot>"),
              "<group name=\"bolts\"><joint name=\"bolt\"/></group>"
              "<group_state name=\"tight\" group=\"bolts\"><joint name=\"bolt\" "
              "value=\"0\"/></group_state>");
  const auto robot = RobotModel::fromXml(sliderUrdf(), srdf, {});
  const std::string error = errorOf([&] { requestedNamedState(*robot, {"named_state", "tight"}, nullptr); });
  EXPECT_EQ(
      "the state 'tight' of the SRDF sets no variable: each of its joints is fixed, follows another joint, or has a "
      "value that was ignored with a warning; name another state",
      error);
}

TEST_F(Service, AMotionGoesFromOneNamedStateToAnother)
{
  CheckMotions::Request asked;
  asked.named_start = "left";
  asked.named_end = "drive/right";
  asked.resolution = asked.translation_resolution = 0.1;
  const CheckMotions::Response named = services.checkMotions(asked);
  ASSERT_TRUE(named.success) << named.message;
  asked.named_start = asked.named_end = "";
  asked.joint_names = {"turn", "slide"};
  asked.starts = {0.8, -1.0};
  asked.ends = {0.8, 1.0};
  const CheckMotions::Response with_values = services.checkMotions(asked);
  EXPECT_EQ(with_values.valid, named.valid);
  EXPECT_EQ(with_values.last_valid_fraction, named.last_valid_fraction);
  EXPECT_EQ("cart", named.body_1.at(0));
  EXPECT_EQ("wall", named.body_2.at(0));
}

TEST_F(Service, ANamedEndCountsForAllMotions)
{
  store.updateState({{"slide", 1.0}, {"turn", 0.0}});  // in the wall: a value of the current state would collide
  CheckMotions::Request asked;
  asked.named_start = "left";
  asked.joint_names = {"turn"};
  asked.ends = {0.0, 0.5, 0.8};
  asked.resolution = asked.translation_resolution = 0.1;
  const CheckMotions::Response from = services.checkMotions(asked);
  ASSERT_TRUE(from.success) << from.message;
  EXPECT_EQ((std::vector<std::uint8_t>{1, 1, 1}), from.valid) << "the cart stays where the start has it";
  asked = CheckMotions::Request();
  asked.named_end = "left";
  asked.joint_names = {"slide", "turn"};
  asked.starts = {-1.0, 0.0, 1.0, 0.0, 0.0, 0.5};
  asked.resolution = asked.translation_resolution = 0.1;
  const CheckMotions::Response to = services.checkMotions(asked);
  ASSERT_TRUE(to.success) << to.message;
  EXPECT_EQ((std::vector<std::uint8_t>{1, 0, 1}), to.valid);
  asked.joint_names = {"turn"};
  asked.starts = {0.0, 0.5};
  EXPECT_EQ((std::vector<std::uint8_t>{0, 0}), services.checkMotions(asked).valid)
      << "the cart starts where it is now: in the wall";
  store.updateState({{"slide", 1.9}});
  EXPECT_EQ((std::vector<std::uint8_t>{0, 0}), services.checkMotions(asked).valid) << "it drives through the wall";
  store.updateState({{"slide", 0.0}});
  EXPECT_EQ((std::vector<std::uint8_t>{1, 1}), services.checkMotions(asked).valid) << "it drives away from the wall";
}

TEST_F(Service, ANameAndValuesOfOneEndOfAMotionAreRefused)
{
  CheckMotions::Request asked;
  asked.resolution = asked.translation_resolution = 0.1;
  asked.named_start = "home";
  asked.named_end = "left";
  EXPECT_EQ("the SRDF has no state 'home'; its states: drive/left, drive/right", services.checkMotions(asked).message);
  asked.named_start = "left";
  asked.joint_names = {"turn"};
  EXPECT_EQ("named_start is 'left', but joint_names is not empty; give one of the two",
            services.checkMotions(asked).message);
  asked.named_start = "";
  asked.starts = asked.ends = {0.5};
  EXPECT_EQ("named_end is 'left', but ends is not empty; give one of the two", services.checkMotions(asked).message);
  asked = CheckMotions::Request();
  asked.named_start = "left";
  EXPECT_EQ("joint_names is empty; name at least one variable, or give a state of the SRDF by its name",
            services.checkMotions(asked).message);
}

TEST_F(Service, MotionsThatNeedTooManyChecksAreNotFreeAndMarked)
{
  CheckServices few{store, server, memory, {1000, 8, 10}, {}};
  CheckMotions::Request asked;
  asked.joint_names = {"slide", "turn"};
  asked.starts = {-1.0, 0.0, 0.0, 0.0};
  asked.ends = {-1.0, 0.0, 0.7999, 0.0};  // the second ends 0.1 mm before the wall
  asked.resolution = 0.3;
  asked.translation_resolution = 0.3;
  const CheckMotions::Response all = services.checkMotions(asked);
  EXPECT_EQ((std::vector<std::uint8_t>{1, 1}), all.valid) << all.message;
  EXPECT_EQ((std::vector<std::uint8_t>{0, 0}), all.given_up);
  EXPECT_GT(all.states_checked, 8u);
  EXPECT_EQ("", all.message);
  const CheckMotions::Response response = few.checkMotions(asked);
  EXPECT_TRUE(response.success);
  EXPECT_EQ((std::vector<std::uint8_t>{1, 0}), response.valid);
  EXPECT_EQ((std::vector<std::uint8_t>{0, 1}), response.given_up);
  ASSERT_EQ(2u, response.last_valid_fraction.size());
  EXPECT_LT(response.last_valid_fraction[1], 1.0);
  EXPECT_EQ(8u, response.states_checked);
  EXPECT_EQ("", response.body_1.at(1));
  EXPECT_EQ(
      "1 of 2 motions are not proven free, because 8 checks (limits/motion_checks) did not suffice; the first is "
      "motion "
      "1; send fewer or shorter motions in one request",
      response.message);
}

TEST_F(Service, AMatrixOfARequestReplacesTheScenes)
{
  CheckStates::Request asked = request({"turn", "slide"}, {0.0, 1.0});
  asked.allowed_collision_matrix.default_entry_names = {"wall"};
  asked.allowed_collision_matrix.default_entry_values = {1};
  const CheckStates::Response response = answer(asked);
  EXPECT_EQ((std::vector<std::uint8_t>{1}), response.valid);
  EXPECT_EQ(
      "allowed_collision_matrix: it has only default entries, so the pairs that the SRDF allows are checked too (as in "
      "MoveIt); give entry_names and entry_values for them",
      response.message);
}

TEST_F(Service, ValuesOutsideTheLimitsAreCheckedWithAWarning)
{
  const CheckStates::Response response = answer(request({"turn", "slide"}, {0.5, 0.0, 90.0, 1.0, 0.0, -3.0}));
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_EQ((std::vector<std::uint8_t>{1, 0, 1}), response.valid);
  EXPECT_EQ(
      "state 1: joint 'turn' is 90, outside its limits -3 to 3 rad; values are in radians, and 90 degrees are "
      "1.5708 rad; 1 more value is outside the limits",
      response.message);
}

TEST_F(Service, AValueOfTheCurrentStateOutsideItsLimitsIsNamed)
{
  store.updateState({{"slide", 0.0}, {"turn", -45.0}});
  const std::string expected = "joint 'turn' is -45, outside its limits";
  EXPECT_EQ(0u, answer(request({"slide"}, {0.0})).message.find("the current state: " + expected));
  EXPECT_EQ("", answer(request({"slide", "turn"}, {0.0, 0.0})).message);
  CheckMotions::Request motions;
  motions.joint_names = {"slide"};
  motions.starts = {0.0};
  motions.ends = {0.1};
  motions.resolution = motions.translation_resolution = 0.05;
  motions.motion_rule = "samples";
  EXPECT_EQ(0u, services.checkMotions(motions).message.find("motion 0: " + expected));
}

TEST_F(Service, AReportHasLinesAndNumbers)
{
  const GetReport::Response response = services.report({});
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_FALSE(response.lines.empty());
  ASSERT_EQ(response.names.size(), response.values.size());
  EXPECT_EQ("self_pairs", response.names.at(0));
  for (const char* name : {"rigid_pairs", "pairs_outside_group"})
    EXPECT_EQ(1, std::count(response.names.begin(), response.names.end(), name)) << name;
  EXPECT_EQ(5u, response.scene_revision);
}

TEST_F(Service, AReportNamesTheVariablesGroupsAndStatesThatARequestCanUse)
{
  const std::vector<std::string> lines = services.report({}).lines;
  const auto has = [&lines](const std::string& line) { return std::count(lines.begin(), lines.end(), line) == 1; };
  EXPECT_TRUE(has("variables, with their limits in radians or metres: slide (-2 to 2), turn (-3 to 3)"))
      << testing::PrintToString(lines);
  EXPECT_TRUE(has("groups: drive, mast")) << testing::PrintToString(lines);
  EXPECT_TRUE(has("named states: drive/left, drive/right")) << testing::PrintToString(lines);
}

TEST_F(Service, AReportHasEachNameOnOneLine)
{
  PlanningScene scene = sliderAndWall();
  scene.objects[0].id = "wa\nll";
  SceneReport report;
  report.always_colliding = {{0, static_cast<std::int32_t>(scene.robot->links().size())}};
  for (const std::string& line : describeScene(scene, report, ""))
    EXPECT_EQ(std::string::npos, line.find('\n')) << line;
}

TEST_F(Service, AProcessThatUsesTooMuchMemoryTakesNothingMore)
{
  const MemoryGuard full(1);
  CheckServices guarded(store, server, full, {}, {});
  const CheckStates::Response response = guarded.checkStates(request({"turn", "slide"}, {0.0, 0.0}));
  EXPECT_EQ(AnswerStatus::OUT_OF_MEMORY, response.status);
  EXPECT_NE(std::string::npos, response.message.find("limits/memory")) << response.message;
}

/// A checker that throws the same exception in each check.
template <class Exception>
class FailingChecker : public StateChecker
{
 public:
  void setScene(std::shared_ptr<const PlanningScene>) override {}
  BatchResult checkBatch(const StateBatch&) override { throw Exception("no device"); }
  SceneReport report(const std::string&) override { return {}; }
  std::string deviceName() const override { return ""; }
};

TEST_F(Service, AFailureOfTheDeviceIsAnAnswer)
{
  const MakeChecker losing = [](auto) { return std::make_shared<FailingChecker<DeviceLost>>(); };
  const MakeChecker throwing = [](auto) { return std::make_shared<FailingChecker<std::runtime_error>>(); };
  for (const MakeChecker& make_checker : {losing, throwing})
  {
    CheckServer failing(store, make_checker, {});
    const auto response =
        CheckServices(store, failing, memory, {}, {}).checkStates(request({"turn", "slide"}, {0.0, 0.0}));
    EXPECT_FALSE(response.success);
    EXPECT_EQ(AnswerStatus::INTERNAL_ERROR, response.status);
    EXPECT_EQ("no device", response.message);
  }
}

TEST_F(Service, AFullQueueAndAnEndingNodeAnswerEachServiceWithTheirStatus)
{
  Gate gate;
  CheckServerOptions options;
  options.small_request = 1;
  options.max_waiting_requests = 1;
  CheckServer gated(
      store, [&gate](auto scene) { return std::make_shared<GatedChecker>(std::move(scene), gate); }, options);
  CheckServices crowded(store, gated, memory, {}, {});
  CheckMotions::Request motion;
  motion.joint_names = {"turn", "slide"};
  motion.starts = motion.ends = {0.0, 0.0};
  motion.motion_rule = "samples";
  motion.resolution = motion.translation_resolution = 0.1;
  CheckTrajectory::Request trajectory;
  trajectory.motion_rule = motion.motion_rule;
  trajectory.joint_trajectory.joint_names = motion.joint_names;
  trajectory.joint_trajectory.points.resize(1);
  trajectory.joint_trajectory.points[0].positions = {0.0, 0.0};
  trajectory.start_state.joint_state.name = motion.joint_names;
  trajectory.start_state.joint_state.position = {0.0, 0.0};
  trajectory.resolution = trajectory.translation_resolution = 0.1;
  const auto expect_statuses = [&](std::uint8_t status)
  {
    EXPECT_EQ(status, crowded.checkStates(request(motion.joint_names, {0.0, 0.0})).status);
    EXPECT_EQ(status, crowded.report({}).status);
    EXPECT_EQ(status, crowded.checkMotions(motion).status);
    EXPECT_EQ(status, crowded.checkTrajectory(trajectory).status);
  };

  gate.close();
  std::vector<std::future<CheckAnswer>> before;
  for (const std::size_t states : {1, 2})  // of the queue of small requests, and of that of large ones
    for (int i = 0; i < 2; ++i)            // one that is checked, and one that waits
    {
      CheckJob job;
      job.states.assign(2 * states, 0.0);
      before.push_back(gated.submit(std::move(job)));
      if (i == 0)
        gate.waitForChecks(states);
    }
  expect_statuses(AnswerStatus::BUSY);
  gate.open();
  for (std::future<CheckAnswer>& answer : before)
    answer.get();
  expect_statuses(AnswerStatus::OK);
  gated.stop();
  expect_statuses(AnswerStatus::SHUTTING_DOWN);
}

/// A mobile robot with known joint values. The pose of its base is unknown.
class UnknownBase : public testing::Test
{
 public:
  std::string messageOf(const CheckStates::Request& asked)
  {
    const CheckStates::Response response = services.checkStates(asked);
    EXPECT_TRUE(response.success) << response.message;
    return response.message;
  }

  SceneStore store{PlanningScene(sliderRobotOnFloor("planar")), {}, {}};
  CheckServer server{store,
                     [](std::shared_ptr<const PlanningScene> scene)
                     { return std::make_shared<CpuChecker>(std::move(scene)); },
                     {}};
  MemoryGuard memory{0};
  CheckServices services{store, server, memory, {1000, 1000000, 10}, {}};
};

TEST_F(UnknownBase, IsAssumedAtTheOriginAndEachAnswerSaysSo)
{
  const CheckStates::Request joints = request({"turn", "slide"}, {0.5, 0.0});
  EXPECT_NE(std::string::npos, messageOf(joints).find("assumed at the origin of frame")) << messageOf(joints);
  EXPECT_EQ("", messageOf(request({"turn", "slide", "floor/x", "floor/y", "floor/theta"}, {0.5, 0, 1, 2, 0})));
  store.updateState({{"floor/x", 1.0}, {"floor/y", 0.0}, {"floor/theta", 0.0}});
  EXPECT_EQ("", messageOf(joints));
}

/// Even if the request changes the scene for itself, unless it places an object by the robot's pose.
TEST_F(UnknownBase, IsNotMentionedIfTheRequestGivesThePose)
{
  CheckStates::Request states = request({"turn", "slide", "floor/x", "floor/y", "floor/theta"}, {0.5, 0, 1, 2, 0});
  states.scene_diff.is_diff = states.scene_diff.robot_state.is_diff = 1;
  states.scene_diff.link_padding.resize(1);
  states.scene_diff.link_padding[0].link_name = "rail";
  store.updateState({{"slide", 0.0}, {"turn", 0.0}});
  EXPECT_EQ("", messageOf(states));

  CollisionObject box;
  box.id = "box";
  box.operation = CollisionObject::ADD;
  box.primitives.resize(1);
  box.primitives[0].type = shape_msgs::SolidPrimitive::BOX;
  box.primitives[0].dimensions.assign(3, 0.1);
  box.pose.position.z = 9.0;
  box.pose.orientation.w = 1.0;
  const auto message_in = [&](const std::string& frame)
  {
    box.header.frame_id = frame;
    states.scene_diff.world.collision_objects = {box};
    return messageOf(states);
  };
  EXPECT_EQ("", message_in(store.snapshot().scene->robot->planningFrame()));
  EXPECT_NE(std::string::npos, message_in("rail").find("assumed at the origin of frame"));

  SceneChange on_table;
  on_table.is_diff = true;
  ObjectChange table;
  table.id = "table";
  table.shapes = {{Box{{1.0, 1.0, 0.1}}}};
  on_table.objects = {table};
  store.apply(on_table, {});
  EXPECT_EQ("", message_in("table"));
}

TEST_F(UnknownBase, IsThatOfTfWhereARequestGivesOnlyTheOtherJoints)
{
  const auto source = [](std::int64_t) { return AssumedBase{{1.0, 0.0, 0.0}, ""}; };
  PlanningScene scene(sliderRobotOnFloor("planar"));
  scene.objects = sliderAndWall().objects;  // a wall from x = 0.9 to 1.1 m
  SceneStore on_tf(scene, {}, {}, source);
  CheckServer on_tf_server(on_tf,
                           [](std::shared_ptr<const PlanningScene> checked)
                           { return std::make_shared<CpuChecker>(std::move(checked)); },
                           {});
  CheckServices checks(on_tf, on_tf_server, memory, {1000, 1000000, 10}, {});
  const CheckStates::Response states = checks.checkStates(request({"slide", "turn"}, {0.0, 0.0, -1.0, 0.0}));
  EXPECT_EQ((std::vector<std::uint8_t>{0, 1}), states.valid) << states.message;

  CheckTrajectory::Request path;
  path.start_state.joint_state.name = {"slide", "turn"};
  path.start_state.joint_state.position = {-1.0, 0.0};
  path.joint_trajectory.joint_names = {"slide"};
  path.joint_trajectory.points.resize(1);
  path.joint_trajectory.points[0].positions = {0.0};
  path.resolution = path.translation_resolution = 0.1;
  const CheckTrajectory::Response trajectory = checks.checkTrajectory(path);
  EXPECT_TRUE(trajectory.success) << trajectory.message;
  EXPECT_TRUE(trajectory.start_valid);
  EXPECT_EQ(std::vector<std::uint8_t>{0}, trajectory.waypoint_valid);

  CheckStates::Request changed = request({"slide", "turn"}, {-1.0, 0.0});
  changed.scene_diff.is_diff = 1;
  changed.scene_diff.robot_state.is_diff = 1;
  changed.scene_diff.robot_state.joint_state = path.start_state.joint_state;
  EXPECT_EQ(std::vector<std::uint8_t>{1}, checks.checkStates(changed).valid);
}

TEST_F(UnknownBase, AndPassiveJointsNeedNoValue)
{
  std::string srdf = sliderSrdf();
  srdf.insert(srdf.find("</robot>"), "<passive_joint name=\"turn\"/>");
  SceneStore casters(PlanningScene(RobotModel::fromXml(sliderUrdf(), srdf, {})), {}, {});
  CheckServer casters_server(casters,
                             [](std::shared_ptr<const PlanningScene> checked)
                             { return std::make_shared<CpuChecker>(std::move(checked)); },
                             {});
  CheckServices checks(casters, casters_server, memory, {1000, 1000000, 10}, {});
  const CheckStates::Response states = checks.checkStates(request({"slide"}, {0.0}));
  EXPECT_TRUE(states.success) << states.message;
  EXPECT_EQ(std::vector<std::uint8_t>{1}, states.valid);
  const GetReport::Response report = checks.report(GetReport::Request());
  EXPECT_EQ(1, std::count(report.lines.begin(), report.lines.end(),
                          "no state has set passive joints of the SRDF; they have their default values: turn = 0"));
  casters.updateState({{"turn", 0.5}});
  const GetReport::Response measured = checks.report(GetReport::Request());
  EXPECT_EQ(report.lines.size() - 1, measured.lines.size());
}
}  // namespace
}  // namespace gpu_planning_scene::core
