#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "binned_sah.h"
#include "collision_problem.h"
#include "forest.h"
#include "triangle_pair.h"

namespace gpu_planning_scene
{
/// Checks one state at a time in double precision on the calling thread. Meshes by simultaneous traversal of their
/// trees; a primitive is the solid that it is, with its true surface: what lies inside collides. Two solids that are
/// both cylinder or cone collide within 1e-6 m (see curved_pair.h). One mesh inside another is not detected.
class CpuTraversal
{
 public:
  using BodyPair = std::array<std::int32_t, 2>;  // body indices

  /// Work space of one thread, reused from call to call.
  struct Scratch
  {
    std::vector<Eigen::Isometry3d> poses;     // of robot geometries, in the planning frame
    std::vector<Eigen::AlignedBox3d> bounds;  // of robot geometries, in the planning frame
    std::vector<std::array<std::uint32_t, 2>> node_pairs;
    std::vector<std::uint32_t> nodes;
    std::vector<std::uint32_t> near_objects;
  };

  /// `forest` holds a valid tree for each of the problem's trees, whoever built it.
  CpuTraversal(std::shared_ptr<const CollisionProblem> problem, std::shared_ptr<const Forest> forest);

  /// The bodies of a colliding pair, if there is one. `link_poses`: of every link, in the planning frame. Thread-safe
  /// as long as each thread has its own scratch.
  std::optional<BodyPair> firstCollision(const Eigen::Isometry3d* link_poses, Scratch& scratch) const;

  /// All colliding pairs of bodies, each once.
  std::vector<BodyPair> allCollisions(const Eigen::Isometry3d* link_poses, Scratch& scratch) const;

 private:
  struct Tree
  {
    std::uint32_t root;
    Eigen::Vector3d center;  // of the root's box
    Eigen::Vector3d half;
    bool mesh;
    double sagitta;
  };

  /// Calls visit(body pair) for colliding pairs of geometries until it returns true.
  template <class Visit>
  void visitCollisions(const Eigen::Isometry3d* link_poses, Scratch& scratch, const Visit& visit) const;
  Eigen::AlignedBox3d boundsOf(std::uint32_t tree, const Eigen::Isometry3d& pose) const;
  void findNearObjects(const Eigen::AlignedBox3d& bounds, Scratch& scratch) const;
  bool shapesMeet(std::uint32_t a, const Eigen::Isometry3d& pose_a, std::uint32_t b, const Eigen::Isometry3d& pose_b,
                  Scratch& scratch) const;
  bool solidsMeet(std::uint32_t a, std::uint32_t b, const Eigen::Isometry3d& b_in_a, Scratch& scratch) const;
  bool surfaceMeetsSolid(std::uint32_t a, std::uint32_t solid, const Eigen::Isometry3d& solid_in_a,
                         Scratch& scratch) const;
  bool surfacesMeet(std::uint32_t a, std::uint32_t b, const Eigen::Isometry3d& b_in_a, double margin,
                    Scratch& scratch) const;
  bool leavesMeet(const Node& a, const Node& b, const Eigen::Isometry3d& b_in_a, double margin) const;

  std::shared_ptr<const CollisionProblem> problem_;
  std::shared_ptr<const Forest> forest_;
  std::vector<Tree> trees_;
  std::vector<Triangle> triangles_;  // in the order of the forest's leaf_triangles
  std::vector<Eigen::AlignedBox3d> world_bounds_;
  BoxTree world_tree_;
};
}  // namespace gpu_planning_scene
