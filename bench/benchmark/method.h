#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core::benchmark
{
/// Work of a method per state, as an average over some states. NaN if the method does not count it.
struct WorkPerState
{
  /// Visited nodes of the trees on the CPU; a test of eight boxes counts as two. For the trees of bench/literature:
  /// tests of two bounding volumes.
  double node_visits = NAN;
  double candidates = NAN;  ///< see GpuWork
  double root_pairs = NAN;  ///< for the trees of bench/literature: pairs of shapes that are checked
  double traversed = NAN;
};

/// A method that decides which states of a scene are free.
class Method
{
 public:
  virtual ~Method() = default;
  /// One byte per state: 1 free, 0 in collision.
  virtual std::vector<std::uint8_t> check(const double* states, std::size_t count) = 0;
  /// Replaces the scene by another scene of the same robot. False: not supported; a new method must be made.
  virtual bool update(const std::shared_ptr<const PlanningScene>& /*scene*/) { return false; }
  /// Undecided states of the last check, which the CPU decided for the GPU.
  virtual std::size_t undecided() const { return 0; }
  /// Work of one check of these states. Do not time this call.
  virtual WorkPerState work(const double* /*states*/, std::size_t /*count*/) { return {}; }
  /// For a method in which devices and cores work together: the share of the devices in the last check.
  virtual std::optional<double> deviceShare() { return std::nullopt; }
};

struct MethodOptions
{
  std::string device = "auto";
  std::size_t max_batch = 0;  ///< 0: the library's default
};

struct MethodInfo
{
  std::string name;          ///< on the command line and in tables
  std::string title;         ///< in charts
  std::string family;        ///< methods of a family have one colour in charts
  bool exact = false;        ///< a wrong answer is an error
  bool batched = false;      ///< its speed depends on the batch size
  bool paddable = true;      ///< it can check padded scenes
  bool responsive = false;   ///< it is also measured for single states, updates and growth
  bool in_quick_run = true;  ///< --quick measures it, also if nobody names it
  /// The reason why the method cannot check a scene; empty: it can. Without the function it can check every scene.
  std::function<std::string(const PlanningScene&)> refuses;
  std::function<std::unique_ptr<Method>(const std::shared_ptr<const PlanningScene>&, const MethodOptions&)> make;
};

/// The project's own methods.
std::vector<MethodInfo> ourMethods();
/// Methods of other libraries.
std::vector<MethodInfo> peerMethods();
/// Methods of bench/literature that check the pairs of shapes one by one.
std::vector<MethodInfo> literatureMethods();
/// VAMP's check, if it can be used here: see whyNoVamp().
std::vector<MethodInfo> vampMethods();
/// All of them. The first is the exact checker. FCL with OBBRSS, the reference for speed, is among them.
std::vector<MethodInfo> allMethods();

constexpr const char* kReferenceMethod = "fcl_obbrss";
/// The same trees, with the order of pairs learned as in our exact checker, and FCL's broad phase for objects.
constexpr const char* kOrderedMethod = "fcl_obbrss_ordered";
constexpr const char* kVampMethod = "vamp";

/// A method of another library for one problem: it maps link poses to a verdict. Not thread-safe.
class Peer
{
 public:
  virtual ~Peer() = default;
  virtual bool collides(const Eigen::Isometry3d* link_poses) = 0;
  /// A copy for another thread. It may share immutable data.
  virtual std::unique_ptr<Peer> copy() const = 0;
};

using PeerMaker = std::function<std::unique_ptr<Peer>(const std::shared_ptr<const CollisionProblem>&)>;

/// The peers that can check a single pair of meshes, with the names of peerMethods().
std::vector<std::pair<std::string, PeerMaker>> meshPeers();
}  // namespace gpu_planning_scene::core::benchmark
