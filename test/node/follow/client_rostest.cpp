// A client of several nodes gets each kind of answer. The nodes are fakes in this program.

#include <limits>

#include "gpu_planning_scene/client/sharded_checker.h"
#include "gpu_planning_scene/error.h"
#include "node/follow/fake_node.h"
#include "node/node_client.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::uint8_t kUnknownStatus = 200;  // of a later version
constexpr std::size_t kManyStates = 10000;    // they are split

ShardedCheckerOptions withPatience(double seconds)
{
  ShardedCheckerOptions options;
  options.patience = seconds;
  return options;
}

/// The answers of the only node, and what the client makes of them.
struct Case
{
  std::string name;
  std::vector<std::uint8_t> statuses;
  std::uint8_t result = AnswerStatus::OK;
  std::size_t calls = 0;
};

void PrintTo(const Case& example, std::ostream* out)
{
  *out << example.name;
}

std::string nameOf(const testing::TestParamInfo<Case>& example)
{
  return example.param.name;
}

class ClientOfOneNode : public testing::TestWithParam<Case>
{
};

TEST_P(ClientOfOneNode, RepeatsACallOnlyIfThatCanHelp)
{
  for (const std::size_t states : {std::size_t{1}, kManyStates})
  {
    const FakeNode node("/fake", GetParam().statuses);
    ShardedChecker checker({"/fake"}, withPatience(20.0));
    const CheckStates::Response response = checker.check(FakeNode::requestOf(states));
    EXPECT_EQ(GetParam().result, response.status) << response.message;
    EXPECT_EQ(GetParam().result == AnswerStatus::OK, response.success != 0);
    EXPECT_EQ(GetParam().result == AnswerStatus::OK ? states : 0, response.valid.size());
    if (states == 1)
      EXPECT_EQ(GetParam().calls, node.calls());
    if (GetParam().result != AnswerStatus::OK)
      EXPECT_EQ("/fake: a fault", response.message);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Statuses, ClientOfOneNode,
    testing::Values(
        Case{"Ok", {AnswerStatus::OK}, AnswerStatus::OK, 1},
        Case{"Busy", {AnswerStatus::BUSY, AnswerStatus::OK}, AnswerStatus::OK, 2},
        Case{"ShuttingDown", {AnswerStatus::SHUTTING_DOWN, AnswerStatus::OK}, AnswerStatus::OK, 2},
        Case{"Unavailable", {AnswerStatus::UNAVAILABLE, AnswerStatus::OK}, AnswerStatus::OK, 2},
        Case{"UnknownRevision", {AnswerStatus::UNKNOWN_REVISION, AnswerStatus::OK}, AnswerStatus::OK, 2},
        Case{"EmptyResponse", {0, AnswerStatus::OK}, AnswerStatus::OK, 2},
        Case{"OutOfMemory", {AnswerStatus::OUT_OF_MEMORY, AnswerStatus::OK}, AnswerStatus::OUT_OF_MEMORY, 1},
        Case{"InvalidRequest", {AnswerStatus::INVALID_REQUEST, AnswerStatus::OK}, AnswerStatus::INVALID_REQUEST, 1},
        Case{"InternalError", {AnswerStatus::INTERNAL_ERROR, AnswerStatus::OK}, AnswerStatus::INTERNAL_ERROR, 1},
        Case{"UnknownStatus", {kUnknownStatus, AnswerStatus::OK}, kUnknownStatus, 1}),
    nameOf);

class ClientOfTwoNodes : public testing::TestWithParam<Case>
{
};

TEST_P(ClientOfTwoNodes, TakesTheOtherOneAtOnce)
{
  for (const std::size_t states : {std::size_t{1}, kManyStates})
  {
    const FakeNode fails("/fails", GetParam().statuses);
    const FakeNode answers("/answers", {AnswerStatus::OK});
    ShardedChecker checker({"/fails", "/answers"}, withPatience(20.0));
    const CheckStates::Response response = checker.check(FakeNode::requestOf(states));
    EXPECT_TRUE(response.success) << response.message;
    EXPECT_EQ(states, response.valid.size());
    if (states == 1)
      EXPECT_EQ((std::pair<std::size_t, std::size_t>{1, 1}), (std::pair{fails.calls(), answers.calls()}));
  }
}

INSTANTIATE_TEST_SUITE_P(Statuses, ClientOfTwoNodes,
                         testing::Values(Case{"Busy", {AnswerStatus::BUSY}},
                                         Case{"ShuttingDown", {AnswerStatus::SHUTTING_DOWN}},
                                         Case{"Unavailable", {AnswerStatus::UNAVAILABLE}},
                                         Case{"UnknownRevision", {AnswerStatus::UNKNOWN_REVISION}},
                                         Case{"InvalidRequest", {AnswerStatus::INVALID_REQUEST}},
                                         Case{"InternalError", {AnswerStatus::INTERNAL_ERROR}},
                                         Case{"UnknownStatus", {kUnknownStatus}}),
                         nameOf);

TEST(ClientOfFakes, WithoutAnAnswerTheStatusIsThatOfTheLastReason)
{
  for (const std::uint8_t status :
       {AnswerStatus::BUSY, AnswerStatus::SHUTTING_DOWN, AnswerStatus::UNAVAILABLE, AnswerStatus::UNKNOWN_REVISION})
    for (const std::size_t states : {std::size_t{1}, kManyStates})
    {
      const FakeNode node("/fake", {status});
      ShardedChecker checker({"/fake"}, withPatience(0.2));
      const CheckStates::Response response = checker.check(FakeNode::requestOf(states));
      EXPECT_FALSE(response.success);
      EXPECT_EQ(status, response.status);
      EXPECT_EQ("no node can answer; the last reason: /fake: a fault", response.message);
      EXPECT_GT(node.calls(), 1U);
    }
}

TEST(ClientOfFakes, ARevisionThatIsNotKeptAnyMoreEndsTheCallAtOnce)
{
  const FakeNode node("/fake", {AnswerStatus::UNKNOWN_REVISION}, FakeNode::kRevision);
  ShardedChecker checker({"/fake"}, withPatience(1000.0));
  CheckStates::Request request = FakeNode::requestOf(1);
  request.scene_revision = FakeNode::kRevision - 1;
  EXPECT_EQ(AnswerStatus::UNKNOWN_REVISION, checker.check(request).status);
  EXPECT_EQ(std::size_t{1}, node.calls());
}

TEST(ClientOfFakes, ARequestThatAllNodesRefuseIsSentToEachOfThemOnce)
{
  for (const std::uint8_t status :
       {std::uint8_t{AnswerStatus::INTERNAL_ERROR}, std::uint8_t{AnswerStatus::OUT_OF_MEMORY}, kUnknownStatus})
    for (const std::size_t states : {std::size_t{1}, kManyStates})
    {
      const FakeNode one("/one", {status});
      const FakeNode two("/two", {status});
      ShardedChecker checker({"/one", "/two"}, withPatience(20.0));
      EXPECT_EQ(status, checker.check(FakeNode::requestOf(states)).status);
      EXPECT_EQ((std::pair<std::size_t, std::size_t>{1, 1}), (std::pair{one.calls(), two.calls()}));
    }
}

TEST(ClientOfFakes, AnAnswerForAnotherRevisionIsNone)
{
  const FakeNode node("/fake", {AnswerStatus::OK}, FakeNode::kRevision + 1);
  const CheckStates::Response response = ShardedChecker({"/fake"}, withPatience(0.0)).check(FakeNode::requestOf(1));
  EXPECT_EQ(AnswerStatus::UNKNOWN_REVISION, response.status);
  EXPECT_EQ(
      "no node can answer; the last reason: /fake: the node has answered for revision 8 of the scene instead of 7",
      response.message);
}

TEST(ClientOfFakes, ANodeThatLagsBehindIsNotAskedInPlaceOfALostLeader)
{
  auto leader = std::make_unique<FakeNode>("/leader", std::vector<std::uint8_t>{AnswerStatus::OK}, 8, 8);
  const FakeNode replica("/replica", {AnswerStatus::OK}, 7, 7);
  ShardedChecker checker({"/leader", "/replica"}, withPatience(0.2));
  EXPECT_EQ(8U, checker.check(FakeNode::requestOf(1)).scene_revision);
  leader.reset();
  const CheckStates::Response response = checker.check(FakeNode::requestOf(1));
  EXPECT_FALSE(response.success);
  EXPECT_NE(std::string::npos,
            response.message.find("/replica: its scene is missing: it has revision 7, but revision 8 was there before"))
      << response.message;
  leader = std::make_unique<FakeNode>("/leader", std::vector<std::uint8_t>{AnswerStatus::OK}, 1, 1);
  EXPECT_TRUE(checker.check(FakeNode::requestOf(1)).success) << "a leader that starts again begins with revision 1";
}

TEST(ClientOfFakes, ANodeOfAnotherVersionIsNamedAsTheReason)
{
  // The type of a service of another version has another checksum. Here it is another service.
  ros::NodeHandle node;
  const boost::function<bool(GetReport::Request&, GetReport::Response&)> answer =
      [](GetReport::Request&, GetReport::Response&) { return true; };
  const ros::ServiceServer service = node.advertiseService("/other/get_planning_scene", answer);
  const CheckStates::Response response = ShardedChecker({"/other"}, withPatience(0.0)).check(FakeNode::requestOf(1));
  EXPECT_EQ(AnswerStatus::UNAVAILABLE, response.status);
  EXPECT_NE(std::string::npos, response.message.find("/other: ")) << response.message;
  EXPECT_NE(std::string::npos, response.message.find("another version of this package")) << response.message;
}

TEST(ClientOfFakes, AConnectionThatTheNodeHasClosedIsMadeAnew)
{
  ShardedChecker checker({"/fake"}, withPatience(0.0));
  for (int run = 0; run < 2; ++run)
  {
    const FakeNode node("/fake", {AnswerStatus::OK});
    EXPECT_TRUE(checker.check(FakeNode::requestOf(1)).success) << "run " << run;
  }
}

TEST(ClientOfFakes, ACancelledCallEndsSoon)
{
  const FakeNode node("/fake", {AnswerStatus::BUSY});
  ShardedChecker checker({"/fake"}, withPatience(1000.0));
  for (const std::size_t states : {std::size_t{1}, kManyStates})
  {
    const std::size_t calls = node.calls() + 5;
    EXPECT_THROW(checker.check(FakeNode::requestOf(states), [&] { return node.calls() > calls; }), Cancelled);
  }
}

TEST(ClientOfFakes, WrongNamesAndOptionsAreErrors)
{
  EXPECT_THROW(ShardedChecker({}), Error);
  EXPECT_THROW(ShardedChecker({"/a node"}), Error);
  ShardedCheckerOptions options;
  options.part_states = 0;
  EXPECT_THROW(ShardedChecker({"/fake"}, options), Error);
  for (const double wrong : {-1.0, std::numeric_limits<double>::quiet_NaN()})
  {
    EXPECT_THROW(ShardedChecker({"/fake"}, withPatience(wrong)), Error);
    options = {};
    options.timeout = wrong;
    EXPECT_THROW(ShardedChecker({"/fake"}, options), Error);
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
