// The methods of bench/literature on robot states: each of them checks the pairs of shapes that the allowed collision
// matrix does not allow, one pair after the other. Pairs whose boxes along the axes of the robot's base are apart are
// left out, as by the FCL peer. A method gets all states of a chunk for a pair at once, because methods that render
// draw many poses into one picture.

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>
#include <thread>

#include "benchmark/method.h"
#include "collision/bounds/problem_maker.h"
#include "literature/method.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
using Eigen::Isometry3d;

/// Left out: FCL, which peerMethods() has; other resolutions of the methods that render; methods that find all pairs of
/// triangles; and CGAL, which would need a process for each pair of shapes.
constexpr std::array<const char*, 14> kChosen = {
    "rapid",        "dop18",        "dop18_larger",  "dop24",  "box_tree", "breadth_first", "convex_patches",
    "recode_256x1", "cinder_256x1", "cullide_256x1", "opcode", "gimpact",  "embree",        "cullide_fattened_256x1"};

/// Debian's ODE is built without ODE_EXT_mt_collisions: only one thread at a time may ask it.
constexpr const char* kOneThread = "opcode";

/// The box of a mesh in a frame in which the mesh has this pose, a little larger than needed.
struct PlacedBox
{
  PlacedBox(const Eigen::AlignedBox3d& box, const Isometry3d& pose)
    : center(pose * box.center()), half(pose.linear().cwiseAbs() * (0.5 * (1.0 + 1e-9) * box.sizes()))
  {
  }
  bool overlaps(const PlacedBox& other) const
  {
    return ((center - other.center).cwiseAbs().array() <= (half + other.half).array()).all();
  }

  Eigen::Vector3d center;
  Eigen::Vector3d half;
};

Eigen::AlignedBox3d boxOf(const Mesh& mesh)
{
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    box.extend(vertex);
  return box;
}

/// Two instances. `a`: of the world, which stands still, or of the robot. `b`: of the robot, which moves. Klosowski's
/// 18-DOPs open the tree of `a` first, and all DOP trees refit or realign the nodes of `b`.
struct Pair
{
  const ShapeInstance* a;
  const ShapeInstance* b;
};

std::vector<Pair> checkedPairs(const CollisionProblem& problem)
{
  std::vector<Pair> pairs;
  const std::size_t world = problem.world.size();
  for (std::size_t i = 0; i < problem.robot.size(); ++i)
    for (std::size_t k = 0; k < world; ++k)
      if (problem.world_pairs[i * world + k] != 0)
        pairs.push_back({&problem.world[k], &problem.robot[i]});
  for (const auto& pair : problem.self_pairs)
    pairs.push_back({&problem.robot[pair[0]], &problem.robot[pair[1]]});
  return pairs;
}

/// The methods for all pairs of shapes, for one thread.
class PairMethods
{
 public:
  PairMethods(std::shared_ptr<const CollisionProblem> problem, const literature::MethodInfo& info)
    : problem_(std::move(problem)), pairs_(checkedPairs(*problem_))
  {
    for (const Tessellation& shape : problem_->tessellations)
      boxes_.push_back(boxOf(*shape.mesh));
    for (const Pair& pair : pairs_)
    {
      std::unique_ptr<literature::Method>& method = methods_[{pair.a->tree, pair.b->tree}];
      if (!method)
        method = info.make(problem_->tessellations[pair.a->tree].mesh, problem_->tessellations[pair.b->tree].mesh);
    }
  }

  /// `link_poses`: rows of `links` poses. Sets valid[i] to 0 for each state in collision, and to 1 for the others.
  void check(const std::vector<Isometry3d>& link_poses, std::size_t links, std::size_t count, std::uint8_t* valid)
  {
    std::fill_n(valid, count, std::uint8_t{1});
    for (const Pair& pair : pairs_)
    {
      std::vector<std::size_t> asked;
      std::vector<Isometry3d> b_in_a;
      for (std::size_t i = 0; i < count; ++i)
      {
        if (valid[i] == 0)
          continue;
        const Isometry3d* poses = &link_poses[i * links];
        const Isometry3d pose_a = placed(*pair.a, poses);
        const Isometry3d pose_b = placed(*pair.b, poses);
        if (!PlacedBox(boxes_[pair.a->tree], pose_a).overlaps(PlacedBox(boxes_[pair.b->tree], pose_b)))
          continue;
        asked.push_back(i);
        b_in_a.push_back(pose_a.inverse() * pose_b);
      }
      if (asked.empty())
        continue;
      queries_ += static_cast<double>(asked.size());
      const std::vector<std::uint8_t> hits = methods_.at({pair.a->tree, pair.b->tree})->collide(b_in_a);
      for (std::size_t i = 0; i < asked.size(); ++i)
        valid[asked[i]] = hits[i] == 0 ? 1 : 0;
    }
  }

  /// The pairs of shapes whose boxes overlapped in all calls so far, each in one state.
  double queries() const { return queries_; }

  /// The tests of bounding volumes in all calls so far. NaN if the method does not count them.
  double volumeTests() const
  {
    double tests = methods_.empty() ? NAN : 0.0;
    for (const auto& [trees, method] : methods_)
    {
      const literature::WorkCounts counts = method->work();
      const auto volumes =
          std::find_if(counts.begin(), counts.end(), [](const auto& count) { return count.first == "volume tests"; });
      tests += volumes == counts.end() ? NAN : volumes->second;
    }
    return tests;
  }

