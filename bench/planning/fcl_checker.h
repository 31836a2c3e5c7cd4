#pragma once

#include <memory>
#include <string>

#include "collision/bounds/displacement_bounds.h"
#include "gpu_planning_scene/state_checker.h"
#include "support/fcl_peer.h"

namespace gpu_planning_scene::core::benchmark
{
/// FCL, state by state on the calling thread, where a planner expects one of our checkers: what a user of FCL would
/// write. Margins are decided by FCL's distances. It is made for one scene and one group. Not thread-safe.
class FclChecker : public StateChecker
{
 public:
  FclChecker(std::shared_ptr<const PlanningScene> scene, const std::string& group);

  /// Throws std::logic_error: it has its scene.
  void setScene(std::shared_ptr<const PlanningScene> scene) override;
  /// `group` must be the one it was made for.
  BatchResult check(const double* states, std::size_t count, const std::string& group,
                    const JointNeighbourhood* around) override;
  /// What is checked is not counted.
  SceneReport report(const std::string& group) override;
  std::string deviceName() const override { return "FCL"; }

 private:
  std::shared_ptr<const PlanningScene> scene_;
  std::string group_;
  std::shared_ptr<const CollisionProblem> problem_;
  DisplacementBounds displacements_;
  FclPeer fcl_;
  FclPeer near_;  // with an order of its own for states with margins
};
}  // namespace gpu_planning_scene::core::benchmark
