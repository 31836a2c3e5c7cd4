#pragma once

#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "collision/bounds/reach.h"
#include "collision/bounds/reachability_cache.h"
#include "collision/problem/checked_pairs.h"

namespace gpu_planning_scene::core
{
/// Leaves out pairs of bodies that can never collide within the joints' limits. Results for the robot, the objects and
/// the attached objects are kept for the next scene, as far as these have not changed.
class ReachabilityFilter
{
 public:
  /// Removes from `pairs` each pair that stays beyond its required distance in all states within the joints' limits.
  /// Counts the removed pairs that the group moves in `report`. Returns the ranges of variables for which the removal
  /// is valid; empty if no pair was removed.
  std::vector<VariableRange> leaveOutUnreachable(const PlanningScene& scene, const std::vector<RobotBody>& bodies,
                                                 CheckedPairs& pairs, SceneReport& report);

 private:
  struct KnownBox
  {
    std::weak_ptr<const Mesh> mesh;  // weak, because another mesh may reuse the address of a deleted one
    Eigen::AlignedBox3d box;
  };
  struct KnownObject
  {
    WorldObject object;
    std::vector<Obstacle> obstacles;  // shapes of the object, in the planning frame
  };

  /// The mover number of a body: a link's index; attached objects are numbered after the links.
  std::size_t moverOf(const PlanningScene& scene, const RobotBody& body) const;
  const SweptBody& sweptBody(const RobotBody& body, std::size_t mover);
  bool mayMeet(const PlanningScene& scene, const RobotBody& body, std::size_t mover, std::size_t object);
  void takeRobot(const std::shared_ptr<const RobotModel>& robot);
  void keepWhatStays(const PlanningScene& scene);
  void keepCarried(const PlanningScene& scene);
  void keepObjects(const PlanningScene& scene);
  Eigen::AlignedBox3d cachedBox(const Shape& shape);
  std::vector<Obstacle> obstaclesOf(const WorldObject& object);

  std::shared_ptr<const RobotModel> robot_;
  std::optional<Reach> reach_;
  std::vector<std::optional<SweptBody>> swept_;  // swept body of each mover
  std::vector<double> link_padding_;             // of the last scene, as are carried_ and objects_
  std::vector<AttachedObject> carried_;
  std::vector<KnownObject> objects_;
  std::unordered_map<const Mesh*, KnownBox> boxes_;
  ReachabilityCache near_movers_;   // a row and a column for each mover
  ReachabilityCache near_objects_;  // a row for each object, a column for each mover
};
}  // namespace gpu_planning_scene::core
