#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/cpu_forest.h"
#include "collision/exact/cpu_shape_pair.h"
#include "collision/exact/forest.h"
#include "collision/exact/object_tree.h"
#include "collision/problem/collision_problem.h"

namespace gpu_planning_scene::core
{
/// The exact checker: one state at a time in double precision on the calling thread, in higher precision where double
/// cannot decide. Its answers are the canonical ones, see CpuShapePair.
class CpuTraversal
{
 public:
  /// An index of a robot's instance, and one into the robot's, then the world's, then the half-spaces.
  using InstancePair = std::array<std::uint32_t, 2>;

  /// Work space of one thread, reused from call to call. Keeps how often each check found a collision and what it cost,
  /// so that the next state begins with those that find most for their cost: the order changes no answer but which of
  /// several colliding pairs is found.
  struct Scratch
  {
    std::vector<std::uint32_t> order;         // of checks, see check
    std::vector<double> hits;                 // of each check
    std::vector<double> cost;                 // of each check, in all: nodes looked at, and one each time
    std::uint64_t states = 0;                 // so far
    std::vector<std::uint8_t> placed;         // the instances of which these are known:
    std::vector<Eigen::Isometry3d> poses;     // in the planning frame
    std::vector<Eigen::AlignedBox3d> bounds;  // in the planning frame
    std::vector<std::uint32_t> near_objects;
    CpuShapePair::Scratch pair;
  };

  /// `forest` holds a valid tree for each of the problem's trees, whoever built it.
  CpuTraversal(std::shared_ptr<const CollisionProblem> problem, std::shared_ptr<const Forest> forest);

  /// The same with what was made ready for a problem with the same trees and, where `objects` is not null, with the
  /// same world, see worldBounds.
  CpuTraversal(std::shared_ptr<const CollisionProblem> problem, std::shared_ptr<const CpuForest> forest,
               std::shared_ptr<const ObjectTree> objects = nullptr);

  /// The bodies of a colliding pair, if there is one. `link_poses`: of every link, in the planning frame. Thread-safe
  /// as long as each thread has its own scratch. `margins`: by how much more than its required distance each robot
  /// instance has to be away from the world, then each self pair from one another (see DisplacementBounds); null: by
  /// none.
  std::optional<BodyPair> firstCollision(const Eigen::Isometry3d* link_poses, Scratch& scratch,
                                         const double* margins = nullptr) const;

  /// All colliding pairs of bodies, each once.
  std::vector<BodyPair> allCollisions(const Eigen::Isometry3d* link_poses, Scratch& scratch) const;

  /// All colliding pairs of instances, each once; those that collide in every state are not among them. Leaves the
  /// poses of all instances that are in a pair in the scratch.
  std::vector<InstancePair> collidingInstances(const Eigen::Isometry3d* link_poses, Scratch& scratch) const;

 private:
  /// A check is one of a robot instance against the world, by its index, or, counted on from there, one of a self pair.
  /// Calls visit(instance pair) for what collides until it returns true, and returns whether it did.
  template <class Visit>
  bool check(std::uint32_t number, const Eigen::Isometry3d* link_poses, double margin, Scratch& scratch,
             const Visit& visit) const;
  template <class Visit>
  bool checkWorld(std::uint32_t instance, double margin, Scratch& scratch, const Visit& visit) const;
  BodyPair bodiesOf(const InstancePair& pair) const;
  void startState(Scratch& scratch) const;
  static void learnOrder(Scratch& scratch);
  void place(std::uint32_t instance, const Eigen::Isometry3d* link_poses, Scratch& scratch) const;
  void findNearObjects(const Eigen::AlignedBox3d& bounds, Scratch& scratch) const;

  std::shared_ptr<const CollisionProblem> problem_;
  std::shared_ptr<const CpuForest> forest_;
  CpuShapePair pair_;
  std::shared_ptr<const ObjectTree> objects_;
};

/// The body of an instance, by its index as in CpuTraversal::InstancePair.
std::int32_t bodyOf(const CollisionProblem& problem, std::size_t instance);

/// The boxes of the world's instances, grown by their padding: what the tree over objects is made of.
std::vector<Eigen::AlignedBox3d> worldBounds(const CollisionProblem& problem, const CpuForest& forest);
}  // namespace gpu_planning_scene::core
