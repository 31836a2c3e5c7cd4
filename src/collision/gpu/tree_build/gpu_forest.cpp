#include "collision/gpu/tree_build/gpu_forest.h"

#include <cmath>

#include "gpu/gl_check.h"
#include "gpu_planning_scene/error.h"
#include "shader_constants.h"

// Three steps: a radix sort of the Morton codes within each mesh; BUILD_ROUNDS rounds of merging, in which each round
// computes the size of the next round's dispatches; the layout, which goes through the rounds in reverse order. The
// header names the sources.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kUint = sizeof(std::uint32_t);
constexpr std::size_t kTexel = TexelBuffer::kTexelBytes;
static_assert(sizeof(Node) == NODE_TEXELS * kTexel, "the layout of shaders/problem/nodes.glsl");
static_assert(kLeafTriangles == LEAF_TRIANGLES, "the leaves of Node, on the CPU and on the GPU");

/// llvmpipe ends an invocation after 65535 iterations. With at most this many primitives, the invocations of the prefix
/// sums stay far below.
constexpr std::size_t kMaxPrimitives = std::size_t{1} << 23;

std::size_t divideUp(std::size_t value, std::size_t by)
{
  return (value + by - 1) / by;
}

std::vector<float> floatVertices(const std::vector<const Mesh*>& meshes)
{
  std::size_t count = 0;
  for (const Mesh* mesh : meshes)
    count += mesh->triangles.size();
  std::vector<float> vertices;
  vertices.reserve(TRIANGLE_FLOATS * count);
  for (const Mesh* mesh : meshes)
    for (const auto& triangle : mesh->triangles)
      for (const std::uint32_t corner : triangle)
        for (int axis = 0; axis < 3; ++axis)
        {
          const double value = mesh->vertices[corner][axis];
          if (!(std::abs(value) < 1e9))  // products of four lengths, which the error bounds use, must fit into a float
            throw Error("mesh " + mesh->name + ": coordinate " + std::to_string(value) +
                        " m is out of range; check the mesh's unit and scale");
          vertices.push_back(static_cast<float>(value));
        }
  return vertices;
}
}  // namespace

GpuForestBuilder::GpuForestBuilder(const std::string& folder)
  : boxes_program_(folder, "tree_build/boxes.comp"),
    bounds_program_(folder, "tree_build/bounds.comp"),
    morton_program_(folder, "tree_build/morton.comp"),
    sort_count_program_(folder, "tree_build/sort_count.comp"),
    sort_scan_program_(folder, "tree_build/sort_scan.comp"),
    sort_scatter_program_(folder, "tree_build/sort_scatter.comp"),
    gather_program_(folder, "tree_build/gather.comp"),
    nearest_program_(folder, "tree_build/nearest.comp"),
    count_program_(folder, "tree_build/count.comp"),
    scan_program_(folder, "tree_build/scan.comp"),
    write_program_(folder, "tree_build/write.comp"),
    layout_roots_program_(folder, "tree_build/layout_roots.comp"),
    layout_pairs_program_(folder, "tree_build/layout_pairs.comp"),
    triangles_program_(folder, "tree_build/gather_triangles.comp")
{
}

