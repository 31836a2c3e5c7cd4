// bench_tree_build [REPEATS [SCENE...]]: time for building the trees of a robot on the GPU, from meshes in host memory
// to trees that can be traversed, and time of the binned SAH build on the CPU. The first build includes the compilation
// by the driver and is printed separately. The other builds give the median.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <set>

#include "base/seconds_since.h"
#include "collision/gpu/tree_build/gpu_forest.h"
#include "collision/trees/binned_sah.h"
#include "gpu/egl_context.h"
#include "gpu_planning_scene/error.h"
#include "support/test_scenes.h"

using namespace gpu_planning_scene::core;

namespace
{
std::vector<Tessellation> treesOf(const RobotModel& robot)
{
  std::vector<Tessellation> trees;
  std::set<const Mesh*> known;
  for (const Link& link : robot.links())
    for (const PlacedShape& placed : link.shapes)
    {
      Tessellation tree = tessellate(placed.shape);
      if (known.insert(tree.mesh.get()).second)
        trees.push_back(std::move(tree));
    }
  return trees;
}

double gpuBuild(GpuForestBuilder& builder, const std::vector<const Mesh*>& meshes)
{
  ForestRegion region;
  TexelBuffer nodes;
  TexelBuffer triangles;
  Buffer leaf_order;
  const auto start = std::chrono::steady_clock::now();
  builder.buildTriangles(meshes, region, nodes, leaf_order, triangles);
  // Reading one node waits for the whole build.
  Node root{};
  nodes.buffer().read(&root, sizeof(root));
  return secondsSince(start);
}

void measure(GpuForestBuilder& builder, const std::string& name, std::size_t repeats)
{
  const std::vector<Tessellation> trees = treesOf(*testScene(name).scene->robot);
  std::vector<const Mesh*> meshes;
  std::size_t triangles = 0;
  for (const Tessellation& tree : trees)
  {
    meshes.push_back(tree.mesh.get());
    triangles += tree.mesh->triangles.size();
  }
  const double first = gpuBuild(builder, meshes);
  std::vector<double> gpu;
  std::vector<double> cpu;
  for (std::size_t i = 0; i < repeats; ++i)
  {
    gpu.push_back(gpuBuild(builder, meshes));
    const auto start = std::chrono::steady_clock::now();
    buildBinnedSah(trees);
    cpu.push_back(secondsSince(start));
  }
  std::sort(gpu.begin(), gpu.end());
  std::sort(cpu.begin(), cpu.end());
  std::printf("| %s | %zu | %zu | %.3f | %.3f | %.3f ... %.3f | %.3f |\n", name.c_str(), trees.size(), triangles, first,
              gpu[repeats / 2], gpu.front(), gpu.back(), cpu[repeats / 2]);
}
}  // namespace

int main(int argc, char** argv)
try
{
  const std::size_t repeats = argc > 1 ? std::max(1UL, std::strtoul(argv[1], nullptr, 10)) : 7;
  std::vector<std::string> names(argv + std::min(argc, 2), argv + argc);
  if (names.empty())
    names = {"kr5", "wam", "drchubo", "ur5_cage"};
  const EglContext context("auto");
  std::printf("device: %s\n\n", context.device().renderer.c_str());
  std::printf("| robot of | trees | triangles | first build, s | median, s | spread, s | binned SAH on the CPU, s |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  GpuForestBuilder builder(shaderFolder());
  for (const std::string& name : names)
    if (missingFor(name).empty())
      measure(builder, name, repeats);
    else
      std::printf("| %s | | | skipped, there is no %s | | | |\n", name.c_str(), missingFor(name).c_str());
  return 0;
}
catch (const Error& error)
{
  std::cerr << error.what() << '\n';
  return 2;
}
