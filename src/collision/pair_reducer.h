#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "collision/checked_pairs.h"
#include "collision/reach.h"

namespace gpu_planning_scene
{
/// Finds pairs of bodies that can change no answer. Keeps what it learned of a robot for the next scene with it.
class PairReducer
{
 public:
  /// Takes out of `pairs` those that come within their required distance in no state within the joints' limits, and
  /// counts them in `report`, as far as the group moves them. Returns the ranges of variables that this holds for; none
  /// if nothing was left out.
  std::vector<VariableRange> leaveOutUnreachable(const PlanningScene& scene, const std::vector<RobotBody>& bodies,
                                                 CheckedPairs& pairs, SceneReport& report);

 private:
  using MeshBoxes = std::map<std::shared_ptr<const Mesh>, Eigen::AlignedBox3d>;

  const SweptBody& sweptBody(const RobotBody& body);
  Eigen::AlignedBox3d cachedBox(const Shape& shape, MeshBoxes& used);
  std::vector<std::vector<Obstacle>> obstaclesOf(const PlanningScene& scene);

  std::shared_ptr<const RobotModel> robot_;
  std::optional<Reach> reach_;
  std::map<int, SweptBody> links_;
  std::map<const AttachedObject*, SweptBody> carried_;  // of one scene only
  MeshBoxes boxes_;                                     // of the last scene's meshes
};
}  // namespace gpu_planning_scene