void GpuForestBuilder::buildTriangles(const std::vector<const Mesh*>& meshes, ForestRegion& region, TexelBuffer& nodes,
                                      Buffer& leaf_order, TexelBuffer& triangles)
{
  const std::vector<float> vertices = floatVertices(meshes);
  const std::size_t count = vertices.size() / TRIANGLE_FLOATS;
  std::vector<std::uint32_t> first;
  std::uint32_t next = 0;
  for (const Mesh* mesh : meshes)
  {
    first.push_back(next);
    next += static_cast<std::uint32_t>(mesh->triangles.size());
  }
  vertices_.reserve(vertices.size() * sizeof(float));
  vertices_.write(vertices);
  boxes_.reserve(count * CLUSTER_TEXELS * kTexel);
  vertices_.bindStorage(BINDING_VERTICES);
  boxes_.bindStorage(BINDING_BOXES);
  boxes_program_.set(LOCATION_TRIANGLE_COUNT, static_cast<std::uint32_t>(count));
  boxes_program_.dispatch(groupsFor(count));

  build(count, first, LEAF_TRIANGLES, region, nodes, leaf_order);

  triangles.reserve((region.first_primitive + count) * TRIANGLE_TEXELS * kTexel);
  vertices_.bindStorage(BINDING_VERTICES);
  leaf_order.bindStorage(BINDING_LEAF_ORDER);
  triangles.buffer().bindStorage(BINDING_TRIANGLES);
  triangles_program_.set(LOCATION_FIRST_TRIANGLE, region.first_primitive);
  triangles_program_.set(LOCATION_TRIANGLE_COUNT, region.primitive_count);
  triangles_program_.dispatch(groupsFor(count));
  checkGl("building trees");
}

void GpuForestBuilder::build(std::size_t count, const std::vector<std::uint32_t>& first, std::uint32_t leaf_size,
                             ForestRegion& region, TexelBuffer& nodes, Buffer& leaf_order)
{
  const std::size_t mesh_count = first.size();
  if (count > kMaxPrimitives)
    throw Error("a mesh has " + std::to_string(count) + " triangles, but at most " + std::to_string(kMaxPrimitives) +
                " are supported; use a coarser mesh");
  region.primitive_count = static_cast<std::uint32_t>(count);
  region.node_count = static_cast<std::uint32_t>(2 * count - mesh_count);
  nodes.reserve((std::size_t{region.first_node} + region.node_count) * sizeof(Node));
  leaf_order.reserve((std::size_t{region.first_primitive} + count) * kUint);

  std::vector<std::uint32_t> mesh_of(count);
  std::vector<std::uint32_t> shifted_first(mesh_count);
  for (std::size_t mesh = 0; mesh < mesh_count; ++mesh)
  {
    const std::size_t end = mesh + 1 < mesh_count ? first[mesh + 1] : count;
    std::fill(mesh_of.begin() + first[mesh], mesh_of.begin() + static_cast<std::ptrdiff_t>(end),
              static_cast<std::uint32_t>(mesh));
    shifted_first[mesh] = first[mesh] + region.first_primitive;
  }
  mesh_of_.reserve(count * kUint);
  mesh_of_.write(mesh_of);
  first_primitive_.reserve(mesh_count * kUint);
  first_primitive_.write(shifted_first);

  sortByMorton(count, mesh_count);
  region.depth = mergeClusters(count, mesh_count);
  layOut(mesh_count, leaf_size, region, nodes, leaf_order);
}

