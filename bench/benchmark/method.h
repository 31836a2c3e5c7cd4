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
/// What a method looks at, on average over some states. Not numbers where it does not count.
struct WorkPerState
{
  double node_visits = NAN;  ///< of the trees, on the CPU: nodes and pairs of nodes
  double candidates = NAN;   ///< see GpuWork
  double root_pairs = NAN;
};

/// Something that answers for a scene which states are free.
class Method
{
 public:
  virtual ~Method() = default;
  /// One byte a state: 1 free, 0 in collision.
  virtual std::vector<std::uint8_t> check(const double* states, std::size_t count) = 0;
  /// Takes another scene of the same robot. False: it has to be built anew for that.
  virtual bool update(const std::shared_ptr<const PlanningScene>& /*scene*/) { return false; }
  /// States of the last check that the GPU left to the CPU.
  virtual std::size_t undecided() const { return 0; }
  /// Of checking these states at once; not to be timed.
  virtual WorkPerState work(const double* /*states*/, std::size_t /*count*/) { return {}; }
  /// Of one that chooses: batches of fewer states went to the CPU.
  virtual std::optional<std::size_t> cpuBelow() { return std::nullopt; }
};

struct MethodOptions
{
  std::string device = "auto";
  std::size_t max_batch = 0;  ///< 0: the library's default
};

struct MethodInfo
{
  std::string name;         ///< on the command line and in tables
  std::string title;        ///< in charts
  std::string family;       ///< one colour in charts
  bool exact = false;       ///< a wrong answer is an error
  bool batched = false;     ///< its speed depends on the size of batches
  bool paddable = true;     ///< can check padded scenes
  bool responsive = false;  ///< measured for single states, updates and growth too
  std::function<std::unique_ptr<Method>(const std::shared_ptr<const PlanningScene>&, const MethodOptions&)> make;
};

/// The project's own, and its peers.
std::vector<MethodInfo> ourMethods();
std::vector<MethodInfo> peerMethods();
/// Both. The first is the exact checker; FCL with OBBRSS, which others are compared with, is among them.
std::vector<MethodInfo> allMethods();

constexpr const char* kReferenceMethod = "fcl_obbrss";
/// The same trees, with pairs in the order that ours has them in, and FCL's broad phase for objects.
constexpr const char* kOrderedMethod = "fcl_obbrss_ordered";

/// A peer's view of a problem: link poses in, a verdict out. Not thread-safe.
class Peer
{
 public:
  virtual ~Peer() = default;
  virtual bool collides(const Eigen::Isometry3d* link_poses) = 0;
  /// Another for another thread; it may share what does not change.
  virtual std::unique_ptr<Peer> copy() const = 0;
};

using PeerMaker = std::function<std::unique_ptr<Peer>(const std::shared_ptr<const CollisionProblem>&)>;

/// The peers that can be asked about two meshes alone, with their names as in peerMethods().
std::vector<std::pair<std::string, PeerMaker>> meshPeers();
}  // namespace gpu_planning_scene::core::benchmark
