#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include <gpu_planning_scene/CheckStates.h>

namespace gpu_planning_scene::core
{
/// The parts of a request, which several threads send to their nodes. Thread-safe.
class SharedWork
{
 public:
  explicit SharedWork(std::vector<CheckStates::Request> parts);

  /// A part that nobody has. Waits while others have all open parts. No value: all parts are answered, or the work has
  /// been stopped.
  std::optional<std::size_t> take();
  void answer(std::size_t part, CheckStates::Response answer);
  void giveBack(std::size_t part);
  /// Nobody gets a part any more, also those who wait for one.
  void stop();

  std::size_t count() const { return parts_.size(); }
  const CheckStates::Request& part(std::size_t index) const { return parts_[index]; }
  std::size_t answeredCount() const;
  bool isComplete() const { return answeredCount() == parts_.size(); }
  /// The answers, in the order of the parts, once all are there.
  std::vector<CheckStates::Response> takeAnswers() { return std::move(answers_); }

 private:
  const std::vector<CheckStates::Request> parts_;
  std::vector<CheckStates::Response> answers_;
  mutable std::mutex mutex_;  // guards the members below, and answers_ until all are there
  std::condition_variable changed_;
  std::deque<std::size_t> open_;
  std::size_t answered_ = 0;
  bool is_stopped_ = false;
};
}  // namespace gpu_planning_scene::core
