#pragma once

#include <memory>
#include <string>

#include "collision/bounds/displacement_bounds.h"
#include "gpu_planning_scene/state_checker.h"
#include "support/fcl_peer.h"

namespace gpu_planning_scene::core::benchmark
{
/// FCL behind the interface of our checkers, so a planner can use it. It checks state by state on the calling thread,
/// as a typical user of FCL would. Margins are tested with FCL's distances. A checker serves one scene and one group.
/// Not thread-safe.
class FclChecker : public StateChecker
{
 public:
  FclChecker(std::shared_ptr<const PlanningScene> scene, const std::string& group);

  /// Throws std::logic_error: the scene cannot be replaced.
  void setScene(std::shared_ptr<const PlanningScene> scene) override;
  /// Throws std::logic_error if the batch does not have the group of the constructor.
  BatchResult checkBatch(const StateBatch& batch) override;
  /// Returns an empty report.
  SceneReport report(const std::string& group) override;
  std::string deviceName() const override { return "FCL"; }

 private:
  std::shared_ptr<const PlanningScene> scene_;
  std::string group_;
  std::shared_ptr<const CollisionProblem> problem_;
  JointLevers levers_;
  DisplacementBounds displacements_;
  FclPeer fcl_;
  FclPeer near_;  // for states with margins; learns its own order of pairs
};
}  // namespace gpu_planning_scene::core::benchmark
