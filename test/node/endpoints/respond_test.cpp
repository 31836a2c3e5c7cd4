// Which status and message an error gives an answer. No ROS master is needed.

#include <functional>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include <gtest/gtest.h>

#include "base/error_place.h"
#include "node/endpoints/bounded_message.h"
#include "node/endpoints/respond.h"
#include "node/messages/messages.h"
#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
namespace
{
struct Case
{
  std::function<void()> fail;
  std::uint8_t status;
  std::string message;
};

template <class Exception>
std::function<void()> throwing(const Exception& error)
{
  return [error] { throw error; };
}

TEST(Faults, TheTypeOfAnErrorDecidesTheStatus)
{
  const std::string ending = "shutting down: the request was not answered";
  const std::vector<Case> cases = {
      {throwing(Error("why")), AnswerStatus::INVALID_REQUEST, "why"},
      {throwing(Busy("why")), AnswerStatus::BUSY, "why"},
      {throwing(UnknownRevision("why", 5)), AnswerStatus::UNKNOWN_REVISION, "why"},
      {throwing(ShuttingDown("why")), AnswerStatus::SHUTTING_DOWN, "why"},
      {throwing(Cancelled()), AnswerStatus::SHUTTING_DOWN, ending},
      {throwing(Unavailable("why")), AnswerStatus::UNAVAILABLE, "why"},
      {throwing(NotKnownYet("why")), AnswerStatus::UNAVAILABLE, "why"},
      {throwing(std::system_error(EAGAIN, std::generic_category())), AnswerStatus::UNAVAILABLE,
       "the system gives the node no further thread; send the request again later"},
      {throwing(std::system_error(EINVAL, std::generic_category(), "why")), AnswerStatus::INTERNAL_ERROR,
       "why: Invalid argument"},
      {throwing(DeviceLost("why")), AnswerStatus::INTERNAL_ERROR, "why"},
      {throwing(InternalError("why")), AnswerStatus::INTERNAL_ERROR, "why"},
      {throwing(std::logic_error("why")), AnswerStatus::INTERNAL_ERROR, "why"},
      {throwing(OutOfMemory("why")), AnswerStatus::OUT_OF_MEMORY, "why"},
      {throwing(std::bad_alloc()), AnswerStatus::OUT_OF_MEMORY,
       "out of memory; send a smaller request, or remove objects"},
      {throwing(Error("")), AnswerStatus::INVALID_REQUEST, "unknown error"},
      {throwing(Error("two\nlines")), AnswerStatus::INVALID_REQUEST, "two lines"},
      {throwing(7), AnswerStatus::INTERNAL_ERROR, "unknown error"},
  };
  for (const Case& one : cases)
  {
    const Fault fault = faultOf(one.fail);
    EXPECT_EQ(one.status, fault.status) << fault.message;
    EXPECT_EQ(one.message, fault.message);
    EXPECT_TRUE(fault);
  }
  EXPECT_FALSE(faultOf([] {}));
}

TEST(Faults, AnUnknownRevisionComesWithTheNewestOne)
{
  const auto fail = [](CheckStates::Response&) { throw UnknownRevision("why", 5); };
  EXPECT_EQ(5u, respond<CheckStates::Response>(fail).scene_revision);
}

TEST(Faults, APlaceBeforeTheMessageLeavesTheTypeAsItIs)
{
  const auto placed = [](const std::function<void()>& fail)
  { return faultOf([&] { withErrorPlace("goal 3", fail); }); };
  for (const auto& [fail, status, message] : std::vector<Case>{
           {throwing(Error("why")), AnswerStatus::INVALID_REQUEST, "goal 3: why"},
           {throwing(NotKnownYet("why")), AnswerStatus::UNAVAILABLE, "goal 3: why"},
           {throwing(ShuttingDown("why")), AnswerStatus::SHUTTING_DOWN, "why"},
           {throwing(Busy("why")), AnswerStatus::BUSY, "why"},
           {throwing(DeviceLost("why")), AnswerStatus::INTERNAL_ERROR, "why"},
           {throwing(UnknownRevision("why", 5)), AnswerStatus::UNKNOWN_REVISION, "why"},
       })
  {
    const Fault fault = placed(fail);
    EXPECT_EQ(status, fault.status) << fault.message;
    EXPECT_EQ(message, fault.message);
  }
  EXPECT_EQ(7, withErrorPlace("goal 3", [] { return 7; }));
}

TEST(Responses, AResponseThatNobodyFilledInIsNoSuccess)
{
  const CheckStates::Response response;
  EXPECT_FALSE(response.success);
  EXPECT_NE(AnswerStatus::OK, response.status);
  const GetPlanningScene::Response scene;
  EXPECT_NE(AnswerStatus::OK, scene.status);
}

TEST(Responses, AreASuccessWithTheStatusOkAlone)
{
  const Clear::Response filled = respond<Clear::Response>([](Clear::Response&) {});
  EXPECT_TRUE(filled.success);
  EXPECT_EQ(AnswerStatus::OK, filled.status);
  const auto with = [](std::uint8_t status)
  { return respond<PlanMotion::Response>([status](PlanMotion::Response&) { return status; }); };
  EXPECT_TRUE(with(AnswerStatus::OK).success);
  const PlanMotion::Response unsolved = with(PlanMotion::Response::NO_SOLUTION);
  EXPECT_FALSE(unsolved.success);
  EXPECT_EQ(PlanMotion::Response::NO_SOLUTION, unsolved.status);
  EXPECT_FALSE(with(0).success);
}

TEST(Responses, OfAFailedRequestHaveNothingOfItsWork)
{
  const auto fail = [](CheckStates::Response& response)
  {
    response.valid = {1};
    throw Error("why");
  };
  const CheckStates::Response response = respond<CheckStates::Response>(fail);
  EXPECT_FALSE(response.success);
  EXPECT_EQ(AnswerStatus::INVALID_REQUEST, response.status);
  EXPECT_TRUE(response.valid.empty());
}

TEST(Responses, AFailedSceneChangesNothingIfAClientSendsItBack)
{
  const auto response = failed<GetPlanningScene::Response>({AnswerStatus::UNAVAILABLE, "why"});
  EXPECT_TRUE(response.scene.is_diff);
  EXPECT_TRUE(response.scene.robot_state.is_diff);
}

/// A message that takes more memory than there is.
struct Huge
{
};
}  // namespace
}  // namespace gpu_planning_scene::core

