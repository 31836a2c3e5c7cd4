#include "client/answers.h"

#include <utility>

namespace gpu_planning_scene::core
{
namespace
{
using gpu_planning_scene::AnswerStatus;

/// The kinds of a failure. A fault of the node, too little memory, and a status that this version does not know count
/// as a refusal: if all nodes answer so, the client does not try again and again.
Outcome outcomeOfFailure(const CheckStates::Response& response, std::uint64_t revision)
{
  switch (response.status)
  {
    case AnswerStatus::BUSY:
      return Outcome::Busy;
    case AnswerStatus::UNKNOWN_REVISION:
      return response.scene_revision > revision ? Outcome::Gone : Outcome::OtherScenes;
    case AnswerStatus::SHUTTING_DOWN:
    case AnswerStatus::UNAVAILABLE:
      return Outcome::Unable;
    default:
      return Outcome::Refused;
  }
}

Answer failed(Outcome outcome, std::uint8_t status, const std::string& node, const std::string& reason)
{
  Answer answer;
  answer.outcome = outcome;
  answer.failure = {status, node + ": " + reason};
  return answer;
}
}  // namespace

Answer answerOf(const std::string& node, CheckStates::Response response, std::uint64_t revision)
{
  if (response.success && response.status == AnswerStatus::OK)
  {
    if (revision != 0 && response.scene_revision != revision)
      return failed(Outcome::OtherScenes, AnswerStatus::UNKNOWN_REVISION, node,
                    "the node has answered for revision " + std::to_string(response.scene_revision) +
                        " of the scene instead of " + std::to_string(revision));
    Answer answer;
    answer.outcome = Outcome::Answered;
    answer.response = std::move(response);
    return answer;
  }
  if (response.status == CheckStates::Response().status || response.status == AnswerStatus::OK)
    return noAnswerOf(node, "the node has sent an empty response");
  return failed(outcomeOfFailure(response, revision), response.status, node, response.message);
}

Answer noAnswerOf(const std::string& node, const std::string& reason)
{
  return failed(Outcome::Unable, AnswerStatus::UNAVAILABLE, node, reason);
}

CheckStates::Response responseOf(const Failure& failure)
{
  CheckStates::Response response;
  response.success = 0;
  response.status = failure.status;
  response.message = failure.message;
  return response;
}

void Failures::add(Outcome outcome, const Failure& failure)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (outcome == Outcome::Refused || outcome == Outcome::Gone)
    refusal_ = failure;
  else
    are_passing_ = true;
  lack_scene_ = lack_scene_ || outcome == Outcome::OtherScenes || outcome == Outcome::Gone;
  last_ = failure;
}
}  // namespace gpu_planning_scene::core
