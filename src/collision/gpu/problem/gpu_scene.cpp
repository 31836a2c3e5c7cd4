#include "collision/gpu/problem/gpu_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "collision/geometry/outward_rounding.h"
#include "collision/geometry/primitive_solid.h"
#include "gpu_planning_scene/error.h"
#include "shader_constants.h"

// Uploads a problem as flat arrays of records. The tree over the world's objects lies in depth-first order with skip
// pointers, so that its traversal needs no stack (B. Smits: Efficiency Issues for Ray Tracing, 1998).
namespace gpu_planning_scene::core
{
namespace
{
/// The axis-aligned box of an instance's exact surface, grown by its padding and by more than the rounding error.
Eigen::AlignedBox3d placedBounds(const Eigen::AlignedBox3d& triangles, double sagitta, const Eigen::Isometry3d& pose,
                                 double padding)
{
  const Eigen::Vector3d center = pose * triangles.center();
  const Eigen::Vector3d half =
      pose.linear().cwiseAbs() * (triangles.sizes() / 2.0 + Eigen::Vector3d::Constant(sagitta));
  const Eigen::Vector3d grown = half + Eigen::Vector3d::Constant(padding) + 1e-12 * (center.cwiseAbs() + half);
  return {center - grown, center + grown};
}

/// An instance in the layout of shaders/problem/instances.glsl.
struct InstanceRecord
{
  std::uint32_t root;
  float slack;
  std::uint32_t first_component;
  std::uint32_t component_count;
  std::array<float, 3> core;
  std::uint32_t kind;
  std::array<float, 3> size;
  float padding;
};
static_assert(sizeof(InstanceRecord) == INSTANCE_TEXELS * TexelBuffer::kTexelBytes, "the layout of the shaders");

/// Fills in the description of a solid for the shaders. Its core is a box around the origin that lies inside the solid.
/// A point in the core is inside the solid without a test of the surface.
void describeSolid(const Shape& shape, InstanceRecord& record)
{
  constexpr double kRounding = 1.0 - 1e-6;
  Eigen::Vector3d core = Eigen::Vector3d::Constant(-1.0);
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  record.kind = SOLID_NONE;
  if (const auto* box = std::get_if<Box>(&shape))
  {
    record.kind = SOLID_BOX;
    core = size = box->size / 2.0;
  }
  else if (const auto* sphere = std::get_if<Sphere>(&shape))
  {
    record.kind = SOLID_SPHERE;
    size.setConstant(sphere->radius);
    core = size / std::sqrt(3.0);
  }
  else if (const auto* cylinder = std::get_if<Cylinder>(&shape))
  {
    record.kind = SOLID_CYLINDER;
    size = {cylinder->radius, cylinder->radius, cylinder->length / 2.0};
    core = {cylinder->radius / std::sqrt(2.0), cylinder->radius / std::sqrt(2.0), cylinder->length / 2.0};
  }
  // The slopes of a thinner cone may overflow or vanish in float32. Its triangles are tested instead.
  else if (const auto* cone = std::get_if<Cone>(&shape); cone && std::min(cone->radius, cone->length) > 1e-12)
  {
    record.kind = SOLID_CONE;
    size = {cone->radius, cone->radius, cone->length / 2.0};
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    record.core[axis] = static_cast<float>(kRounding * core[static_cast<Eigen::Index>(axis)]);
    record.size[axis] = static_cast<float>(size[static_cast<Eigen::Index>(axis)]);
  }
}

/// Packs the flags into the bits of words, padded to whole texels.
std::vector<std::uint32_t> packedBits(const std::vector<std::uint8_t>& flags)
{
  constexpr std::size_t kWordBits = 32;
  std::vector<std::uint32_t> bits((flags.size() / (TEXEL_WORDS * kWordBits) + 1) * TEXEL_WORDS, 0);
  for (std::size_t i = 0; i < flags.size(); ++i)
    if (flags[i])
      bits[i / kWordBits] |= 1U << (i % kWordBits);
  return bits;
}

template <class T>
void write(const std::vector<T>& data, TexelBuffer& buffer)
{
  buffer.reserve(data.size() * sizeof(T));
  buffer.buffer().write(data);
}

/// A node of the tree over objects in the layout of shaders/broad_phase/world_pairs.comp.
struct ObjectNode
{
  std::array<float, 3> center;
  std::uint32_t next;  // node at which the traversal continues if the boxes do not overlap
  std::array<float, 3> half;
  std::uint32_t object;
};
static_assert(sizeof(ObjectNode) == OBJECT_NODE_TEXELS * TexelBuffer::kTexelBytes, "the layout of the shaders");

/// Appends a subtree in depth-first order. The boxes are enlarged by the rounding error of the box test in
/// shaders/broad_phase/world_pairs.comp ("Broad phases" in docs/error_bounds.md). The recursion depth is bounded, see
/// buildBinnedSah.
void appendSubtree(const ObjectTree& tree, std::uint32_t root, std::vector<ObjectNode>& walk)
{
  const Node& node = tree.nodes()[root];
  ObjectNode made{node.center, 0, node.half, node.count == 0 ? NO_OBJECT : tree.order()[node.first]};
  for (float& half : made.half)
    half = half * (1.0F + 4.0F * std::numeric_limits<float>::epsilon()) + 1e-37F;
  const std::size_t place = walk.size();
  walk.push_back(made);
  if (node.count == 0)
  {
    appendSubtree(tree, node.first, walk);
    appendSubtree(tree, node.first + 1, walk);
  }
  walk[place].next = static_cast<std::uint32_t>(walk.size());
}
}  // namespace

void writePoseRows(const Eigen::Isometry3d& pose, float* rows)
{
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      rows[4 * row + column] = static_cast<float>(pose(row, column));
}

void GpuScene::setProblem(const CollisionProblem& problem)
{
  if (problem.robot.size() > MAX_ROBOT_INSTANCES ||
      problem.robot.size() + problem.world.size() + problem.half_spaces.size() > MAX_INSTANCES)
    throw Error(std::to_string(problem.robot.size()) + " shapes of the robot and " +
                std::to_string(problem.world.size()) + " of the world exceed the limits (" +
                std::to_string(MAX_ROBOT_INSTANCES) + " for the robot, " + std::to_string(MAX_INSTANCES) +
                " for all shapes and half-spaces together); merge meshes");
  robot_count_ = static_cast<std::uint32_t>(problem.robot.size());
  world_count_ = static_cast<std::uint32_t>(problem.world.size());
  trees_.setShapes(problem.tessellations);
  tree_count_ = problem.tessellations.size();
  writeWorld(problem);
  writeInstances(problem);
  writeSolids(problem);
  writeHalfSpaces(problem);
  selectPairs(problem);
}

void GpuScene::writeInstances(const CollisionProblem& problem)
{
  padded_ = false;
  has_mesh_solids_ = false;
  std::vector<InstanceRecord> records;
  for (const std::vector<ShapeInstance>* instances : {&problem.robot, &problem.world})
    for (const ShapeInstance& instance : *instances)
    {
      const double sagitta = problem.tessellations[instance.tree].sagitta;
      InstanceRecord record{};
      const GpuTrees::Tree& tree = trees_.tree(instance.tree);
      record.root = tree.root;
      record.slack = sagitta > 0.0 ? floatAbove(sagitta) : 0.0F;
      record.first_component = tree.first_component;
      record.component_count = tree.component_count;
      record.padding = static_cast<float>(instance.padding);
      padded_ = padded_ || instance.padding > 0.0;
      describeSolid(problem.shapes[instance.tree], record);
      if (tree.has_solid && isMesh(problem.shapes[instance.tree]))
      {
        record.kind = SOLID_MESH;
        has_mesh_solids_ = true;
      }
      records.push_back(record);
    }
  write(records, instances_);
}

/// Writes a node for each instance. The node of a primitive is a leaf that contains the whole primitive.
void GpuScene::writeSolids(const CollisionProblem& problem)
{
  solid_nodes_ = 0;
  if (!problem.direct_primitives)
    return;
  std::vector<Node> nodes;
  for (const std::vector<ShapeInstance>* instances : {&problem.robot, &problem.world})
    for (const ShapeInstance& instance : *instances)
    {
      const Shape& shape = problem.shapes[instance.tree];
      Node node{};
      if (!isMesh(shape))
      {
        setBox({-halfExtents(shape), halfExtents(shape)}, node);
        node.first = SOLID_LEAF | static_cast<std::uint32_t>(nodes.size());
        node.count = 1;
      }
      nodes.push_back(node);
    }
  solid_nodes_ = trees_.placeNodes(nodes);
}

void GpuScene::writeHalfSpaces(const CollisionProblem& problem)
{
  half_space_count_ = static_cast<std::uint32_t>(problem.half_spaces.size());
  using Record = std::array<std::array<float, 4>, HALF_SPACE_TEXELS>;
  std::vector<Record> records;
  for (const WorldHalfSpace& half_space : problem.half_spaces)
  {
    const Eigen::Vector3f normal = half_space.normal.cast<float>();
    const auto offset = static_cast<float>(half_space.offset - half_space.normal.dot(problem.origin));
    const auto padding = static_cast<float>(half_space.padding);
    records.push_back({{{normal.x(), normal.y(), normal.z(), offset}, {padding, 0.0F, 0.0F, 0.0F}}});
  }
  half_spaces_.reserve(records.size() * sizeof(Record));
  half_spaces_.write(records);
}

void GpuScene::writeWorld(const CollisionProblem& problem)
{
  std::vector<Eigen::AlignedBox3d> bounds;
  std::vector<float> poses(POSE_FLOATS * problem.world.size());
  for (std::size_t i = 0; i < problem.world.size(); ++i)
  {
    const ShapeInstance& object = problem.world[i];
    const Eigen::Isometry3d pose = Eigen::Translation3d(-problem.origin) * object.pose;
    bounds.push_back(placedBounds(trees_.tree(object.tree).bounds, problem.tessellations[object.tree].sagitta, pose,
                                  object.padding));
    writePoseRows(pose, &poses[POSE_FLOATS * i]);
  }
  object_tree_ = ObjectTree(std::move(bounds), object_tree_);
  write(poses, world_poses_);

  std::vector<ObjectNode> walk;
  if (world_count_ > 0)
    appendSubtree(object_tree_, 0, walk);
  write(walk, object_nodes_);
}

void GpuScene::selectPairs(const CollisionProblem& problem)
{
  write(packedBits(problem.world_pairs), world_pairs_);
  const std::vector<std::uint32_t> half_space_bits = packedBits(problem.half_space_pairs);
  half_space_pairs_.reserve(half_space_bits.size() * sizeof(std::uint32_t));
  half_space_pairs_.write(half_space_bits);
}

void GpuScene::bind() const
{
  trees_.nodes().bindTexture(UNIT_NODES);
  trees_.orientedNodes().bindTexture(UNIT_ORIENTED_NODES);
  trees_.triangles().bindTexture(UNIT_TRIANGLES);
  world_poses_.bindTexture(UNIT_WORLD_POSES);
  instances_.bindTexture(UNIT_INSTANCES);
  object_nodes_.bindTexture(UNIT_OBJECT_TREE);
  world_pairs_.bindTexture(UNIT_WORLD_PAIRS);
}

Forest GpuScene::readForest() const
{
  std::vector<std::size_t> numbers(tree_count_);
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  return trees_.readForest(numbers);
}
}  // namespace gpu_planning_scene::core
