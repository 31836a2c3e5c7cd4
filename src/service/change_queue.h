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
/// Changes of the scene that nobody waits for. They are made in the order in which they come, on a thread of the
/// queue's own; what waits together is made as one change where that leads to the same scene, since each change copies
/// it. A change that is refused takes no other one with it.
class ChangeQueue
{
 public:
  /// Makes a change, or throws and has changed nothing.
  using Make = std::function<void(const SceneChange& change)>;
  /// Called before what waits together is made.
  using Maker = std::function<Make()>;
  /// Hears, on the queue's thread, of a change that was not made.
  using Refuse = std::function<void(const std::string& source, const std::string& why)>;

  /// At most `most_changes` wait, and at most `most_bytes` (what whoever adds them says), but one always may.
  ChangeQueue(Maker maker, Refuse refuse, std::size_t most_changes, std::size_t most_bytes);
  /// As stop().
  ~ChangeQueue();

  /// `source`: where it comes from, for messages. Throws Busy where a bound is reached, Error after stop().
  void add(std::string source, SceneChange change, std::size_t bytes);

  /// Makes what it is making, and refuses all that waits.
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
  void make(const Make& make_one, const Changes& changes, std::size_t begin, std::size_t end);
  bool isStopping() const;

  const Maker maker_;
  const Refuse refuse_;
  const std::size_t most_changes_;
  const std::size_t most_bytes_;

  mutable std::mutex mutex_;  // of what follows
  std::condition_variable wake_;
  Changes waiting_;
  std::size_t bytes_ = 0;  // of what waits, and of what is being made
  std::size_t making_ = 0;
  bool stopping_ = false;
  std::thread thread_;  // the last one: it uses all of the above
};
}  // namespace gpu_planning_scene::core