 private:
  static Isometry3d placed(const ShapeInstance& instance, const Isometry3d* link_poses)
  {
    return instance.link < 0 ? instance.pose : link_poses[instance.link] * instance.pose;
  }

  std::shared_ptr<const CollisionProblem> problem_;
  std::vector<Pair> pairs_;
  std::vector<Eigen::AlignedBox3d> boxes_;  // of each tree, in the frame of its mesh
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::unique_ptr<literature::Method>> methods_;
  double queries_ = 0.0;
};

/// Runs a method on all cores, each with its own PairMethods. A method that renders gets all states at once, on one
/// thread, because the device has one queue. OPCODE gets one thread too.
class FromLiterature : public Method
{
 public:
  FromLiterature(const std::shared_ptr<const PlanningScene>& scene, const literature::MethodInfo& info)
    : robot_(scene->robot), renders_(info.family == "image space")
  {
    const auto problem = std::make_shared<const CollisionProblem>(makeProblem(*scene, "", nullptr));
    const bool one_thread = renders_ || info.name == kOneThread;
    const std::size_t threads = one_thread ? 1 : std::max(1U, std::thread::hardware_concurrency());
    for (std::size_t i = 0; i < threads; ++i)
      of_threads_.push_back(std::make_unique<PairMethods>(problem, info));
  }

  std::vector<std::uint8_t> check(const double* states, std::size_t count) override
  {
    std::vector<std::uint8_t> valid(count);
    const std::size_t chunk = renders_ ? count : kChunk;
    std::atomic<std::size_t> next{0};
    const auto work = [&](PairMethods& methods)
    {
      for (std::size_t begin = next.fetch_add(chunk); begin < count; begin = next.fetch_add(chunk))
        checkChunk(methods, states + begin * robot_->variables().size(), std::min(chunk, count - begin), &valid[begin]);
    };
    std::vector<std::thread> helpers;
    for (std::size_t i = 1; i < of_threads_.size() && i * chunk < count; ++i)
      helpers.emplace_back(work, std::ref(*of_threads_[i]));
    work(*of_threads_.front());
    for (std::thread& helper : helpers)
      helper.join();
    return valid;
  }

  WorkPerState work(const double* states, std::size_t count) override
  {
    PairMethods& methods = *of_threads_.front();
    const double tests = methods.volumeTests();
    const double queries = methods.queries();
    if (std::isnan(tests))
      return {};
    std::vector<std::uint8_t> valid(count);
    checkChunk(methods, states, count, valid.data());
    WorkPerState work;
    work.node_visits = (methods.volumeTests() - tests) / static_cast<double>(count);
    work.root_pairs = (methods.queries() - queries) / static_cast<double>(count);
    return work;
  }

 private:
  void checkChunk(PairMethods& methods, const double* states, std::size_t count, std::uint8_t* valid) const
  {
    const std::size_t links = robot_->links().size();
    std::vector<Isometry3d> poses(count * links);
    for (std::size_t i = 0; i < count; ++i)
      robot_->linkPoses(states + i * robot_->variables().size(), &poses[i * links]);
    methods.check(poses, links, count, valid);
  }

  static constexpr std::size_t kChunk = 64;
  std::shared_ptr<const RobotModel> robot_;
  bool renders_;
  std::vector<std::unique_ptr<PairMethods>> of_threads_;
};

bool isCurved(const PlacedShape& placed)
{
  return !std::holds_alternative<std::shared_ptr<const Mesh>>(placed.shape) &&
         !std::holds_alternative<Box>(placed.shape);
}

std::string whyRefused(const PlanningScene& scene)
{
  const auto reason = [](const std::string& body)
  { return "the methods of the literature check meshes and boxes, but " + body + " has another shape"; };
  for (const Link& link : scene.robot->links())
    if (std::any_of(link.shapes.begin(), link.shapes.end(), isCurved))
      return reason("link " + link.name);
  for (const WorldObject& object : scene.objects)
    if (std::any_of(object.shapes.begin(), object.shapes.end(), isCurved))
      return reason("object " + object.id);
  for (const AttachedObject& attached : scene.attached)
    if (std::any_of(attached.object.shapes.begin(), attached.object.shapes.end(), isCurved))
      return reason("object " + attached.object.id);
  return "";
}
}  // namespace

std::vector<MethodInfo> literatureMethods()
{
  std::vector<MethodInfo> methods;
  for (const auto& all : {literature::treeMethods(), literature::convexMethods(), literature::imageSpaceMethods(),
                          literature::libraryMethods()})
    for (const literature::MethodInfo& info : all)
      if (std::find(kChosen.begin(), kChosen.end(), info.name) != kChosen.end())
      {
        MethodInfo made;
        made.name = info.name;
        made.title = info.title;
        made.family = info.family;
        made.paddable = false;
        made.in_quick_run = false;
        made.refuses = whyRefused;
        made.make = [info](const auto& scene, const MethodOptions&)
        { return std::make_unique<FromLiterature>(scene, info); };
        methods.push_back(made);
      }
  return methods;
}
}  // namespace gpu_planning_scene::core::benchmark
