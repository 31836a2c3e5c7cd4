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
  std::uint8_t result = Status::OK;
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
    EXPECT_EQ(GetParam().result == Status::OK, response.success != 0);
    EXPECT_EQ(GetParam().result == Status::OK ? states : 0, response.valid.size());
    if (states == 1)
      EXPECT_EQ(GetParam().calls, node.calls());
    if (GetParam().result != Status::OK)
      EXPECT_EQ("/fake: a fault", response.message);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Statuses, ClientOfOneNode,
    testing::Values(Case{"Ok", {Status::OK}, Status::OK, 1}, Case{"Busy", {Status::BUSY, Status::OK}, Status::OK, 2},
                    Case{"ShuttingDown", {Status::SHUTTING_DOWN, Status::OK}, Status::OK, 2},
                    Case{"Unavailable", {Status::UNAVAILABLE, Status::OK}, Status::OK, 2},
                    Case{"UnknownRevision", {Status::UNKNOWN_REVISION, Status::OK}, Status::OK, 2},
                    // If OK is the status of an empty response, this is the first case again.
                    Case{"EmptyResponse",
                         {CheckStates::Response().status, Status::OK},
                         Status::OK,
                         CheckStates::Response().status == Status::OK ? std::size_t{1} : std::size_t{2}},
                    Case{"InvalidRequest", {Status::INVALID_REQUEST, Status::OK}, Status::INVALID_REQUEST, 1},
                    Case{"InternalError", {Status::INTERNAL_ERROR, Status::OK}, Status::INTERNAL_ERROR, 1},
                    Case{"UnknownStatus", {kUnknownStatus, Status::OK}, kUnknownStatus, 1}),
    nameOf);

class ClientOfTwoNodes : public testing::TestWithParam<Case>
{
};

TEST_P(ClientOfTwoNodes, TakesTheOtherOneAtOnce)
{
  for (const std::size_t states : {std::size_t{1}, kManyStates})
  {
    const FakeNode fails("/fails", GetParam().statuses);
    const FakeNode answers("/answers", {Status::OK});
    ShardedChecker checker({"/fails", "/answers"}, withPatience(20.0));
    const CheckStates::Response response = checker.check(FakeNode::requestOf(states));
    EXPECT_TRUE(response.success) << response.message;
    EXPECT_EQ(states, response.valid.size());
    if (states == 1)
      EXPECT_EQ((std::pair<std::size_t, std::size_t>{1, 1}), (std::pair{fails.calls(), answers.calls()}));
  }
}

INSTANTIATE_TEST_SUITE_P(Statuses, ClientOfTwoNodes,
                         testing::Values(Case{"Busy", {Status::BUSY}}, Case{"ShuttingDown", {Status::SHUTTING_DOWN}},
                                         Case{"Unavailable", {Status::UNAVAILABLE}},
                                         Case{"UnknownRevision", {Status::UNKNOWN_REVISION}},
                                         Case{"InvalidRequest", {Status::INVALID_REQUEST}},
                                         Case{"InternalError", {Status::INTERNAL_ERROR}},
                                         Case{"UnknownStatus", {kUnknownStatus}}),
                         nameOf);

TEST(ClientOfFakes, WithoutAnAnswerTheStatusIsThatOfTheLastReason)
{
  for (const std::uint8_t status : {Status::BUSY, Status::SHUTTING_DOWN, Status::UNAVAILABLE, Status::UNKNOWN_REVISION})
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

TEST(ClientOfFakes, ARequestThatAllNodesRefuseIsSentToEachOfThemOnce)
{
  for (const std::uint8_t status : {std::uint8_t{Status::INTERNAL_ERROR}, kUnknownStatus})
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
  const FakeNode node("/fake", {Status::OK}, FakeNode::kRevision + 1);
  const CheckStates::Response response = ShardedChecker({"/fake"}, withPatience(0.0)).check(FakeNode::requestOf(1));
  EXPECT_EQ(Status::UNKNOWN_REVISION, response.status);
  EXPECT_EQ(
      "no node can answer; the last reason: /fake: the node has answered for revision 8 of the scene instead of 7",
      response.message);
}

TEST(ClientOfFakes, ANodeOfAnotherVersionIsNamedAsTheReason)
{
  // The type of a service of another version has another checksum. Here it is another service.
  ros::NodeHandle node;
  const boost::function<bool(GetReport::Request&, GetReport::Response&)> answer =
      [](GetReport::Request&, GetReport::Response&) { return true; };
  const ros::ServiceServer service = node.advertiseService("/other/get_planning_scene", answer);
  const CheckStates::Response response = ShardedChecker({"/other"}, withPatience(0.0)).check(FakeNode::requestOf(1));
  EXPECT_EQ(Status::UNAVAILABLE, response.status);
  EXPECT_NE(std::string::npos, response.message.find("/other: ")) << response.message;
  EXPECT_NE(std::string::npos, response.message.find("another version of this package")) << response.message;
}

TEST(ClientOfFakes, AConnectionThatTheNodeHasClosedIsMadeAnew)
{
  ShardedChecker checker({"/fake"}, withPatience(0.0));
  for (int run = 0; run < 2; ++run)
  {
    const FakeNode node("/fake", {Status::OK});
    EXPECT_TRUE(checker.check(FakeNode::requestOf(1)).success) << "run " << run;
  }
}

TEST(ClientOfFakes, ACancelledCallEndsSoon)
{
  const FakeNode node("/fake", {Status::BUSY});
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
