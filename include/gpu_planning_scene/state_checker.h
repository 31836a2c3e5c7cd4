#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// Two body indices (see PlanningScene), ascending.
using BodyPair = std::array<std::int32_t, 2>;
constexpr BodyPair kNoPair = {-1, -1};

/// What is left out of a scene because it can change no answer. Each can be switched off, which costs time alone.
struct Reductions
{
  bool reach = true;              ///< pairs that bounds on reach, from the joints' limits, prove can never meet
  bool unmoved_pairs = true;      ///< pairs that no joint moves against each other are decided once per scene
  bool shared_trees = true;       ///< equal meshes and equal primitives share one tree
  bool direct_primitives = true;  ///< the GPU tests primitives as the solids they are, not as triangles
};

struct CheckerOptions
{
  /// Metres, at least 0. Above 0, traversal ends at two nodes that overlap and whose diagonals add up to no more than
  /// this, and calls it a collision: never a false "free"; a false "collision" only of bodies that are no further apart
  /// than their required distance and this. 0: exact.
  double tolerance = 0.0;
  Reductions reductions;
};

/// How far a joint moves.
struct JointTravel
{
  double length = 0.0;  ///< metres: of prismatic joints, and the straight way of planar and floating ones
  double angle = 0.0;   ///< radians, likewise
};

/// What is to be free around the states of a batch: all states within the joints' limits in which no joint is further
/// from where it is in the state than its way.
struct JointNeighbourhood
{
  std::vector<JointTravel> travel;  ///< rows of one per joint of the robot, at least 0; a mimic joint's is its own
  std::vector<std::uint32_t> rows;  ///< one per state: which of those is its
};

struct BatchResult
{
  std::vector<std::uint8_t> valid;   ///< one per state: 1 free, 0 in collision
  std::vector<BodyPair> colliding;   ///< body indices of a colliding pair, {-1, -1} where valid
  std::uint64_t revision = 0;        ///< of the scene that was checked
  double seconds = 0.0;              ///< wall time of the check, without compiling and building
  std::size_t undecided_states = 0;  ///< how many the CPU had to settle
  double undecided_seconds = 0.0;    ///< of `seconds`, what it took to settle them
};

/// What of the scene is checked, and what is left out and why.
struct SceneReport
{
  std::size_t self_pairs = 0;          ///< checked pairs of links and what they carry
  std::size_t world_pairs = 0;         ///< checked pairs of a link, or what one carries, and an object
  std::size_t allowed_self_pairs = 0;  ///< left out: the allowed-collision matrix excludes them
  std::size_t allowed_world_pairs = 0;
  std::size_t touch_pairs = 0;              ///< left out: what a link carries, with it, its touch links, its other load
  std::size_t unmoved_pairs = 0;            ///< left out: the group moves neither body
  std::size_t links_without_shapes = 0;     ///< left out: nothing to collide with
  std::size_t unreachable_self_pairs = 0;   ///< left out: within the joints' limits the two never come near
  std::size_t unreachable_world_pairs = 0;  ///< likewise
  std::size_t unreachable_objects = 0;      ///< left out: no link comes near them
  std::size_t settled_pairs = 0;            ///< left out: decided once, as no joint moves one against the other
  /// One of those that collides, so that every state does: body indices.
  std::optional<BodyPair> always_colliding;
  std::size_t triangles = 0;     ///< in the trees
  std::size_t trees = 0;         ///< of distinct shapes
  std::size_t shared_trees = 0;  ///< shapes that use the tree of an equal one
  /// Batches of fewer states go to the CPU (the largest number: all); no value: there is no choice.
  std::optional<std::size_t> cpu_below;
};

/// Answers for many robot states at once which are free of collision. Implementations: BatchChecker (GPU) and
/// CpuChecker. Thread-safe: calls are served one after the other.
class StateChecker
{
 public:
  virtual ~StateChecker() = default;

  /// Replaces the scene. Throws Error and keeps the old one if it cannot be used.
  virtual void setScene(std::shared_ptr<const PlanningScene> scene) = 0;

  /// `states`: row-major, `count` rows of robot->variables().size() finite values. `group`: empty for all checked
  /// pairs, or a planning group: then only pairs with a link that the group moves. Throws Error for an unknown group or
  /// a value that is not finite.
  /// With `around`, valid[i] is 1 only where all that is around state i is free too, by proof: each pair is further
  /// apart than its required distance and the most that its bodies can move against each other on those ways. Where it
  /// is 0 the state itself may be free, and the pair reported may be merely near. The ways must be of joints that the
  /// group moves. A state outside the joints' limits is 0. Throws Error for rows or ways that do not fit the states.
  virtual BatchResult check(const double* states, std::size_t count, const std::string& group = "",
                            const JointNeighbourhood* around = nullptr) = 0;

  virtual SceneReport report(const std::string& group = "") = 0;

  /// What it runs on: GL_RENDERER, or "CPU".
  virtual std::string deviceName() const = 0;

  /// One line if the device's float32 arithmetic is not as the error bounds assume, so that the CPU decides every pair
  /// that comes near; else empty. Answers are right all the same.
  virtual std::string deviceWarning() const { return {}; }
};
}  // namespace gpu_planning_scene::core
