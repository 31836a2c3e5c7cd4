#pragma once

#include <array>
#include <memory>
#include <vector>

#include "benchmark/method.h"

namespace gpu_planning_scene::core::benchmark
{
/// A peer that puts simpler shapes in the place of meshes, and looks at pair by pair.
class PairwisePeer : public Peer
{
 public:
  explicit PairwisePeer(std::shared_ptr<const CollisionProblem> problem);

  bool collides(const Eigen::Isometry3d* link_poses) override;

  /// Links whose simpler shapes overlap whatever the joints would make every state a collision. So pairs of links are
  /// left out as MoveIt's Setup Assistant leaves them out: those whose shapes collide in 95 % of random states, and
  /// those that truly never do. In favour of the peer: the others look at these pairs.
  void leaveOutPairs(const RobotModel& robot);

 protected:
  /// What follows is about the robot there.
  virtual void place(const Eigen::Isometry3d* link_poses) = 0;
  /// Of instances: indices into the problem's `robot` and `world`.
  virtual bool meetsWorld(std::size_t robot, std::size_t world, double required) = 0;
  virtual bool meetsSelf(std::size_t first, std::size_t second) = 0;

  const CollisionProblem& problem() const { return *problem_; }

 private:
  std::shared_ptr<const CollisionProblem> problem_;
  std::vector<std::array<std::uint32_t, 2>> self_pairs_;
};

std::unique_ptr<PairwisePeer> makeBulletHulls(const std::shared_ptr<const CollisionProblem>& problem);
/// `count`: spheres for each shape.
std::unique_ptr<PairwisePeer> makeSpheres(const std::shared_ptr<const CollisionProblem>& problem, std::size_t count);
}  // namespace gpu_planning_scene::core::benchmark
