#pragma once

#include <memory>
#include <string>
#include <vector>

#include <moveit/collision_detection/collision_env.h>

#include "moveit/shapes/robot_geometry.h"
#include "moveit/shapes/world_geometry.h"

namespace gpu_planning_scene::detector
{
/// MoveIt's interface to the exact tests. Const functions may be called by several threads at once, as long as no other
/// function is called.
class CollisionEnv : public collision_detection::CollisionEnv
{
 public:
  explicit CollisionEnv(const moveit::core::RobotModelConstPtr& model, double padding = 0.0, double scale = 1.0);
  CollisionEnv(const moveit::core::RobotModelConstPtr& model, const collision_detection::WorldPtr& world,
               double padding = 0.0, double scale = 1.0);
  /// `world` must have the same content as the world of `other`. Both share all geometry until one of them changes.
  CollisionEnv(const CollisionEnv& other, const collision_detection::WorldPtr& world);
  CollisionEnv(const CollisionEnv&) = delete;
  CollisionEnv& operator=(const CollisionEnv&) = delete;
  ~CollisionEnv() override;

  void checkSelfCollision(const collision_detection::CollisionRequest& request,
                          collision_detection::CollisionResult& result,
                          const moveit::core::RobotState& state) const override;
  void checkSelfCollision(const collision_detection::CollisionRequest& request,
                          collision_detection::CollisionResult& result, const moveit::core::RobotState& state,
                          const collision_detection::AllowedCollisionMatrix& matrix) const override;
  void checkRobotCollision(const collision_detection::CollisionRequest& request,
                           collision_detection::CollisionResult& result,
                           const moveit::core::RobotState& state) const override;
  void checkRobotCollision(const collision_detection::CollisionRequest& request,
                           collision_detection::CollisionResult& result, const moveit::core::RobotState& state,
                           const collision_detection::AllowedCollisionMatrix& matrix) const override;
  /// Checks the motion between two states: see continuous_check.h.
  void checkRobotCollision(const collision_detection::CollisionRequest& request,
                           collision_detection::CollisionResult& result, const moveit::core::RobotState& from,
                           const moveit::core::RobotState& to,
                           const collision_detection::AllowedCollisionMatrix& matrix) const override;
  void checkRobotCollision(const collision_detection::CollisionRequest& request,
                           collision_detection::CollisionResult& result, const moveit::core::RobotState& from,
                           const moveit::core::RobotState& to) const override;

  void distanceSelf(const collision_detection::DistanceRequest& request, collision_detection::DistanceResult& result,
                    const moveit::core::RobotState& state) const override;
  void distanceRobot(const collision_detection::DistanceRequest& request, collision_detection::DistanceResult& result,
                     const moveit::core::RobotState& state) const override;

  void setWorld(const collision_detection::WorldPtr& world) override;

 protected:
  void updatedPaddingOrScaling(const std::vector<std::string>& links) override;

 private:
  using Matrix = collision_detection::AllowedCollisionMatrix;

  void checkSelf(const collision_detection::CollisionRequest& request, collision_detection::CollisionResult& result,
                 const moveit::core::RobotState& state, const Matrix* matrix) const;
  void checkRobot(const collision_detection::CollisionRequest& request, collision_detection::CollisionResult& result,
                  const moveit::core::RobotState& state, const Matrix* matrix) const;
  void checkMotion(const collision_detection::CollisionRequest& request, collision_detection::CollisionResult& result,
                   const moveit::core::RobotState& from, const moveit::core::RobotState& to,
                   const Matrix* matrix) const;
  void observeWorld();
  WorldGeometry& changedWorld();

  std::shared_ptr<const RobotGeometry> robot_;
  std::shared_ptr<WorldGeometry> world_;  // shared with copies of this environment; see changedWorld
  collision_detection::World::ObserverHandle observer_;
};
}  // namespace gpu_planning_scene::detector
