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
#include "service/make_checker.h"
#include "service/scene_store.h"
#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
struct CheckServerOptions
{
  std::size_t small_request = 1024;          ///< states; larger requests go to the queue of large requests
  std::size_t max_waiting_requests = 64;     ///< in each queue
  std::size_t max_waiting_states = 4000000;  ///< in each queue; one request always fits
  std::size_t max_states = 1000000;          ///< in one request
};

/// A request to check states or motions. States are rows of values for some of the robot's variables. The other
/// variables are filled in when the check starts, from the robot's state of the same snapshot as the checked scene.
struct CheckJob
{
  std::vector<int> columns;  ///< variable indices of the columns of `states`, each once; empty: all, in order
  std::vector<double> states;
  std::string group;
  std::optional<Snapshot> scene;  ///< the scene and the robot's state of this job; no value: the store's newest
  std::shared_ptr<const AllowedCollisionMatrix> matrix;  ///< replaces the scene's matrix; null: the scene's is used
  bool report = false;                                   ///< whether the answer has the scene's report
  bool keep_states = false;                              ///< whether the answer has the full states
  /// If set, straight motions are checked. `states` has their starts, followed by as many ends; or, if `is_path` is
  /// set, the waypoints of one path.
  std::optional<MotionCheckerOptions> motions;
  /// True: the motions go from each row of `states` to the next one, and the rows are checked as states too.
  bool is_path = false;
  std::size_t samples = 0;  ///< samples of the motions at their steps; the queues count them as the job's states
};

struct CheckAnswer
{
  /// `seconds` is the time of the whole batch. For a job with motions, only `revision` and `seconds` are set, and for a
  /// path also the verdicts of its waypoints.
  BatchResult result;
  std::vector<MotionVerdict> motions;  ///< for a job with motions: how far each motion is valid
  std::uint64_t states_checked = 0;
  std::shared_ptr<const PlanningScene> scene;  ///< the checked scene, with the job's matrix
  std::optional<SceneReport> report;
  std::vector<double> states;  ///< rows of all variables, if CheckJob::keep_states is set
  std::string device;          ///< the device that checked the states
};

/// Counts since the start, and the lengths of the queues now.
struct CheckStatistics
{
  std::uint64_t requests = 0;   ///< answered requests
  std::uint64_t batches = 0;    ///< batches of the answered requests
  std::uint64_t states = 0;     ///< checked states
  std::uint64_t undecided = 0;  ///< states that the device left undecided and the exact checker decided
  std::uint64_t busy = 0;       ///< requests that got Busy
  std::uint64_t errors = 0;     ///< requests that ended with an error
  std::size_t waiting_requests = 0;
  std::size_t waiting_states = 0;

  CheckStatistics& operator+=(const CheckStatistics& other);
};

class CheckQueue;

/// Checks states and motions for many clients at once. It has two queues, each with its own thread and checker. One
/// queue merges small requests that have the same group and matrix. The other queue answers large requests one by one.
/// So a small request never waits for a large one. A request of at most 16 states does not wait for a slow small one
/// either: it is merged only with others of its kind, and after 10 ms, another thread with its own checker answers it.
/// A motion counts as many states as it has samples. Under MotionRule::Bound, it may need more checks than samples
/// (MotionCheckerOptions::max_samples). Other small requests wait until all these checks are made. A request with a
/// large matrix or with another scene than the newest counts as large, because a checker needs much time to take over
/// such a matrix or scene. A queue takes the store's newest scene when it starts a batch. So each answer belongs to one
/// snapshot: that of the request if it has one, otherwise one that is no older than the request.
class CheckServer
{
 public:
  /// Makes the checker of the small requests immediately, and throws the errors of `make_checker`. The checker of the
  /// large requests is made when it is first needed. A checker that refuses a scene is dropped, and another one is made
  /// for the next batch. `store` must outlive the server. `make_relief` makes the checker for requests of few states
  /// that would wait for a slow batch, when a batch takes long for the first time; null: they wait.
  CheckServer(const SceneStore& store, const MakeChecker& make_checker, const CheckServerOptions& options,
              const MakeChecker& make_relief = nullptr);
  /// Calls stop().
  ~CheckServer();

  /// Throws Error if `count` is more than one request may have.
  void requireStateCount(std::size_t count) const;

  /// Throws Busy immediately if the queue is full; throws Error for too many states and for rows of the wrong length.
  /// The future gets the checker's errors, NotKnownYet if a variable is neither given nor known, and InternalError if
  /// the checker does not take the store's own scene, or no checker can be made.
  std::future<CheckAnswer> submit(CheckJob job);

  /// Unfinished requests, running motion checks, queued and later requests get ShuttingDown.
  void stop();

  CheckStatistics statistics() const;

 private:
  const SceneStore& store_;
  const CheckServerOptions options_;
  const std::size_t width_;  // variables of the robot
  std::unique_ptr<CheckQueue> small_;
  std::unique_ptr<CheckQueue> large_;
};
}  // namespace gpu_planning_scene::core
