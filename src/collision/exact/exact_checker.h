#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/cpu_shape_pair.h"
#include "collision/problem/collision_problem.h"
#include "collision/trees/cpu_forest.h"
#include "collision/trees/forest.h"
#include "collision/trees/object_tree.h"

namespace gpu_planning_scene::core
{
/// The exact checker. It decides one state at a time on the calling thread, in double precision, and in higher
/// precision if double cannot decide. Its verdicts follow kSlack (triangle_pair.h).
class ExactChecker
{
 public:
  /// Work space of one thread, reused from call to call. It records how often each check found a collision and its
  /// cost. Later states begin with the checks that find the most collisions for their cost. The order affects only
  /// which of several colliding pairs is found.
  struct Scratch
  {
    std::vector<std::uint32_t> order;         // order of the checks, see check
    std::vector<double> hits;                 // collisions found by each check
    std::vector<double> cost;                 // cost of each check: visited nodes, plus 1 for each call
    std::uint64_t states = 0;                 // states checked so far
    std::vector<std::uint8_t> placed;         // 1: the pose and the bounds of this robot instance are set
    std::vector<Eigen::Isometry3d> poses;     // in the planning frame
    std::vector<Eigen::AlignedBox3d> bounds;  // in the planning frame
    std::vector<std::uint32_t> near_objects;
    CpuShapePair::Scratch pair;
  };

  /// `forest` must hold a valid tree for each of the problem's trees. It may come from any builder.
  ExactChecker(std::shared_ptr<const CollisionProblem> problem, std::shared_ptr<const Forest> forest);

  /// The same for a forest that was made for another problem with the same trees. If `objects` is not null, it must
  /// have been made for the same world, see worldBounds.
  ExactChecker(std::shared_ptr<const CollisionProblem> problem, std::shared_ptr<const CpuForest> forest,
               std::shared_ptr<const ObjectTree> objects = nullptr);

  /// The bodies of a colliding pair, if there is one. `link_poses` holds the pose of each link in the planning frame.
  /// `margins` (see DisplacementBounds) holds the additional distance that is required: for each robot instance from
  /// the world, then for each self pair. Null means no margins. Thread-safe if each thread has its own scratch.
  std::optional<BodyPair> firstCollision(const Eigen::Isometry3d* link_poses, Scratch& scratch,
                                         const double* margins = nullptr) const;

  /// A pair, and the distance that it must keep in addition to its required distance.
  struct OpenPair
  {
    InstancePair instances;
    double margin;
  };

  /// The bodies of the first of `count` pairs that collides, if one does. The pairs are tested in the given order,
  /// without a broad phase. `steps` is set to the cost of each tested pair; the last tested pair is the one that
  /// collides, if one does.
  std::optional<BodyPair> firstCollisionOf(const OpenPair* pairs, std::size_t count,
                                           const Eigen::Isometry3d* link_poses, Scratch& scratch,
                                           std::vector<std::uint64_t>& steps) const;

  /// All colliding pairs of bodies, each once.
  std::vector<BodyPair> allCollisions(const Eigen::Isometry3d* link_poses, Scratch& scratch) const;

  /// All colliding pairs of instances, each once, without pairs that collide in every state. The scratch then has the
  /// poses of all instances that are in a pair.
  std::vector<InstancePair> collidingInstances(const Eigen::Isometry3d* link_poses, Scratch& scratch) const;

 private:
  /// Whether a pair collides whose robot instances are placed. `margin`: in addition to the required distance.
  bool collides(const InstancePair& pair, double margin, Scratch& scratch) const;
  /// A check tests one robot instance against the world, or one self pair. The first numbers are the robot instances;
  /// the self pairs follow. Calls visit(instance pair) for each collision until it returns true. Returns whether visit
  /// returned true.
  template <class Visit>
  bool check(std::uint32_t number, const Eigen::Isometry3d* link_poses, double margin, Scratch& scratch,
             const Visit& visit) const;
  template <class Visit>
  bool checkWorld(std::uint32_t instance, double margin, Scratch& scratch, const Visit& visit) const;
  void startState(Scratch& scratch) const;
  static void learnOrder(Scratch& scratch);
  void place(std::uint32_t instance, const Eigen::Isometry3d* link_poses, Scratch& scratch) const;
  void findNearObjects(const Eigen::AlignedBox3d& bounds, Scratch& scratch) const;

  std::shared_ptr<const CollisionProblem> problem_;
  std::shared_ptr<const CpuForest> forest_;
  CpuShapePair pair_;
  std::shared_ptr<const ObjectTree> objects_;
};

/// The body of an instance; the index counts as in the second index of InstancePair.
std::int32_t bodyOf(const CollisionProblem& problem, std::size_t instance);

/// The bodies of a pair of instances.
BodyPair bodiesOf(const CollisionProblem& problem, const InstancePair& pair);

/// The boxes of the world's instances, grown by their padding. ObjectTree is built over them.
std::vector<Eigen::AlignedBox3d> worldBounds(const CollisionProblem& problem, const CpuForest& forest);
}  // namespace gpu_planning_scene::core
