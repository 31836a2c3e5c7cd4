// Wrong trees of a device are found before anything is checked with them, whichever step of the build has failed.

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "collision/gpu/tree_build/built_trees.h"
#include "collision/gpu/tree_build/gpu_trees.h"
#include "gpu/egl_context.h"
#include "gpu/program.h"
#include "model/model_testing.h"
#include "support/seed.h"
#include "support/shader_folder.h"
#include "support/triangle_soup.h"

namespace gpu_planning_scene::core
{
namespace
{
class BuiltTreesTest : public testing::Test
{
 protected:
  std::shared_ptr<const Mesh> soup(std::size_t triangles)
  {
    return triangleSoup(
        triangles, [&] { return Eigen::Vector3d(uniform_(generator_), uniform_(generator_), uniform_(generator_)); });
  }

  std::mt19937_64 generator_{kSeed};
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
  EglContext context_{"auto"};
  const std::vector<Tessellation> shapes_ = {{soup(1), 0.0}, {soup(900), 0.0}, {soup(40), 0.0}};
};

/// A change of a shader that makes wrong trees.
struct Break
{
  const char* file;
  const char* text;
  const char* by;
};

TEST_F(BuiltTreesTest, OfABrokenShaderAreRefused)
{
  const std::vector<Break> breaks = {
      {"tree_build/boxes.comp", "box.low = low - ", "box.low = 0.5 * low - "},
      {"tree_build/boxes.comp", "box.reference = i;", "box.reference = 0u;"},
      {"tree_build/sort_scatter.comp", "keys_out[next[digitOf(key)]++] = key;", "keys_out[next[digitOf(key)]] = key;"},
      {"tree_build/scan.comp", "rounds[next + ROUND_CLUSTERS] = remaining;",
       "rounds[next + ROUND_CLUSTERS] = remaining + (round_index == BUILD_ROUNDS - 1u ? 1u : 0u);"},
      {"tree_build/layout.glsl", "primitive_base + c.reference;", "primitive_base + (c.reference ^ 1u);"},
      {"tree_build/layout.glsl", "leaf_order[start] = primitive_base + c.reference;", "leaf_order[start] = 0u;"},
      {"tree_build/layout.glsl", "(1.0 + 4.0 * UNIT_ROUNDOFF) + 1e-37", "0.9"},
      {"tree_build/layout.glsl", "leaf ? start : first_pair_node", "leaf ? start + 1u : first_pair_node"},
      {"tree_build/layout.glsl", "leaf ? c.count : 0u", "leaf ? c.count + 1u : 0u"},
      {"tree_build/layout_pairs.comp", "start + left.count", "start + left.count + 1u"},
      {"tree_build/gather_triangles.comp", "vertices[at + 2u]", "vertices[at + 1u]"},
      {"tree_build/fit.glsl", "0.5 * (high - low) + off", "0.4 * (high - low)"},
      {"tree_build/fit_output.glsl", "node.first);", "node.first + 1u);"},
      {"tree_build/fit_boxes.comp", "FIT_INVOCATION_TRIANGLES)\n  {", "FIT_INVOCATION_TRIANGLES)\n  {\n    return;"},
  };
  EXPECT_EQ(errorOf([&] { GpuTrees(shaderFolder()).setShapes(shapes_); }), "");
  for (const Break& broken : breaks)
  {
    const ShaderFolder shaders;
    shaders.replace(broken.file, broken.text, broken.by);
    const std::string error = errorOf([&] { GpuTrees(shaders.path()).setShapes(shapes_); });
    EXPECT_EQ(error.rfind("the GPU built ", 0), 0u) << broken.file << ": " << broken.by << ": " << error;
    EXPECT_NE(error.find("choose another device"), std::string::npos) << error;
  }
}

TEST_F(BuiltTreesTest, WithOneWrongWordAreRefused)
{
  GpuTrees trees(shaderFolder());
  trees.setShapes(shapes_);
  std::vector<const Mesh*> meshes;
  BuiltTrees right;
  for (const Tessellation& shape : shapes_)
  {
    meshes.push_back(shape.mesh.get());
    right.region.primitive_count += static_cast<std::uint32_t>(shape.mesh->triangles.size());
  }
  right.region.node_count = 2 * right.region.primitive_count - static_cast<std::uint32_t>(meshes.size());
  right.region.depth = trees.depth();
  const auto read = [](const Buffer& from, std::size_t count, auto& to)
  {
    to.resize(count);
    from.read(to.data(), count * sizeof(to.front()));
  };
  read(trees.nodes().buffer(), right.region.node_count, right.nodes);
  read(trees.orientedNodes().buffer(), right.region.node_count, right.oriented);
  read(trees.leafOrder(), right.region.primitive_count, right.leaf_order);
  read(trees.triangles().buffer(), std::size_t{12} * right.region.primitive_count, right.corners);
  EXPECT_EQ(faultOf(right, meshes), "");

  SCOPED_TRACE("seed " + std::to_string(kSeed));
  const auto below = [&](std::size_t end) { return generator_() % end; };
  // The nodes below a leaf of several triangles are in no tree.
  std::vector<std::uint32_t> used = {0, 1, 2};
  for (std::size_t i = 0; i < used.size(); ++i)
    if (const Node& inner = right.nodes[used[i]]; inner.count == 0)
      used.insert(used.end(), {inner.first, inner.first + 1});
  const auto node = [&](BuiltTrees& wrong) -> Node& { return wrong.nodes[used[below(used.size())]]; };
  const auto box = [&](BuiltTrees& wrong) -> OrientedNode& { return wrong.oriented[used[below(used.size())]]; };
  const std::vector<std::function<void(BuiltTrees&)>> changes = {
      [&](BuiltTrees& wrong) { ++node(wrong).first; },
      [&](BuiltTrees& wrong) { ++node(wrong).count; },
      [&](BuiltTrees& wrong) { node(wrong).half[below(3)] *= 0.5F; },
      [&](BuiltTrees& wrong) { node(wrong).center[below(3)] += 5.0F; },
      [&](BuiltTrees& wrong) { node(wrong).center[below(3)] = std::nanf(""); },
      [&](BuiltTrees& wrong) { node(wrong) = Node{}; },
      [&](BuiltTrees& wrong) { ++box(wrong).first; },
      [&](BuiltTrees& wrong) { ++box(wrong).count; },
      [&](BuiltTrees& wrong) { box(wrong).center[below(3)] += 5.0F; },
      [&](BuiltTrees& wrong) { box(wrong).half[below(3)] = std::nanf(""); },
      [&](BuiltTrees& wrong) { box(wrong) = OrientedNode{}; },
      [&](BuiltTrees& wrong) { ++wrong.leaf_order[below(wrong.leaf_order.size())]; },
      [&](BuiltTrees& wrong) { wrong.leaf_order[1 + below(wrong.leaf_order.size() - 1)] = 0; },
      [&](BuiltTrees& wrong) { std::swap(wrong.leaf_order[1 + below(200)], wrong.leaf_order[600 + below(200)]); },
      [&](BuiltTrees& wrong) { wrong.corners[4 * below(wrong.corners.size() / 4) + below(3)] += 1e-3F; },
      [&](BuiltTrees& wrong) { wrong.region.depth = 5; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i)
    for (int k = 0; k < 20; ++k)
    {
      BuiltTrees wrong = right;
      changes[i](wrong);
      EXPECT_NE(faultOf(wrong, meshes), "") << "change " << i;
    }
}
}  // namespace
}  // namespace gpu_planning_scene::core
