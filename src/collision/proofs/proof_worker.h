#pragma once

#include <atomic>
#include <memory>

#include "collision/proofs/robot_proofs.h"

namespace gpu_planning_scene::core
{
/// Proofs that are being loaded or made in the background. The work ends early if nobody holds the job any more.
/// Thread-safe.
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
/// use, so checkers with the same robot share them, and proofs of a known robot take milliseconds. Proofs are kept in
/// the user's cache folder, see ProofCache.
std::shared_ptr<ProofJob> proveInBackground(std::shared_ptr<const RobotModel> robot,
                                            std::shared_ptr<const CollisionProblem> problem,
                                            std::shared_ptr<const CpuForest> forest);

/// Asks for the proofs of a problem if all of them are known or in the user's cache folder. None are made: if one is
/// missing, the job never has proofs. Takes milliseconds.
std::shared_ptr<ProofJob> loadProofsInBackground(std::shared_ptr<const RobotModel> robot,
                                                 std::shared_ptr<const CollisionProblem> problem,
                                                 std::shared_ptr<const CpuForest> forest);

/// Waits until no proof is being loaded or made. For measurements and tests.
void waitForProofs();
}  // namespace gpu_planning_scene::core
