#pragma once

#include <memory>
#include <vector>

#include "benchmark/method.h"

namespace gpu_planning_scene::core::benchmark
{
/// A peer that replaces meshes by simpler shapes and checks pair by pair.
class PairwisePeer : public Peer
{
 public:
  explicit PairwisePeer(std::shared_ptr<const CollisionProblem> problem);

  bool collides(const Eigen::Isometry3d* link_poses) override;

  /// Leaves out pairs of links as MoveIt's Setup Assistant does: pairs whose simpler shapes collide in at least 95 % of
  /// random states, and pairs whose true shapes never collide in them. Otherwise links whose simpler shapes overlap in
  /// every state would make every state a collision. This favours the peer: other methods check these pairs.
  void disableDefaultPairs(const RobotModel& robot);

 protected:
  /// Sets the state of the robot for the two functions below.
  virtual void place(const Eigen::Isometry3d* link_poses) = 0;
  /// Arguments are instances: indices into the problem's `robot` and `world`. `required`: metres.
  virtual bool collidesWithWorld(std::size_t robot, std::size_t world, double required) = 0;
  virtual bool collidesWithSelf(std::size_t first, std::size_t second) = 0;

  const CollisionProblem& problem() const { return *problem_; }

 private:
  std::shared_ptr<const CollisionProblem> problem_;
  std::vector<InstancePair> self_pairs_;
};

std::unique_ptr<PairwisePeer> makeBulletHulls(const std::shared_ptr<const CollisionProblem>& problem);
/// `count`: spheres for each shape.
std::unique_ptr<PairwisePeer> makeSpheres(const std::shared_ptr<const CollisionProblem>& problem, std::size_t count);
}  // namespace gpu_planning_scene::core::benchmark
