#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu_planning_scene/motion_checker.h"
#include "gpu_planning_scene/state_checker.h"
#include "service/busy.h"
#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
struct CheckServerOptions
{
  std::size_t small_request = 1024;           ///< states; larger requests go to the other lane
  std::size_t most_waiting_requests = 64;     ///< in each lane
  std::size_t most_waiting_states = 4000000;  ///< in each lane
  std::size_t most_states = 1000000;          ///< of one request
  std::size_t largest_batch = 16384;          ///< states that are checked at once
};

/// States are rows of values for some of the robot's variables. The others are filled in when the check starts, from
/// what is known of the robot's state in the same instant as the scene that is checked.
struct CheckJob
{
  std::vector<int> columns;  ///< the variables that the rows have values of, each once; empty: all, in order
  std::vector<double> states;
  std::string group;
  std::shared_ptr<const AllowedCollisionMatrix> matrix;  ///< in place of the scene's; null: none
  bool report = false;                                   ///< whether the scene's report is wanted too
  bool keep_states = false;                              ///< whether the answer is to have the full states
  /// Set: the states are the starts of straight motions, then as many ends, and the answer is about the motions.
  std::optional<MotionCheckerOptions> motions;
  std::size_t samples = 0;  ///< of the motions, by their steps: what the job counts for in the queues
};

struct CheckAnswer
{
  BatchResult result;                  ///< seconds: of all that was answered together; of motions nothing else
  std::vector<MotionVerdict> motions;  ///< of a job that has motions, up to where each is valid
  std::uint64_t states_checked = 0;
  std::shared_ptr<const PlanningScene> scene;  ///< that was checked, the job's matrix in it
  std::optional<SceneReport> report;
  std::vector<double> states;  ///< rows of all variables, if they were to be kept
  std::string device;          ///< that answered
};

/// Since the start, and what waits now.
struct CheckStatistics
{
  std::uint64_t requests = 0;  ///< that were answered
  std::uint64_t batches = 0;   ///< that they were answered in
  std::uint64_t states = 0;
  std::uint64_t undecided = 0;  ///< of the states: those that the CPU settled for a device
  std::uint64_t busy = 0;       ///< requests that were turned away
  std::uint64_t errors = 0;     ///< requests that ended with an error
  std::size_t waiting_requests = 0;
  std::size_t waiting_states = 0;
};

class CheckQueue;

/// Checks for many clients at once, in two lanes, each with a thread and a checker of its own: one merges small
/// requests that wait together (of the same group and matrix), the other does large ones in turn, so a small one never
/// waits for a large one. (Requests with a large matrix are large too: to take it takes long.) A lane takes the store's
/// newest scene when it starts a batch: each answer belongs wholly to one snapshot, which is no older than any that the
/// store had when the request came.
class CheckServer
{
 public:
  using MakeChecker = std::function<std::shared_ptr<StateChecker>(std::shared_ptr<const PlanningScene>)>;

  /// Makes the small lane's checker at once, and throws what that throws; the large lane's when it is first needed. A
  /// checker that does not take a scene is dropped and another one made for the next batch. `store` outlives it.
  CheckServer(const SceneStore& store, const MakeChecker& make_checker, const CheckServerOptions& options);
  /// As stop().
  ~CheckServer();

  /// Throws Error for more states than one request may have.
  void requireStateCount(std::size_t count) const;

  /// Throws Busy at once where a bound is reached, Error for too many states. The future's error is the checker's, or
  /// that a variable is neither given nor known.
  std::future<CheckAnswer> submit(CheckJob job);

  /// Answers what runs, but for large requests that would take longer than about a second. All that waits, and what
  /// comes later, gets an Error "shutting down".
  void stop();

  CheckStatistics statistics() const;

 private:
  const CheckServerOptions options_;
  std::unique_ptr<CheckQueue> small_;
  std::unique_ptr<CheckQueue> large_;
};
}  // namespace gpu_planning_scene::core