void GpuForestBuilder::sortByMorton(std::size_t count, std::size_t mesh_count)
{
  const auto n = static_cast<std::uint32_t>(count);
  bounds_.reserve(mesh_count * BOUNDS_WORDS * kUint);
  bounds_.clear();
  for (Buffer& keys : keys_)
    keys.reserve(count * 2 * kUint);
  const std::size_t invocations = divideUp(count, CHUNK);
  counts_.reserve(invocations * RADIX_SIZE * kUint);

  boxes_.bindStorage(BINDING_BOXES);
  mesh_of_.bindStorage(BINDING_MESH_OF);
  bounds_.bindStorage(BINDING_BOUNDS);
  keys_[0].bindStorage(BINDING_KEYS_OUT);
  bounds_program_.set(LOCATION_PRIMITIVE_COUNT, n);
  bounds_program_.dispatch(groupsFor(count));
  morton_program_.set(LOCATION_PRIMITIVE_COUNT, n);
  morton_program_.dispatch(groupsFor(count));

  const auto pass = [&](std::uint32_t shift, std::uint32_t by_mesh)
  {
    keys_[0].bindStorage(BINDING_KEYS_IN);
    mesh_of_.bindStorage(BINDING_MESH_OF);
    counts_.bindStorage(BINDING_COUNTS);
    keys_[1].bindStorage(BINDING_KEYS_OUT);
    for (const Program* program : {&sort_count_program_, &sort_scatter_program_})
    {
      program->set(LOCATION_KEY_COUNT, n);
      program->set(LOCATION_SHIFT, shift);
      program->set(LOCATION_BY_MESH, by_mesh);
    }
    sort_scan_program_.set(LOCATION_VALUE_COUNT, static_cast<std::uint32_t>(invocations * RADIX_SIZE));
    sort_count_program_.dispatch(groupsFor(invocations));
    sort_scan_program_.dispatch(1);
    sort_scatter_program_.dispatch(groupsFor(invocations));
    std::swap(keys_[0], keys_[1]);
  };
  for (std::uint32_t shift = 0; shift < MORTON_BITS; shift += RADIX_BITS)
    pass(shift, 0);
  for (std::uint32_t shift = 0; shift < 32 && ((mesh_count - 1) >> shift) != 0; shift += RADIX_BITS)
    pass(shift, 1);
}

std::uint32_t GpuForestBuilder::mergeClusters(std::size_t count, std::size_t mesh_count)
{
  for (int i = 0; i < 2; ++i)
  {
    clusters_[i].reserve(count * CLUSTER_TEXELS * kTexel);
    cluster_info_[i].reserve(count * 2 * kUint);
  }
  nearest_.reserve(count * kUint);
  sums_.reserve(divideUp(count, CHUNK) * 2 * kUint);
  pairs_.reserve((count - mesh_count) * PAIR_TEXELS * kTexel);

  keys_[0].bindStorage(BINDING_KEYS_IN);
  mesh_of_.bindStorage(BINDING_MESH_OF);
  boxes_.bindStorage(BINDING_BOXES);
  clusters_[0].buffer().bindStorage(BINDING_CLUSTERS_OUT);
  cluster_info_[0].bindStorage(BINDING_CLUSTER_INFO_OUT);
  gather_program_.set(LOCATION_PRIMITIVE_COUNT, static_cast<std::uint32_t>(count));
  gather_program_.dispatch(groupsFor(count));

  // One more record than rounds: the last one holds the number and the place of the final clusters.
  rounds_.reserve(kUint * (BUILD_ROUNDS + 1) * ROUND_STRIDE);
  rounds_.clear();
  const std::size_t invocations = count == mesh_count ? 0 : count;
  std::vector<std::uint32_t> first(ROUND_STRIDE, 0);
  const auto set_groups = [&](std::size_t at, std::size_t invocation_count)
  {
    const std::size_t groups = groupsFor(invocation_count);
    const std::size_t rows = divideUp(groups, MAX_GROUPS);
    first[at] = static_cast<std::uint32_t>(rows == 0 ? 0 : divideUp(groups, rows));
    first[at + 1] = static_cast<std::uint32_t>(rows);
    first[at + 2] = 1;
  };
  set_groups(ROUND_CLUSTER_GROUPS, invocations);
  set_groups(ROUND_CHUNK_GROUPS, divideUp(invocations, CHUNK));
  first[ROUND_CLUSTERS] = static_cast<std::uint32_t>(count);
  rounds_.write(first);
  if (invocations == 0)
    return 0;

  scan_program_.set(LOCATION_MESH_COUNT, static_cast<std::uint32_t>(mesh_count));
  rounds_.bindStorage(BINDING_ROUNDS);
  nearest_.bindStorage(BINDING_NEAREST);
  sums_.bindStorage(BINDING_SUMS);
  pairs_.bindStorage(BINDING_PAIRS);
  for (std::uint32_t round = 0; round < BUILD_ROUNDS; ++round)
  {
    const std::size_t record = kUint * round * ROUND_STRIDE;
    clusters_[round & 1].buffer().bindStorage(BINDING_CLUSTERS_IN);
    clusters_[round & 1].bindTexture(UNIT_CLUSTERS);
    cluster_info_[round & 1].bindStorage(BINDING_CLUSTER_INFO_IN);
    clusters_[~round & 1].buffer().bindStorage(BINDING_CLUSTERS_OUT);
    cluster_info_[~round & 1].bindStorage(BINDING_CLUSTER_INFO_OUT);
    for (const Program* program : {&nearest_program_, &count_program_, &scan_program_, &write_program_})
      program->set(LOCATION_ROUND_INDEX, round);
    nearest_program_.dispatchIndirect(rounds_, record + ROUND_CLUSTER_GROUPS * kUint);
    count_program_.dispatchIndirect(rounds_, record + ROUND_CHUNK_GROUPS * kUint);
    scan_program_.dispatch(1);
    write_program_.dispatchIndirect(rounds_, record + ROUND_CHUNK_GROUPS * kUint);
  }
  std::vector<std::uint32_t> rounds(std::size_t{BUILD_ROUNDS + 1} * ROUND_STRIDE);
  rounds_.read(rounds.data(), rounds.size() * kUint);
  const std::uint32_t remaining = rounds[BUILD_ROUNDS * ROUND_STRIDE + ROUND_CLUSTERS];
  if (remaining != mesh_count)
    throw Error("the GPU built " + std::to_string(remaining) + " subtrees instead of " + std::to_string(mesh_count) +
                " trees: its compute shaders do not work as OpenGL specifies; choose another device");
  // A round without pairs may come before one with pairs: two nearest neighbours need not agree on a device whose
  // rounding varies.
  std::uint32_t levels = 0;
  for (std::uint32_t round = 0; round < BUILD_ROUNDS; ++round)
    if (rounds[round * ROUND_STRIDE + ROUND_PAIRS] > 0)
      levels = round + 1;
  return levels;
}

