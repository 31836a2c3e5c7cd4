// The scene of a running service: revisions, the robot's state, frames of external sources, and listeners.

#include <atomic>
#include <chrono>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include "gpu_planning_scene/error.h"
#include "model/full_states.h"
#include "model/model_testing.h"
#include "model/virtual_joint.h"
#include "scene/slider_robot.h"
#include "service/scene_store.h"
#include "service/service_errors.h"
#include "support/repetitions.h"

namespace gpu_planning_scene::core
{
namespace
{
SceneChange boxIn(const std::string& frame, const std::string& id = "box")
{
  ObjectChange object;
  object.id = id;
  object.frame.name = frame;
  object.pose = Eigen::Isometry3d::Identity();
  object.shapes.push_back({Box{{0.1, 0.1, 0.1}}, Eigen::Isometry3d::Identity()});
  SceneChange change;
  change.is_diff = true;
  change.objects.push_back(object);
  return change;
}

Eigen::Isometry3d unknownFrame(const StampedFrame& frame)
{
  throw Error("no frame '" + frame.name + "'");
}

class Store : public testing::Test
{
 public:
  SceneStore store{PlanningScene(sliderRobot()), {}, {}};
};

TEST_F(Store, AChangeMakesANewRevisionAndLeavesOldScenesAlone)
{
  const auto before = store.snapshot().scene;
  EXPECT_EQ(1u, store.apply(boxIn(""), unknownFrame).revision);
  EXPECT_TRUE(before->objects.empty());
  ASSERT_EQ(1u, store.snapshot().scene->objects.size());
  EXPECT_EQ(1u, store.snapshot().scene->revision);
  EXPECT_EQ(2u, store.clear().revision);
  EXPECT_TRUE(store.snapshot().scene->objects.empty());
}

TEST_F(Store, AFollowedChangeHasItsRevision)
{
  store.follow(boxIn(""), 70);
  EXPECT_EQ(70u, store.snapshot().scene->revision);
  EXPECT_EQ(1u, store.snapshot().scene->objects.size());
  store.follow(boxIn("", "other"), 60);  // the other store was made anew
  EXPECT_EQ(60u, store.snapshot().scene->revision);
  EXPECT_THROW(store.follow(boxIn("no such frame"), 80), Error);
  EXPECT_EQ(60u, store.snapshot().scene->revision);
}

TEST_F(Store, KeepsReplacedScenesForAWhile)
{
  const auto now = [] { return std::chrono::steady_clock::now(); };
  store.follow(boxIn("", "first"), 10);
  store.follow(boxIn("", "second"), 20);
  EXPECT_EQ(1u, store.at(10, now()).scene->objects.size());
  EXPECT_EQ(2u, store.at(20, now()).scene->objects.size());
  for (const std::uint64_t missing : {5, 15, 25})
    EXPECT_THROW(store.at(missing, now()), UnknownRevision) << missing;

  for (std::uint64_t revision = 21; revision < 150; ++revision)
  {
    store.follow(boxIn("", "second"), revision);
    store.at(10, now());
  }
  EXPECT_EQ(10u, store.at(10, now()).scene->revision) << "it was used all the time";
  EXPECT_THROW(store.at(20, now()), UnknownRevision) << "64 scenes are kept";
  store.forgetReplaced(now());
  EXPECT_THROW(store.at(10, now()), UnknownRevision);
  EXPECT_EQ(149u, store.at(149, now()).scene->revision);
}

TEST_F(Store, LargeReplacedScenesAreFew)
{
  SceneChange change = boxIn("");
  change.objects[0].shapes.resize(60000, change.objects[0].shapes[0]);
  for (std::uint64_t revision = 1; revision <= 6; ++revision)
    store.follow(change, revision);
  const auto now = std::chrono::steady_clock::now();
  EXPECT_THROW(store.at(2, now), UnknownRevision) << "four scenes would have 240,000 shapes";
  EXPECT_EQ(3u, store.at(3, now).scene->revision);
}

TEST_F(Store, WaitsForARevisionThatIsOnItsWay)
{
  std::thread leader(
      [this]
      {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        store.follow(boxIn(""), 30);
      });
  EXPECT_EQ(1u, store.at(30, std::chrono::steady_clock::now() + std::chrono::seconds(30)).scene->objects.size());
  leader.join();
}

TEST_F(Store, NamesItsNewestRevisionIfItLacksTheRequestedOne)
{
  store.follow(boxIn(""), 30);
  for (const std::uint64_t missing : {20, 40})
    try
    {
      store.at(missing, std::chrono::steady_clock::now());
      ADD_FAILURE() << missing;
    }
    catch (const UnknownRevision& error)
    {
      EXPECT_EQ(30u, error.newest());
    }
}

TEST_F(Store, EndsTheWaitForARevisionWhenItIsStopped)
{
  const auto begin = std::chrono::steady_clock::now();
  const auto stop = [begin] { return std::chrono::steady_clock::now() - begin > std::chrono::milliseconds(50); };
  EXPECT_THROW(store.at(30, begin + std::chrono::seconds(30), stop), ShuttingDown);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

TEST_F(Store, OnlyVariablesOfUpdatesAreMeasuredAndOnlyForASecond)
{
  SceneChange change;
  change.is_diff = true;
  change.state.variables = {{"turn", 0.5}};
  store.apply(change, unknownFrame);
  store.updateState({{"slide", 0.25}, {"unknown", 1.0}});
  const auto measured = [this](const char* name)
  {
    const Snapshot now = store.snapshot();
    return now.isMeasured(now.scene->robot->variableIndex(name));
  };
  EXPECT_TRUE(measured("slide"));
  EXPECT_FALSE(measured("turn"));
  std::this_thread::sleep_for(std::chrono::milliseconds(1050));
  EXPECT_FALSE(measured("slide")) << "no message has come for a second";
}

TEST_F(Store, EachOwnerHasAListener)
{
  int first = 0;
  int second = 0;
  store.setListener(
      &first, [&first](const auto&, const auto&) { ++first; });
  store.setListener(&second, [&second](const auto&, const auto&) { ++second; });
  store.clear();
  store.setListener(&first, {});
  store.clear();
  EXPECT_EQ(1, first);
  EXPECT_EQ(2, second);
}

/// As in MoveIt configurations for an arm on a table, whose drivers report no pose of the base.
TEST_F(Store, TheVirtualJointStandsAtTheOriginUntilItIsSet)
{
  for (const char* type : {"planar", "floating"})
  {
    SceneStore on_floor{PlanningScene(sliderRobotOnFloor(type)), {}, {}};
    const RobotModel& robot = *on_floor.snapshot().scene->robot;
    const std::vector<double> row = {0.5, 0.25};
    const std::vector<double> state =
        fullStates(robot, variableIndices(robot, {"slide", "turn"}), row.data(), 1, on_floor.snapshot().partialState());
    std::vector<double> expected = robot.defaultState();
    expected[static_cast<std::size_t>(robot.variableIndex("slide"))] = 0.5;
    expected[static_cast<std::size_t>(robot.variableIndex("turn"))] = 0.25;
    EXPECT_EQ(expected, state) << type;
    EXPECT_FALSE(on_floor.snapshot().allKnown()) << type;
    // A mobile robot may be anywhere, so each answer says what was assumed.
    const std::vector<int> floor = virtualVariables(robot);
    EXPECT_NE(on_floor.snapshot().assumedBase({}).find("is assumed at the origin of frame"), std::string::npos);
    EXPECT_EQ(on_floor.snapshot().assumedBase(floor), "") << "the request gives it";
    const std::string but_x = on_floor.snapshot().assumedBase({floor.front()});
    EXPECT_NE(but_x.find("not set; they are assumed: "), std::string::npos) << but_x;
    for (const int variable : floor)
      EXPECT_EQ(but_x.find(robot.variables()[static_cast<std::size_t>(variable)].name + " = ") == std::string::npos,
                variable == floor.front())
          << but_x;
    std::map<std::string, double> received;
    for (const int variable : floor)
      received[robot.variables()[static_cast<std::size_t>(variable)].name] =
          robot.defaultState()[static_cast<std::size_t>(variable)];
    on_floor.updateState(received);
    EXPECT_EQ(on_floor.snapshot().assumedBase({}), "") << "it was received";
  }
}

TEST_F(Store, TheVirtualJointIsThatOfTheSourceIfASceneFileLeavesItOut)
{
  PlanningScene scene(sliderRobotOnFloor("planar"));
  scene.current_state = scene.robot->defaultState();
  const auto source = [](std::int64_t) { return AssumedBase{{3.0, 4.0, 0.5}, ""}; };
  const auto x = static_cast<std::size_t>(scene.robot->variableIndex("floor/x"));
  EXPECT_EQ(0.0, SceneStore(scene, {}, {}, source).snapshot().state[x]);
  scene.base_is_default = true;
  SceneStore store_of_file(scene, {}, {}, source);
  EXPECT_EQ(3.0, store_of_file.snapshot().state[x]);
  EXPECT_TRUE(store_of_file.snapshot().allKnown());
  store_of_file.updateState({{"floor/x", 1.0}});
  EXPECT_EQ(1.0, store_of_file.snapshot().state[x]);
}

TEST_F(Store, PassiveJointsHaveTheirDefaultValuesUntilTheyAreSet)
{
  std::string srdf = sliderSrdf();
  srdf.insert(srdf.find("</robot>"), "<passive_joint name=\"turn\"/>");
  SceneStore casters{PlanningScene(RobotModel::fromXml(sliderUrdf(), srdf, {})), {}, {}};
  const RobotModel& robot = *casters.snapshot().scene->robot;
  const double row = 0.5;
  EXPECT_FALSE(casters.snapshot().allKnown());
  EXPECT_EQ((std::vector<double>{0.5, 0.0}),
            fullStates(robot, variableIndices(robot, {"slide"}), &row, 1, casters.snapshot().partialState()));
  casters.updateState({{"slide", 0.25}});
  EXPECT_TRUE(casters.snapshot().allKnown());
  EXPECT_EQ("no state has set passive joints of the SRDF; they have their default values: turn = 0",
            assumedPassiveJoints(robot, casters.snapshot().known));
  // A change that places an object relative to a link needs a whole state.
  SceneChange change = boxIn("pole");
  EXPECT_NO_THROW(casters.apply(change, unknownFrame));
  casters.updateState({{"turn", 0.125}});
  EXPECT_EQ((std::vector<double>{0.25, 0.125}), fullStates(robot, {}, nullptr, 1, casters.snapshot().partialState()));
  EXPECT_EQ("", assumedPassiveJoints(robot, casters.snapshot().known));
}

TEST_F(Store, ClearRemovesWhatTheMatrixAllowsTheObjects)
{
  SceneChange change = boxIn("");
  change.matrix = store.snapshot().scene->allowed_collisions;
  change.matrix->setEntry("box", "cart", true);
  change.matrix->setEntry("held", "cart", true);
  change.state.attached.resize(1);
  change.state.attached[0].link = "pole";
  change.state.attached[0].object = boxIn("pole", "held").objects[0];
  store.apply(change, unknownFrame);
  store.clear();
  EXPECT_TRUE(store.snapshot().scene->allowed_collisions == AllowedCollisionMatrix::fromRobot(*sliderRobot()));
}

TEST_F(Store, RejectedChangesChangeNothing)
{
  store.apply(boxIn(""), unknownFrame);
  const auto before = store.snapshot().scene;
  SceneChange wrong = boxIn("", "other");
  wrong.objects.push_back(wrong.objects.front());
  wrong.objects.back().operation = Operation::Remove;
  wrong.objects.back().id = "no such object";
  EXPECT_THROW(store.apply(wrong, unknownFrame), Error);
  EXPECT_THROW(store.apply(boxIn("nowhere"), unknownFrame), Error);
  EXPECT_EQ(before, store.snapshot().scene);
}

TEST_F(Store, FramesThatTheSceneDoesNotKnowAreRequested)
{
  std::vector<std::string> asked;
  const auto lookup = [&asked](const StampedFrame& frame)
  {
    asked.push_back(frame.name);
    return Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 3.0));
  };
  store.apply(boxIn("camera"), lookup);
  store.apply(boxIn("box", "on_the_box"), lookup);
  EXPECT_EQ((std::vector<std::string>{"camera"}), asked);
  EXPECT_DOUBLE_EQ(3.0, store.snapshot().scene->objects[0].pose.translation().z());
  EXPECT_DOUBLE_EQ(3.0, store.snapshot().scene->objects[1].pose.translation().z());
}

TEST_F(Store, FramesRemovedByAnotherChangeAreLookedUpAgain)
{
  store.apply(boxIn("", "table"), unknownFrame);
  SceneChange change = boxIn("camera");
  change.objects.push_back(boxIn("table", "cup").objects.front());
  std::vector<std::string> asked;
  const auto lookup = [&](const StampedFrame& frame)
  {
    asked.push_back(frame.name);
    if (frame.name == "camera")
      store.clear();
    return Eigen::Isometry3d::Identity();
  };
  store.apply(change, lookup);
  EXPECT_EQ((std::vector<std::string>{"camera", "table"}), asked);
  EXPECT_EQ(2u, store.snapshot().scene->objects.size());
}

TEST_F(Store, JointStatesChangeNoRevision)
{
  EXPECT_FALSE(store.snapshot().allKnown());
  store.updateState({{"slide", 0.5}, {"wheel of another robot", 9.0}});
  EXPECT_EQ((std::vector<bool>{true, false}), store.snapshot().known);
  store.updateState({{"turn", 0.25}});
  EXPECT_EQ((std::vector<double>{0.5, 0.25}), store.snapshot().state);
  EXPECT_TRUE(store.snapshot().allKnown());
  EXPECT_EQ(0u, store.snapshot().scene->revision);
  EXPECT_THROW(store.updateState({{"slide", 1.0}, {"turn", std::numeric_limits<double>::quiet_NaN()}}), Error);
  EXPECT_EQ(1.0, store.snapshot().state[0]) << "the others go on";
  EXPECT_EQ((std::vector<bool>{true, false}), store.snapshot().known) << "the joint may be anywhere by now";
  store.updateState({{"turn", 0.25}});
  EXPECT_TRUE(store.snapshot().allKnown());
}

TEST_F(Store, TheStateAtAStampLiesBetweenTheValuesBeforeAndAfterIt)
{
  constexpr std::int64_t kSecond = 1'000'000'000;
  EXPECT_EQ(store.snapshot().state, store.stateAt(5 * kSecond)) << "none has come yet";
  store.updateState({{"slide", 0.25}, {"turn", 0.0}});
  EXPECT_EQ((std::vector<double>{0.25, 0.0}), store.stateAt(5 * kSecond)) << "none has come with a stamp";
  store.updateState({{"slide", 0.5}}, 5 * kSecond);
  store.updateState({{"slide", 0.75}}, 6 * kSecond);
  store.updateState({{"slide", 0.625}}, 5 * kSecond + kSecond / 2);  // late
  EXPECT_THROW(store.stateAt(1), Error) << "no state is near";
  EXPECT_EQ(0.5, store.stateAt(4 * kSecond).at(0));
  EXPECT_EQ(0.5, store.stateAt(5 * kSecond).at(0));
  EXPECT_DOUBLE_EQ(0.55, store.stateAt(5 * kSecond + kSecond / 5).at(0));
  EXPECT_DOUBLE_EQ(0.7, store.stateAt(5 * kSecond + kSecond * 4 / 5).at(0));
  EXPECT_EQ(0.75, store.stateAt(6 * kSecond).at(0));
  EXPECT_EQ(0.75, store.stateAt(7 * kSecond).at(0)) << "its driver is slow";
  EXPECT_THROW(store.stateAt(7 * kSecond + 1), Error) << "joint_states have ended";
  EXPECT_EQ(store.snapshot().state, store.stateAt(0));
  store.updateState({{"slide", 1.0}}, 16 * kSecond);
  EXPECT_NEAR(0.775, store.stateAt(7 * kSecond).at(0), 1e-3);
  EXPECT_THROW(store.stateAt(10 * kSecond), Error) << "in a gap of joint_states";
  EXPECT_THROW(store.stateAt(5 * kSecond), Error) << "older than what is kept";
  store.updateState({{"slide", 0.125}}, 2 * kSecond);  // the clock was set back, as in a simulation
  EXPECT_EQ(0.125, store.stateAt(3 * kSecond).at(0));
}

TEST_F(Store, TheStateAtAStampWaitsForTheNextValueOfAVariableThatMoves)
{
  constexpr std::int64_t kMillisecond = 1'000'000;
  std::int64_t now = 1000 * kMillisecond;
  const auto publish = [&](double value, std::int64_t milliseconds)
  {
    now += milliseconds * kMillisecond;
    store.updateState({{"slide", value}}, now);
  };
  for (int i = 0; i < 100; ++i)
    publish(0.3, 1);
  EXPECT_EQ(0.3, store.stateAt(now + 500 * kMillisecond).at(0)) << "it stands";
  for (int i = 0; i < 300; ++i)
    publish(0.3 + 2e-5 * i, 1);  // 2 cm/s, at 1 kHz
  EXPECT_THROW(store.stateAt(now + 1), NotKnownYet);
  EXPECT_NO_THROW(store.stateAt(now));
  for (int i = 0; i < 10; ++i)
    publish(0.306, 30);
  EXPECT_EQ(0.306, store.stateAt(now + 500 * kMillisecond).at(0)) << "it has stopped";
  publish(0.5, 300);
  EXPECT_EQ(0.5, store.stateAt(now + 500 * kMillisecond).at(0)) << "the driver is slow";
}

TEST_F(Store, TheStateBeforeTheFirstValueIsKnownOnlyOfAVariableThatStands)
{
  constexpr std::int64_t kMillisecond = 1'000'000;
  const std::int64_t begin = 1000 * kMillisecond;
  store.updateState({{"slide", 0.3}}, begin);
  EXPECT_THROW(store.stateAt(begin - 1), NotKnownYet) << "a single value says nothing about motion";
  store.updateState({{"slide", 0.3}}, begin + 10 * kMillisecond);
  EXPECT_EQ(0.3, store.stateAt(begin - 1).at(0));
  store.updateState({{"slide", 0.31}}, begin + 20 * kMillisecond);
  EXPECT_THROW(store.stateAt(begin - 1), Error) << "it moves";
  EXPECT_EQ(0.3, store.stateAt(begin).at(0));
}

TEST_F(Store, AChangeForgetsTheStatesBeforeIt)
{
  constexpr std::int64_t kMillisecond = 1'000'000;
  for (std::int64_t i = 0; i < 100; ++i)
    store.updateState({{"slide", 0.001 * static_cast<double>(i)}}, (1000 + 10 * i) * kMillisecond);
  SceneChange change;
  change.is_diff = true;
  change.state.variables = {{"slide", 0.1}};
  store.apply(change, unknownFrame);
  for (std::int64_t i = 0; i < 3; ++i)
    store.updateState({{"slide", 0.1}}, (2000 + 10 * i) * kMillisecond);
  EXPECT_THROW(store.stateAt(1900 * kMillisecond), Error);
  EXPECT_EQ(0.1, store.stateAt(2005 * kMillisecond).at(0));
}

TEST(StateHistoryOfAWheel, TurnsOnThroughHalfATurn)
{
  const auto robot = robotOf("<link name='base'/>" + boxLink("wheel") +
                             jointXml("turn", "continuous", "base", "wheel", "<axis xyz='0 0 1'/>"));
  StateHistory history(*robot);
  history.add(0, 3.0, 1'000'000'000);
  history.add(0, -3.0, 1'100'000'000);
  std::vector<double> state(1);
  history.setAt(1'050'000'000, state);
  EXPECT_NEAR(EIGEN_PI, std::abs(state[0]), 1e-9);
}

TEST_F(Store, TheStateAtAStampNeedsANearValueOfEachMeasuredVariable)
{
  constexpr std::int64_t kSecond = 1'000'000'000;
  store.updateState({{"slide", 0.25}}, 5 * kSecond);
  store.updateState({{"turn", 0.5}}, 5 * kSecond);
  store.updateState({{"turn", 0.75}}, 7 * kSecond);
  EXPECT_EQ((std::vector<double>{0.25, 0.5625}), store.stateAt(5 * kSecond + kSecond / 2));
  try
  {
    store.stateAt(7 * kSecond);
    ADD_FAILURE() << "nothing is known about the place of 'slide'";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("the nearest known value of 'slide' is 2 s away"), std::string::npos)
        << error.what();
  }
  store.updateState({{"slide", 1.0}});
  EXPECT_EQ((std::vector<double>{1.0, 0.75}), store.stateAt(7 * kSecond)) << "without a stamp, the newest value counts";
}

TEST_F(Store, AMeasuredVariableWhoseValuesHaveEndedIsNamed)
{
  store.updateState({{"slide", 0.25}});
  EXPECT_EQ("", store.snapshot().endedVariable()) << "nobody has ever measured the other variable";
  std::this_thread::sleep_for(std::chrono::milliseconds(2600));
  EXPECT_EQ(0u, store.snapshot().endedVariable().find("joint_states has brought no value of 'slide' for "));
  EXPECT_EQ("", store.snapshot().endedVariable({store.snapshot().scene->robot->variableIndex("slide")}));
  SceneChange change;
  change.is_diff = true;
  change.state.variables = {{"slide", 0.5}};
  store.apply(change, unknownFrame);
  EXPECT_EQ("", store.snapshot().endedVariable()) << "a client has set it";
  store.updateState({{"slide", 0.25}}, 5'000'000'000);
  store.apply(change, unknownFrame);
  EXPECT_EQ(0.5, store.stateAt(100'000'000'000).at(0)) << "also for measurements";
}

TEST_F(Store, AValueThatHasEndedStaysEndedWhenAFollowedSceneSetsIt)
{
  store.keepAges();
  store.updateState({{"slide", 0.25}});
  std::this_thread::sleep_for(std::chrono::milliseconds(2600));
  SceneChange change;
  change.is_diff = true;
  change.state.variables = {{"slide", 0.5}, {"turn", 0.5}};
  store.follow(change, 7);
  EXPECT_EQ(0.5, store.snapshot().state.at(0));
  EXPECT_EQ(0u, store.snapshot().endedVariable().find("joint_states has brought no value of 'slide' for "));
}

TEST_F(Store, AClockThatIsSetBackByLessThanTheKeptTimeForgetsTheValuesOfBefore)
{
  constexpr std::int64_t kSecond = 1'000'000'000;
  for (int i = 0; i <= 8; ++i)
    store.updateState({{"slide", 0.1 * i}, {"turn", 0.0}}, (1 + i) * kSecond);
  store.updateState({{"slide", 1.0}, {"turn", 0.0}}, 2 * kSecond);
  EXPECT_EQ(1.0, store.stateAt(2 * kSecond).at(0));
  EXPECT_THROW(store.stateAt(5 * kSecond), Error) << "this time is still to come";
}

TEST_F(Store, ATimeThatJumpsBackIsAWarningAndTheNewValueCounts)
{
  constexpr std::int64_t kSecond = 1'000'000'000;
  EXPECT_EQ("", store.updateState({{"slide", 0.25}}, 5 * kSecond));
  EXPECT_EQ("", store.updateState({{"turn", 0.5}}, 4 * kSecond)) << "another publisher of another joint";
  EXPECT_EQ("", store.updateState({{"slide", 0.5}}, 5 * kSecond));
  EXPECT_EQ(
      "the time of 'slide' jumped back by 2.000000 s; the new value counts: if the clock was not set back, look for a "
      "second publisher of this joint",
      store.updateState({{"slide", 0.75}}, 3 * kSecond));
  EXPECT_EQ(0.75, store.snapshot().state.at(0));
  EXPECT_EQ("", store.updateState({{"slide", 1.0}}, 4 * kSecond)) << "it goes on from there";
}

TEST_F(Store, TheStampOfASnapshotIsThatOfItsOldestValue)
{
  EXPECT_EQ(0, store.snapshot().stamp);
  store.updateState({{"slide", 0.25}}, 5);
  EXPECT_EQ(5, store.snapshot().stamp) << "the other variable is unknown";
  store.updateState({{"turn", 0.25}}, 4);
  EXPECT_EQ(4, store.snapshot().stamp);
  store.updateState({{"turn", 0.25}});
  EXPECT_EQ(0, store.snapshot().stamp) << "the other value has no stamp";
  SceneChange change;
  change.is_diff = true;
  change.state.variables = {{"slide", 0.75}};
  store.updateState({{"turn", 0.25}}, 6);
  store.apply(change, unknownFrame);
  EXPECT_EQ(0, store.snapshot().stamp) << "a change sets values without a stamp";
}

TEST_F(Store, APreviewIsWhatTheChangesWouldMakeAndLeavesTheStoreAsItIs)
{
  store.updateState({{"slide", 0.5}, {"turn", 0.0}});
  const Snapshot before = store.snapshot();
  SceneChange moved;
  moved.is_diff = true;
  moved.state.variables = {{"slide", 0.75}};
  const SceneStore::Preview preview = store.preview({moved, boxIn("cart")}, unknownFrame);
  EXPECT_EQ(before.scene, store.snapshot().scene);
  EXPECT_EQ(before.state, store.snapshot().state);
  EXPECT_EQ(before.scene->revision, preview.snapshot.scene->revision);
  store.apply(moved, unknownFrame);
  store.apply(boxIn("cart"), unknownFrame);
  EXPECT_EQ(store.snapshot().state, preview.snapshot.state);
  EXPECT_EQ(store.snapshot().scene->objects.at(0).pose.matrix(), preview.snapshot.scene->objects.at(0).pose.matrix());
  EXPECT_THROW(store.preview({moved, boxIn("nowhere")}, unknownFrame), Error);
}

TEST_F(Store, FramesOfLinksAreWhereTheNewestJointStatesPutThem)
{
  EXPECT_THROW(store.apply(boxIn("cart"), unknownFrame), Error) << "where the cart is, is not known yet";
  store.updateState({{"slide", 0.5}, {"turn", 0.0}});
  store.apply(boxIn("cart"), unknownFrame);
  EXPECT_DOUBLE_EQ(0.5, store.snapshot().scene->objects.at(0).pose.translation().x());
}

TEST_F(Store, AChangeMaySetTheStateAndJointStatesGoOnFromThere)
{
  SceneChange change;
  change.is_diff = true;
  change.state.variables = {{"slide", 0.75}, {"turn", 1.0}};
  store.apply(change, unknownFrame);
  EXPECT_EQ((std::vector<double>{0.75, 1.0}), store.snapshot().state);
  EXPECT_EQ((std::vector<double>{0.75, 1.0}), store.snapshot().scene->current_state);
  store.updateState({{"turn", 2.0}});
  EXPECT_EQ((std::vector<double>{0.75, 2.0}), store.snapshot().state);
}

TEST_F(Store, ASnapshotIsOfOneInstantWhileOthersChangeTheScene)
{
  // The x coordinates of the box and of the cart always add up to 1.
  const auto swap = [this](double slide)
  {
    SceneChange change = boxIn("");
    change.objects.front().pose = Eigen::Isometry3d(Eigen::Translation3d(1.0 - slide, 0.0, 0.0));
    change.state.variables = {{"slide", slide}, {"turn", 0.0}};
    store.apply(change, unknownFrame);
  };
  swap(0.0);
  std::atomic<bool> done{false};
  std::atomic<int> torn{0};
  const auto look = [&]
  {
    while (!done)
    {
      const Snapshot now = store.snapshot();
      torn += now.state[0] + now.scene->objects[0].pose.translation().x() == 1.0 ? 0 : 1;
    }
  };
  const auto turn = [&]
  {
    for (std::int64_t stamp = 1; !done; ++stamp)
    {
      store.updateState({{"turn", 0.5}}, stamp);
      store.stateAt(stamp);
    }
  };
  std::vector<std::thread> others;
  others.emplace_back(look);
  others.emplace_back(look);
  others.emplace_back(turn);
  for (int i = 0; i < repetitions(10000, 40000); ++i)
    swap(i % 2 == 0 ? 1.0 : 0.0);
  done = true;
  for (std::thread& other : others)
    other.join();
  EXPECT_EQ(0, torn);
}

TEST_F(Store, AListenerHearsEachChangeInOrder)
{
  std::vector<std::uint64_t> heard;
  store.setListener(this,
                    [&](const auto& before, const auto& after)
                    {
                      EXPECT_EQ(before->revision + 1, after->revision);
                      EXPECT_EQ(after, store.snapshot().scene) << "readers have it already";
                      heard.push_back(after->revision);
                    });
  store.apply(boxIn(""), unknownFrame);
  EXPECT_THROW(store.apply(boxIn("nowhere", "other"), unknownFrame), Error);
  store.clear();
  EXPECT_EQ((std::vector<std::uint64_t>{1, 2}), heard);
}
}  // namespace
}  // namespace gpu_planning_scene::core
