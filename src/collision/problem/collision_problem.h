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
  std::uint32_t tree;      ///< index into CollisionProblem::trees
  std::int32_t body;       ///< body index of the planning scene
  std::int32_t link;       ///< robot: the link that it moves with (a carried object's body is not a link); world: -1
  Eigen::Isometry3d pose;  ///< robot: in the link's frame; world: in the planning frame
  double padding = 0.0;    ///< metres; a robot and a world instance collide at distances up to the sum
};

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

/// A scene as the checkers see it: instances of trees and the pairs of them that are checked. It knows nothing of
/// joints, names or matrices. Two rigid meshes and their relative poses are such a problem as well.
struct CollisionProblem
{
  std::vector<Tessellation> trees;                       ///< distinct shapes; instances share them
  std::vector<Shape> shapes;                             ///< the true shape of each tree
  std::vector<ShapeInstance> robot;                      ///< move with their link
  std::vector<ShapeInstance> world;                      ///< fixed in the planning frame
  std::vector<std::array<std::uint32_t, 2>> self_pairs;  ///< indices into `robot`
  std::vector<std::uint8_t> world_pairs;  ///< robot.size() x world.size(), row-major; 1 where the pair is checked
  std::vector<WorldHalfSpace> half_spaces;
  std::vector<std::uint8_t> half_space_pairs;  ///< robot.size() x half_spaces.size(), row-major
  /// Metres: see CheckerOptions.
  double tolerance = 0.0;
  /// Whether the GPU may test primitives as solids: see Reductions.
  bool direct_primitives = true;
  /// Bodies, ascending, that collide in every state, if there are any; they are in none of the pairs above.
  std::optional<BodyPair> always_colliding;
  /// Where a variable of a state is out of its range, pairs that are not in the problem may collide. Empty where
  /// nothing was left out for that.
  std::vector<VariableRange> ranges;
  /// What GPU coordinates are relative to, in the planning frame: near the robot, so that floats are fine there.
  /// Changes no answer.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
};

/// The half-space that `half_space` becomes where its frame is at `pose`. The normal is made a unit again: a pose's
/// rotation is one but for rounding.
HalfSpace moved(const HalfSpace& half_space, const Eigen::Isometry3d& pose);

/// Whether two shapes can share a tree: the same mesh, or primitives of the same kind and dimensions.
bool sameShape(const Shape& a, const Shape& b);

bool withinRanges(const std::vector<VariableRange>& ranges, const double* state);

/// Whether the problem has all that can collide in a state, see CollisionProblem::ranges.
inline bool holdsFor(const CollisionProblem& problem, const double* state)
{
  return withinRanges(problem.ranges, state);
}

/// Throws Error unless it is finite and at least 0.
void validateTolerance(double tolerance);

/// The problem of some pairs of bodies of a scene that validateScene has seen; the pairs of instances are those that
/// the group moves. Bodies that are in none of `pairs` are left out. Trees and instances do not depend on the group, so
/// one forest serves all groups.
CollisionProblem problemOf(const PlanningScene& scene, const std::vector<RobotBody>& bodies, const CheckedPairs& pairs,
                           bool share_trees, TessellationCache& tessellations);
}  // namespace gpu_planning_scene::core
