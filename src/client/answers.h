#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include <gpu_planning_scene/AnswerStatus.h>
#include <gpu_planning_scene/CheckStates.h>

namespace gpu_planning_scene::core
{
/// The meaning of a node's answer for the client. See AnswerStatus.msg.
enum class Outcome
{
  Answered,
  Unable,       ///< the node cannot answer now
  Busy,         ///< it can answer soon
  OtherScenes,  ///< it does not have the revision
  Gone,         ///< it does not keep the revision any more
  Refused       ///< it does not accept the request, or fails at it: other nodes are tried, but the call is not repeated
};

/// Why there is no answer.
struct Failure
{
  std::uint8_t status = gpu_planning_scene::AnswerStatus::UNAVAILABLE;
  std::string message;
};

/// The answer of a node to one call.
struct Answer
{
  Outcome outcome = Outcome::Unable;
  Failure failure;  ///< if the outcome is not Answered; the message begins with the name of the node
  CheckStates::Response response;
};

/// The answer that a response is. `revision`: of the scene that the request names; 0: none.
Answer answerOf(const std::string& node, CheckStates::Response response, std::uint64_t revision);

/// The answer of a node without a response.
Answer noAnswerOf(const std::string& node, const std::string& reason);

/// The response for the user if no node has answered.
CheckStates::Response responseOf(const Failure& failure);

/// The failures of the nodes in a round after which parts of the request have no answer. Thread-safe while they are
/// added.
class Failures
{
 public:
  void add(Outcome outcome, const Failure& failure);

  bool lackScene() const { return lack_scene_; }
  /// The failure for the user.
  const Failure& reported() const { return refusal_ ? *refusal_ : last_; }
  /// Whether no other node and no later time will help.
  bool areFinal() const { return refusal_ && !are_passing_; }

 private:
  std::mutex mutex_;
  std::optional<Failure> refusal_;
  Failure last_;
  bool are_passing_ = false;
  bool lack_scene_ = false;
};
}  // namespace gpu_planning_scene::core
