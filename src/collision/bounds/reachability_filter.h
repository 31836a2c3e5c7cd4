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
/// Finds pairs of bodies that can change no answer. Keeps what it learned of the robot, of objects and of what is
/// carried for the next scene in which they are as they were.
class ReachabilityFilter
{
 public:
  /// Takes out of `pairs` those that come within their required distance in no state within the joints' limits, and
  /// counts them in `report`, as far as the group moves them. Returns the ranges of variables that this holds for; none
  /// if nothing was left out.
  std::vector<VariableRange> leaveOutUnreachable(const PlanningScene& scene, const std::vector<RobotBody>& bodies,
                                                 CheckedPairs& pairs, SceneReport& report);

 private:
  struct KnownBox
  {
    std::weak_ptr<const Mesh> mesh;  // that is gone may leave its address to another
    Eigen::AlignedBox3d box;
  };
  struct KnownObject
  {
    WorldObject object;
    std::vector<Obstacle> obstacles;  // in the planning frame
  };

  /// A link by its index, or what is carried, counted on from there.
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
  std::vector<std::optional<SweptBody>> swept_;  // of each mover
  std::vector<double> link_padding_;             // these three of the last scene, in its order
  std::vector<AttachedObject> carried_;
  std::vector<KnownObject> objects_;
  std::unordered_map<const Mesh*, KnownBox> boxes_;
  ReachabilityCache near_movers_;   // a row and a column for each mover
  ReachabilityCache near_objects_;  // a row for each object, a column for each mover
};
}  // namespace gpu_planning_scene::core
