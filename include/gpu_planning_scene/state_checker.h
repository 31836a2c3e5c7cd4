#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// Two body indices (see PlanningScene), in ascending order.
using BodyPair = std::array<std::int32_t, 2>;
constexpr BodyPair kNoPair = {-1, -1};

/// Reductions leave out work that cannot change any answer. Switching one off costs only time.
struct Reductions
{
  bool reach = true;              ///< pairs that can never meet, as proven by bounds on reach from the joint limits
  bool rigid_pairs = true;        ///< pairs that no joint moves relative to each other are decided once per scene
  bool shared_trees = true;       ///< equal meshes and equal primitives share a tree
  bool direct_primitives = true;  ///< the GPU tests primitives as solids, not as triangles
  /// The CPU decides most states of large batches by proofs. A proof is data about the robot from which a verdict
  /// follows without tests of triangles: balls that enclose and fill the shapes of the links, and tables with the
  /// verdict of a pair of links for ranges of joint values. A background thread makes the proofs once for each robot,
  /// in seconds to a minute on all cores, and keeps them on disk.
  bool proofs = true;

  /// All switched off.
  static Reductions none() { return {false, false, false, false, false}; }
};

struct CheckerOptions
{
  Reductions reductions;
};

/// Displacement of a joint between two states.
struct JointTravel
{
  double length = 0.0;  ///< metres: translation (prismatic, planar and floating joints)
  double angle = 0.0;   ///< radians: rotation (revolute, continuous, planar and floating joints)
};

/// Neighbourhoods of the states of a batch. The neighbourhood of a state: all states within the joint limits in which
/// no joint differs by more than its travel.
struct JointNeighbourhood
{
  std::vector<JointTravel> travel;  ///< rows of one entry (>= 0) per joint of the robot, mimic joints included
  std::vector<std::uint32_t> rows;  ///< one per state: the row of `travel` for the state
  /// Empty, or one state for each row of `travel`, near the states with this row. Then more neighbourhoods can be
  /// proven free, because it shows how far the robot's bodies are from the joints' axes.
  std::vector<double> centers = {};
  /// In the states of a row, no joint differs from the row's centre by more than this number times its travel. This is
  /// not verified: with a wrong centre, answers are wrong.
  double spread = 0.0;
};

/// A batch of states to check.
struct StateBatch
{
  const double* states;  ///< row-major, `count` rows of robot->variables().size() values
  std::size_t count;
  std::string group = {};                      ///< see StateChecker::check
  const JointNeighbourhood* around = nullptr;  ///< see StateChecker::check
  /// In batches of more than a few hundred states, called on the caller's thread about every 20 ms with the number of
  /// states that have been answered. If it returns false, the check soon throws Cancelled. What it throws ends the
  /// check too. It must not use the checker.
  std::function<bool(std::size_t answered)> go_on = nullptr;
};

struct BatchResult
{
  std::vector<std::uint8_t> valid;  ///< one per state: 1 free, 0 in collision
  std::vector<BodyPair> colliding;  ///< one per state: a colliding pair; kNoPair if the state is valid
  std::uint64_t revision = 0;       ///< revision of the checked scene
  double seconds = 0.0;             ///< wall time; shaders are usually compiled, and trees built, before the check
  std::size_t device_states = 0;    ///< states that devices decided; the CPU decided the others
  /// States that a device left undecided, because float32 proves no verdict, and the CPU then decided.
  std::size_t undecided_states = 0;

  /// Appends the result of the states that follow. Times and counts are added; the revision is that of `next`.
  void append(const BatchResult& next);
};

/// The number of random states for SceneReport::colliding_in_samples.
constexpr std::size_t kSampledStates = 64;

/// The states that a stage of the CPU's checks has decided.
struct DecidedStates
{
  std::string by;  ///< the stage: see docs/architecture.md, "How a batch flows"
  std::uint64_t states = 0;
  double nanoseconds = 0.0;  ///< mean time in this stage, over all states that entered the first stage; 0: not measured
};

