#pragma once

#include <array>
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

  /// Which links may come near an object, by their index; no value: not asked for yet. It holds as long as the object
  /// stays as it was, and the links' padding.
  struct NearObject
  {
    WorldObject object;
    std::vector<std::optional<bool>> links;
  };

  const SweptBody& sweptBody(const RobotBody& body);
  bool mayMeet(const RobotBody& a, const RobotBody& b);
  bool mayMeet(const PlanningScene& scene, const RobotBody& body, std::size_t object,
               const std::vector<Obstacle>& obstacles);
  void keepWhatStays(const PlanningScene& scene);
  Eigen::AlignedBox3d cachedBox(const Shape& shape, MeshBoxes& used);
  std::vector<std::vector<Obstacle>> obstaclesOf(const PlanningScene& scene);

  std::shared_ptr<const RobotModel> robot_;
  std::optional<Reach> reach_;
  std::map<int, SweptBody> links_;
  std::map<const AttachedObject*, SweptBody> carried_;  // of one scene only
  MeshBoxes boxes_;                                     // of the last scene's meshes
  std::map<std::array<int, 2>, bool> near_links_;       // whether two links may meet
  std::vector<double> link_padding_;
  std::vector<NearObject> near_objects_;  // of the last scene, in its order
};
}  // namespace gpu_planning_scene
