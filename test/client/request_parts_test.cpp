// Requests are split into parts that belong together, and their answers are joined.

#include <gtest/gtest.h>

#include "client/request_parts.h"

namespace gpu_planning_scene::core
{
namespace
{
CheckStates::Request requestOf(std::size_t states)
{
  CheckStates::Request request;
  request.joint_names = {"b", "a"};
  for (std::size_t i = 0; i < 2 * states; ++i)
    request.positions.push_back(static_cast<double>(i));
  return request;
}

CommonState commonState()
{
  CommonState common;
  common.revision = 7;
  common.joints = {{"a", -1.0}, {"c", -3.0}};
  return common;
}

TEST(RequestParts, AllStatesAreInOnePartEachWithTheJointsThatTheRequestDoesNotName)
{
  const CheckStates::Request request = requestOf(10);
  const std::vector<CheckStates::Request> parts = partsOf(request, commonState(), 3, 4);
  ASSERT_EQ(3u, parts.size());
  std::vector<double> found;
  for (const CheckStates::Request& part : parts)
  {
    EXPECT_EQ(7u, part.scene_revision);
    EXPECT_EQ((std::vector<std::string>{"b", "a", "c"}), part.joint_names);
    for (std::size_t i = 0; i < part.positions.size(); i += 3)
    {
      found.insert(found.end(), {part.positions[i], part.positions[i + 1]});
      EXPECT_EQ(-3.0, part.positions[i + 2]);
    }
  }
  EXPECT_EQ(request.positions, found);
}

TEST(RequestParts, ARequestWithoutAValueForAVariableIsNotSplit)
{
  EXPECT_TRUE(partsOf(requestOf(10), commonState(), 4, 4).empty());
}

TEST(RequestParts, OnlyPlainRequestsMayBeSplit)
{
  EXPECT_EQ(5000u, plainStates(requestOf(5000)));
  EXPECT_EQ(10u, plainStates(requestOf(10)));
  EXPECT_EQ(0u, plainStates(CheckStates::Request()));
  CheckStates::Request request = requestOf(5000);
  request.scene_diff.is_diff = 1;
  EXPECT_EQ(0u, plainStates(request));
  request = requestOf(5000);
  request.positions.pop_back();
  EXPECT_EQ(0u, plainStates(request));
}

TEST(RequestParts, AnswersAreJoinedInTheOrderOfTheStates)
{
  std::vector<CheckStates::Response> answers(3);
  for (std::size_t i = 0; i < answers.size(); ++i)
  {
    CheckStates::Response& answer = answers[i];
    answer.success = 1;
    answer.scene_revision = 7;
    answer.seconds = 1.0;
    answer.message = i == 1 ? "state 1: far" : "no tf";
    answer.valid = {1, 0};
    answer.body_1 = {"", "a" + std::to_string(i)};
    answer.body_2 = {"", "b"};
    answer.clearance_world = {static_cast<double>(i), 0.0};
    answer.contacts.resize(1);
    answer.contacts[0].state = 1;
    answer.gradient_names = {"a", "b", "added"};
    answer.distances.resize(1);
    answer.distances[0].state = 1;
    answer.distances[0].gradient = {1.0, 2.0, 3.0};
  }
  CheckStates::Request request;
  request.joint_names = {"a", "b"};
  const CheckStates::Response whole = joined(request, answers);
  EXPECT_EQ((std::vector<std::uint8_t>{1, 0, 1, 0, 1, 0}), whole.valid);
  EXPECT_EQ((std::vector<std::string>{"", "a0", "", "a1", "", "a2"}), whole.body_1);
  EXPECT_EQ((std::vector<double>{0, 0, 1, 0, 2, 0}), whole.clearance_world);
  ASSERT_EQ(3u, whole.contacts.size());
  for (std::size_t i = 0; i < 3; ++i)
  {
    EXPECT_EQ(2 * i + 1, whole.contacts[i].state);
    EXPECT_EQ(2 * i + 1, whole.distances.at(i).state);
    EXPECT_EQ((std::vector<double>{1.0, 2.0}), whole.distances[i].gradient) << "of the request's joints alone";
  }
  EXPECT_EQ(request.joint_names, whole.gradient_names);
  EXPECT_EQ("no tf; from state 2 on: state 1: far", whole.message);
  EXPECT_EQ(3.0, whole.seconds);
  EXPECT_EQ(7u, whole.scene_revision);
}
}  // namespace
}  // namespace gpu_planning_scene::core