namespace ros
{
namespace message_traits
{
template <>
struct IsMessage<gpu_planning_scene::core::Huge> : TrueType
{
};
}  // namespace message_traits
namespace serialization
{
template <>
struct Serializer<gpu_planning_scene::core::Huge>
{
  template <class Stream, class T>
  static void allInOne(Stream&, T)
  {
    throw std::bad_alloc();
  }
};
}  // namespace serialization
}  // namespace ros

namespace gpu_planning_scene::core
{
namespace
{
TEST(Requests, ThatTheMemoryOfTheNodeCannotHoldAreNotCalledWrong)
{
  std::vector<std::uint8_t> bytes(1);
  ros::serialization::IStream stream(bytes.data(), 1);
  Bounded<Huge> huge;
  ros::serialization::deserialize(stream, huge);
  const Fault fault = faultOf([&] { huge.requireRead(); });
  EXPECT_EQ(AnswerStatus::OUT_OF_MEMORY, fault.status);

  Bounded<Clear::Request> wrong;
  ros::serialization::IStream too_long(bytes.data(), 1);
  ros::serialization::deserialize(too_long, wrong);
  EXPECT_EQ(AnswerStatus::INVALID_REQUEST, faultOf([&] { wrong.requireRead(); }).status);
}
}  // namespace
}  // namespace gpu_planning_scene::core
