#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "collision/filter/proofs/robot_proofs.h"
#include "collision/problem/collision_problem.h"

namespace gpu_planning_scene::core
{
/// Decides whether a batch goes to the CPU or to the GPU. Small batches are faster on the CPU. Batches of at least a
/// threshold go to the GPU. The threshold is fixed, or it is measured for each group with both checks and kept for a
/// while. One caller at a time.
///
/// Two other reasons for the CPU: BatchChecker sends it the single states for which the problem is not valid, and
/// ResilientChecker all batches while the device is lost.
class CpuOrGpu
{
 public:
  /// Checks `count` states (rows of the robot's variables).
  using Check = std::function<void(const double* states, std::size_t count)>;
  struct Checks
  {
    Check cpu;
    Check gpu;
  };

  struct Choice
  {
    bool is_for_cpu;
    /// Batches of at least this many states go to the GPU. No value: every state collides, so no batch does.
    std::optional<std::size_t> threshold;
  };

  /// fixed: the threshold of all groups; unset: the threshold is measured.
  explicit CpuOrGpu(std::optional<std::size_t> fixed) : fixed_(fixed) {}

  /// `states`: the batch. A measurement uses these states if there are enough of them, else random states. `proofs`:
  /// the proofs that the CPU's check has. If it has more than at the last measurement, the CPU has become faster, and
  /// the threshold is measured again.
  Choice choose(const std::string& group, const std::shared_ptr<const PlanningScene>& scene,
                const CollisionProblem& problem, const double* states, std::size_t count, ProofStage proofs,
                const Checks& checks);

  /// Forgets all measurements. A new robot may have groups of the same names.
  void forget() { thresholds_.clear(); }

 private:
  struct Threshold
  {
    std::size_t states;
    std::weak_ptr<const PlanningScene> scene;  // scene for which it was measured
    std::size_t pairs;                         // instance pairs of this scene
    std::chrono::steady_clock::time_point measured_at;
    double seconds;  // the duration of the measurement
    ProofStage proofs;
    bool by_own_states;  // measured with the caller's states instead of random ones

    bool holdsFor(const std::shared_ptr<const PlanningScene>& other, std::size_t other_pairs) const;
  };

  std::size_t threshold(const std::string& group, const std::shared_ptr<const PlanningScene>& scene,
                        const CollisionProblem& problem, const double* states, std::size_t count, ProofStage proofs,
                        const Checks& checks);

  std::optional<std::size_t> fixed_;
  std::map<std::string, Threshold> thresholds_;
};

/// A batch size that no batch reaches.
constexpr std::size_t kNoBatch = std::numeric_limits<std::size_t>::max();

/// Does work of a given size and returns its duration in seconds.
using TimedWork = std::function<double(std::size_t)>;

/// The size above which `bulk`, which has a high fixed cost, is clearly faster (1.2 times) than `direct`. kNoBatch if
/// bulk does not seem to become faster. Both are timed at growing sizes up to kMaxTimed. This takes some tens of
/// milliseconds, or longer if a few items alone take longer.
std::size_t breakEven(const TimedWork& direct, const TimedWork& bulk);
constexpr std::size_t kMaxTimed = 1024;
}  // namespace gpu_planning_scene::core
