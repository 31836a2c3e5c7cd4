// The experiment of Gress and Zachmann, "Object-Space Interference Detection on Programmable Graphics Hardware" (2003):
// time against distance for two meshes in many relative poses.

#include <algorithm>
#include <iostream>

#include "base/parallel_for.h"
#include "benchmark/csv_table.h"
#include "benchmark/settings.h"
#include "benchmark/statistics.h"
#include "gpu_planning_scene/mesh_pair_checker.h"
#include "literature/exact_pair.h"
#include "literature/models.h"
#include "literature/poses.h"
#include "tools/progress_bar.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
using Eigen::Isometry3d;
using literature::ExactPair;
using literature::pairProblem;

constexpr std::size_t kTriangles = 70000;  // about the size of the Stanford bunny, which is common in such experiments
constexpr std::size_t kQuickTriangles = 2000;

using Answers = std::vector<std::uint8_t>;
using Collide = std::function<Answers(const std::vector<Isometry3d>&)>;

struct PairMethod
{
  const MethodInfo* info;
  Collide collide;
};

Collide onGpu(const Shape& a, const Shape& b, const MethodInfo& info, const Settings& settings)
{
  BatchCheckerOptions options;
  options.device = settings.method.device;
  options.traversal = traversalFromName(info.name.substr(std::string("ours_").size()));
  options.device_only = true;
  auto checker = std::make_shared<MeshPairChecker>(a, b, options);
  return [checker](const std::vector<Isometry3d>& poses) { return checker->collide(poses); };
}

Collide exactly(const std::shared_ptr<const CollisionProblem>& problem)
{
  auto pair = std::make_shared<const ExactPair>(problem);
  return [pair](const std::vector<Isometry3d>& poses) { return pair->collide(poses); };
}

Collide byPeer(const std::shared_ptr<const CollisionProblem>& problem, const PeerMaker& make)
{
  std::shared_ptr<const Peer> first = make(problem);
  return [first](const std::vector<Isometry3d>& poses)
  {
    Answers answers(poses.size());
    parallelFor(poses.size(), 16,
                [&, peer = std::shared_ptr<Peer>()](std::size_t begin, std::size_t end) mutable
                {
                  if (!peer)
                    peer = first->copy();
                  for (std::size_t i = begin; i < end; ++i)
                    answers[i] = peer->collides(&poses[i]) ? 1 : 0;
                });
    return answers;
  };
}

std::vector<PairMethod> methodsFor(const Shape& a, const Shape& b, const Settings& settings)
{
  const auto problem = pairProblem(a, b);
  std::vector<PairMethod> methods;
  for (const MethodInfo& info : settings.methods)
  {
    if (info.name == "exact_cpu")
      methods.push_back({&info, exactly(problem)});
    if (info.name == "ours_work_queue" || info.name == "ours_breadth_first")
      methods.push_back({&info, onGpu(a, b, info, settings)});
    for (const auto& [name, make] : meshPeers())
      if (info.name == name)
        methods.push_back({&info, byPeer(problem, make)});
  }
  return methods;
}
}  // namespace

std::size_t measureMeshPairs(const Settings& settings)
{
  CsvTable table(settings.out, "mesh_pairs.csv",
                 {"triangles", "distance_m", "colliding_share", "method", "title", "family", "poses", "us_a_pose",
                  "cpu_us_a_pose", "wrong"});
  const std::size_t triangles = settings.quick ? kQuickTriangles : kTriangles;
  const Shape mesh = literature::lump(triangles);
  const std::vector<PairMethod> methods = methodsFor(mesh, mesh, settings);
  const Collide truth = exactly(pairProblem(mesh, mesh));
  const std::size_t count = settings.quick ? 256 : 4096;
  const std::vector<double> distances = settings.quick
                                            ? std::vector<double>{0.7, 0.9}
                                            : std::vector<double>{0.5, 0.6, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1.0, 1.1};
  ProgressBar progress("mesh pairs", distances.size() * methods.size());
  std::size_t done = 0;
  std::size_t wrong_of_exact = 0;
  for (const double distance : distances)
  {
    const std::vector<Isometry3d> poses = literature::posesAt(distance, count, settings.seed);
    const Answers expected = truth(poses);
    const auto colliding = static_cast<double>(std::count(expected.begin(), expected.end(), 1));
    for (const PairMethod& method : methods)
    {
      progress.update(done++);
      // A slow method gets fewer poses.
      const std::vector<Isometry3d> few(poses.begin(), poses.begin() + std::min<std::size_t>(16, count));
      method.collide(few);
      const double trial = secondsOf([&] { method.collide(few); });
      const auto affordable = static_cast<std::size_t>(static_cast<double>(few.size()) * settings.seconds / trial);
      const std::vector<Isometry3d> asked(
          poses.begin(), poses.begin() + static_cast<std::ptrdiff_t>(std::clamp(affordable, few.size(), count)));
      std::vector<double> wall;
      std::vector<double> cpu;
      std::size_t wrong = 0;  // of the repeat with the most wrong answers
      for (std::size_t repeat = 0; repeat < settings.repeats; ++repeat)
      {
        const Stopwatch watch;
        const Answers answers = method.collide(asked);
        wall.push_back(1e6 * watch.seconds() / static_cast<double>(asked.size()));
        cpu.push_back(1e6 * watch.cpuSeconds() / static_cast<double>(asked.size()));
        std::size_t of_this = 0;
        for (std::size_t i = 0; i < asked.size(); ++i)
          of_this += answers[i] != expected[i] ? 1 : 0;
        wrong = std::max(wrong, of_this);
      }
      table.add({triangles, distance, colliding / static_cast<double>(count), method.info->name, method.info->title,
                 method.info->family, asked.size(), median(wall), median(cpu), wrong});
      if (method.info->exact && wrong > 0)
        std::cerr << "mesh pairs at " << distance << " m: " << method.info->title << " gives " << wrong
                  << " wrong answers\n";
      wrong_of_exact += method.info->exact ? wrong : 0;
    }
  }
  return wrong_of_exact;
}
}  // namespace gpu_planning_scene::core::benchmark