/// The pairs of a scene that are checked, and the pairs that are left out, by reason.
struct SceneReport
{
  std::size_t self_pairs = 0;          ///< checked: two links, a link and an attached object, or two attached objects
  std::size_t world_pairs = 0;         ///< checked: a world object and a link or attached object
  std::size_t allowed_self_pairs = 0;  ///< left out: the allowed collision matrix allows them
  std::size_t allowed_world_pairs = 0;
  /// Left out: an attached object with its link, its touch links, or the other objects of its link.
  std::size_t touch_pairs = 0;
  std::size_t pairs_outside_group = 0;      ///< left out: the group does not move either body
  std::size_t links_without_shapes = 0;     ///< left out: they cannot collide
  std::size_t unreachable_self_pairs = 0;   ///< left out: within the joint limits the bodies never meet
  std::size_t unreachable_world_pairs = 0;  ///< left out: within the joint limits the bodies never meet
  std::size_t unreachable_objects = 0;      ///< left out: no link or attached object reaches them
  /// Left out: decided once per scene, because no joint moves one body relative to the other.
  std::size_t rigid_pairs = 0;
  /// Body indices of a rigid pair that collides. Every state then collides.
  std::optional<BodyPair> always_colliding;
  /// Pairs that collided in each of kSampledStates random states within the joint limits, in ascending order. All
  /// rigid pairs that collide are among them; pairs between which a planar, floating or passive joint lies are not.
  std::vector<BodyPair> colliding_in_samples;
  std::size_t triangles = 0;     ///< in all trees
  std::size_t trees = 0;         ///< one per distinct shape
  std::size_t shared_trees = 0;  ///< shapes that use the tree of an equal shape
  /// The states of this group that the CPU has checked since setScene, by the stage that decided them. All states
  /// count: with or without a neighbourhood, and also those that a device has left undecided.
  std::vector<DecidedStates> decided;
};

/// Checks many robot states for collision at once. Implementations: BatchChecker (GPU and CPU) and CpuChecker.
/// Thread-safe.
///
/// A pair of bodies collides if its distance is at most its required distance. Between the robot and the world, this is
/// the sum of the two paddings. Within the robot it is 0.
class StateChecker
{
 public:
  virtual ~StateChecker() = default;

  /// Replaces the scene. Throws Error and keeps the old scene if the new one is not valid.
  virtual void setScene(std::shared_ptr<const PlanningScene> scene) = 0;

  /// `states`: row-major, `count` rows of robot->variables().size() values. `group`: a planning group; only pairs with
  /// a link that the group moves are checked. Empty: all pairs are checked. Throws Error for an unknown group, or a
  /// value that is not finite or beyond Variable::largest.
  /// With `around`, valid[i] is 1 only if the whole neighbourhood of state i is proven free: the distance of each pair
  /// exceeds its required distance by more than its bodies can move relative to each other. If valid[i] is 0, the state
  /// itself may be free, and the reported pair may only be near. A state outside the joint limits gets 0. Only joints
  /// that the group moves may have a travel above 0; the function does not verify this. Throws Error if the rows or the
  /// travel do not fit the states.
  BatchResult check(const double* states, std::size_t count, const std::string& group = "",
                    const JointNeighbourhood* around = nullptr)
  {
    return checkBatch({states, count, group, around});
  }

  /// The same for a batch that may take long. Throws Cancelled too.
  virtual BatchResult checkBatch(const StateBatch& batch) = 0;

  /// Pairs that are checked for a group and pairs that are left out. Throws Error for an unknown group.
  virtual SceneReport report(const std::string& group = "") = 0;

  /// The name of the device: GL_RENDERER, or "CPU".
  virtual std::string deviceName() const = 0;

  /// True: calls of check() from several threads run side by side. False: they run one after the other.
  virtual bool checksSideBySide() const { return false; }

  /// One line if the device cannot hold the scene, or if its arithmetic breaks an assumption of the error bounds; else
  /// empty. The CPU then checks all states, or every pair whose bounding boxes overlap. The answers stay right.
  virtual std::string deviceWarning() const { return {}; }
};
}  // namespace gpu_planning_scene::core
