#pragma once

#include <atomic>
#include <memory>

#include "collision/filter/robot_proofs.h"

namespace gpu_planning_scene::core
{
/// Proofs that are being made in the background. If nobody holds the job, the work is given up. Thread-safe.
class ProofJob
{
 public:
  /// Null until there are proofs. They are replaced by better ones while the work goes on.
  std::shared_ptr<const RobotProofs> proofs() const { return std::atomic_load(&proofs_); }

 private:
  friend class ProofWorker;
  std::shared_ptr<const RobotProofs> proofs_;
};

/// Asks the process's worker thread for the proofs of a problem. The worker knows the proofs of all robots that are in
/// use, so checkers with the same robot share them, and proofs of a known robot take milliseconds.
std::shared_ptr<ProofJob> proveInBackground(std::shared_ptr<const RobotModel> robot,
                                            std::shared_ptr<const CollisionProblem> problem,
                                            std::shared_ptr<const CpuForest> forest);

/// Waits until no proof is being made. For measurements and tests.
void waitForProofs();
}  // namespace gpu_planning_scene::core