void GpuForestBuilder::layOut(std::size_t mesh_count, std::uint32_t leaf_size, const ForestRegion& region,
                              const TexelBuffer& nodes, const Buffer& leaf_order)
{
  pair_starts_.reserve((region.primitive_count - mesh_count) * kUint);
  clusters_[0].buffer().bindStorage(BINDING_CLUSTERS_EVEN);
  clusters_[1].buffer().bindStorage(BINDING_CLUSTERS_ODD);
  rounds_.bindStorage(BINDING_ROUNDS);
  first_primitive_.bindStorage(BINDING_FIRST_PRIMITIVE);
  pair_starts_.bindStorage(BINDING_PAIR_STARTS);
  nodes.buffer().bindStorage(BINDING_NODES);
  leaf_order.bindStorage(BINDING_LEAF_ORDER);
  for (const Program* program : {&layout_roots_program_, &layout_pairs_program_})
  {
    program->set(LOCATION_ROOT_BASE, region.first_node);
    program->set(LOCATION_LEAF_SIZE, leaf_size);
    program->set(LOCATION_PRIMITIVE_BASE, region.first_primitive);
  }
  layout_roots_program_.set(LOCATION_MESH_COUNT, static_cast<std::uint32_t>(mesh_count));
  layout_roots_program_.dispatch(groupsFor(mesh_count));
  pairs_.bindStorage(BINDING_PAIRS);
  layout_pairs_program_.set(LOCATION_MESH_COUNT, static_cast<std::uint32_t>(mesh_count));
  for (std::uint32_t round = BUILD_ROUNDS; round-- > 0;)
  {
    layout_pairs_program_.set(LOCATION_ROUND_INDEX, round);
    layout_pairs_program_.dispatchIndirect(rounds_, (round * ROUND_STRIDE + ROUND_PAIR_GROUPS) * kUint);
  }
}
}  // namespace gpu_planning_scene::core
