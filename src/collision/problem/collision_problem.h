#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "collision/problem/checked_pairs.h"
#include "collision/problem/tessellation_cache.h"
#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// An instance of a tree: one shape of a body.
struct ShapeInstance
{
  std::uint32_t tree;      ///< index into CollisionProblem::tessellations
  std::int32_t body;       ///< body index of the planning scene
  std::int32_t link;       ///< robot: the link that the instance moves with (also for attached objects); world: -1
  Eigen::Isometry3d pose;  ///< robot: in the link's frame; world: in the planning frame
  double padding = 0.0;    ///< metres; a robot and a world instance collide up to the sum of their paddings
};

/// The pose of a robot's instance in the planning frame. All exact checks use this product, so that a pair has the same
/// verdict in each of them.
inline Eigen::Isometry3d placed(const ShapeInstance& instance, const Eigen::Isometry3d* link_poses)
{
  // Eigen vectorises products of 4x4 matrices. The last rows are exactly 0 0 0 1.
  Eigen::Isometry3d pose;
  pose.matrix().noalias() = link_poses[instance.link].matrix() * instance.pose.matrix();
  return pose;
}

/// A half-space of the world, in the planning frame: all points x with normal . x <= offset.
struct WorldHalfSpace
{
  std::int32_t body;
  Eigen::Vector3d normal;
  double offset;         ///< metres
  double padding = 0.0;  ///< metres
};

struct VariableRange
{
  int variable;
  double lower;
  double upper;
};

/// The index of a robot instance, and the index of a second instance. The second index counts the robot's instances,
/// then the world's, then the half-spaces.
using InstancePair = std::array<std::uint32_t, 2>;

/// The collision problem of a scene: shape instances, their trees, and the pairs of instances that are checked. A
/// problem contains no joints, names or allowed collision matrix. Two rigid meshes with a relative pose are a problem
/// too.
struct CollisionProblem
{
  std::vector<Tessellation> tessellations;  ///< distinct shapes; instances share them
  std::vector<Shape> shapes;                ///< the exact shape of each tree
  std::vector<ShapeInstance> robot;         ///< instances that move with their link
  std::vector<ShapeInstance> world;         ///< instances that are fixed in the planning frame
  std::vector<InstancePair> self_pairs;     ///< pairs of two robot instances
  std::vector<std::uint8_t> world_pairs;    ///< robot.size() x world.size(), row-major; 1: the pair is checked
  std::vector<WorldHalfSpace> half_spaces;
  std::vector<std::uint8_t> half_space_pairs;  ///< robot.size() x half_spaces.size(), row-major
  /// Whether the GPU may test primitives as solids: see Reductions.
  bool direct_primitives = true;
  /// If a pair of bodies collides in every state: this pair, in ascending order. The lists of pairs above do not
  /// contain it.
  std::optional<BodyPair> always_colliding;
  /// If a variable of a state is outside its range here, pairs that are not in the problem may collide. Empty if no
  /// pair was left out because of joint limits.
  std::vector<VariableRange> ranges;
  /// Origin of the GPU's coordinates, in the planning frame. It is near the robot, where float32 has a fine resolution.
  /// It changes no verdict.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
};

/// Metres: the required distance of a pair of instances (see StateChecker). Two instances of the robot have none.
double requiredDistance(const CollisionProblem& problem, const InstancePair& pair);

/// Transforms a half-space by `pose`. The normal is normalised again, because the rotation of a pose is orthonormal
/// only up to rounding.
HalfSpace moved(const HalfSpace& half_space, const Eigen::Isometry3d& pose);

/// Whether two shapes can share a tree: the same mesh, or primitives of the same kind and dimensions.
bool sameShape(const Shape& a, const Shape& b);

/// The number of pairs of instances: those of two robot instances that are checked, and all of a robot instance with an
/// instance or a half-space of the world.
inline std::size_t instancePairs(const CollisionProblem& problem)
{
  return problem.self_pairs.size() + problem.robot.size() * (problem.world.size() + problem.half_spaces.size());
}

bool withinRanges(const std::vector<VariableRange>& ranges, const double* state);

/// Whether the problem contains every pair that can collide in this state, see CollisionProblem::ranges.
inline bool isValidFor(const CollisionProblem& problem, const double* state)
{
  return withinRanges(problem.ranges, state);
}

/// Makes the collision problem of `pairs`. validateScene must have accepted the scene. The problem has all bodies of
/// `pairs`, but only those instance pairs that the group moves. So trees and instances do not depend on the group, and
/// one forest serves all groups.
CollisionProblem problemOf(const PlanningScene& scene, const std::vector<RobotBody>& bodies, const CheckedPairs& pairs,
                           bool share_trees, TessellationCache& tessellations);
}  // namespace gpu_planning_scene::core
