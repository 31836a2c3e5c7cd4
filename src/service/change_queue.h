#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "gpu_planning_scene/scene_change.h"

namespace gpu_planning_scene::core
{
/// Scene changes for which no caller waits, such as those of a topic. The queue's own thread makes them in the order of
/// their arrival. Each change copies the scene, so queued changes are merged if that leads to the same scene. A
/// rejected change does not affect the other changes.
class ChangeQueue
{
 public:
  /// Makes a change. If it throws, nothing has changed.
  using ApplyChange = std::function<void(const SceneChange& change)>;
  /// Called once before each set of queued changes is made.
  using BeginBatch = std::function<ApplyChange()>;
  /// Called on the queue's thread for each change that was not made.
  using OnRejected = std::function<void(const std::string& source, const std::string& why)>;

  /// The queue holds at most `max_changes` changes with `max_bytes` bytes in total (see add()). One change always
  /// fits, whatever its size.
  ChangeQueue(BeginBatch begin_batch, OnRejected on_rejected, std::size_t max_changes, std::size_t max_bytes);
  /// Calls stop().
  ~ChangeQueue();

  /// `source`: the origin of the change, for messages. `bytes`: its size, for the bound. Throws Busy if a bound is
  /// reached; throws Error after stop().
  void add(std::string source, SceneChange change, std::size_t bytes);

  /// Finishes the current change and rejects all queued changes.
  void stop();

 private:
  struct Waiting
  {
    std::string source;
    SceneChange change;
    std::size_t bytes;
  };
  using Changes = std::vector<Waiting>;

  void run();
  void makeAll(const Changes& changes);
  void make(const ApplyChange& apply_change, const Changes& changes, std::size_t begin, std::size_t end);
  bool isStopping() const;

  const BeginBatch begin_batch_;
  const OnRejected on_rejected_;
  const std::size_t max_changes_;
  const std::size_t max_bytes_;

  mutable std::mutex mutex_;  // guards the members below
  std::condition_variable wake_;
  Changes waiting_;
  std::size_t bytes_ = 0;   // of the queued changes and of the changes that are being made
  std::size_t making_ = 0;  // number of changes that are being made
  bool stopping_ = false;
  std::thread thread_;  // last member: the thread uses all members above
};
}  // namespace gpu_planning_scene::core
