#include "collision/gpu_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <tuple>
#include <utility>

#include "collision/components.h"
#include "collision/primitive_solid.h"
#include "gpu_planning_scene/error.h"
#include "interface.h"

namespace gpu_planning_scene
{
namespace
{
/// The box of a shape's triangles, grown by its sagitta.
Eigen::AlignedBox3d localBounds(const Tessellation& tree)
{
  Eigen::AlignedBox3d box;
  for (const auto& triangle : tree.mesh->triangles)
    for (const std::uint32_t corner : triangle)
      box.extend(tree.mesh->vertices[corner]);
  const Eigen::Vector3d sagitta = Eigen::Vector3d::Constant(tree.sagitta);
  return {box.min() - sagitta, box.max() + sagitta};
}

/// A box that holds `box` moved by `pose` and grown by `padding`, rounded outward to float.
Eigen::AlignedBox3f movedBounds(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& pose, double padding)
{
  const Eigen::Vector3d center = pose * box.center();
  const Eigen::Vector3d half = pose.linear().cwiseAbs() * (box.sizes() / 2.0);
  Eigen::AlignedBox3f moved;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double slop = padding + 1e-12 * (std::abs(center[axis]) + half[axis]);
    moved.min()[axis] =
        std::nextafter(static_cast<float>(center[axis] - half[axis] - slop), -std::numeric_limits<float>::infinity());
    moved.max()[axis] =
        std::nextafter(static_cast<float>(center[axis] + half[axis] + slop), std::numeric_limits<float>::infinity());
  }
  return moved;
}

/// An instance as shaders/instances.glsl reads it.
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
static_assert(sizeof(InstanceRecord) == 48, "three uvec4");

/// Fills in what the shaders know of a solid. Its core is a box around the origin that lies within it: what lies in the
/// box is inside without any look at the surface.
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
  else if (const auto* cone = std::get_if<Cone>(&shape))
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

/// A bit for each flag, 32 to a word.
void writeBits(const std::vector<std::uint8_t>& flags, Buffer& buffer)
{
  std::vector<std::uint32_t> bits(flags.size() / 32 + 1, 0);
  for (std::size_t i = 0; i < flags.size(); ++i)
    if (flags[i])
      bits[i / 32] |= 1U << (i % 32);
  buffer.reserve(bits.size() * sizeof(std::uint32_t));
  buffer.write(bits);
}

bool sameShapes(const std::vector<Shape>& a, const std::vector<Shape>& b)
{
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), sameShape);
}

std::vector<const Mesh*> meshes(const std::vector<Tessellation>& trees, std::size_t begin, std::size_t end)
{
  std::vector<const Mesh*> found;
  for (std::size_t i = begin; i < end; ++i)
    found.push_back(trees[i].mesh.get());
  return found;
}

/// The shapes that the robot's instances use; makeProblem numbers their trees first.
std::vector<Shape> robotShapes(const CollisionProblem& problem)
{
  std::size_t count = 0;
  for (const Geometry& geometry : problem.robot)
    count = std::max<std::size_t>(count, geometry.tree + 1);
  return {problem.shapes.begin(), problem.shapes.begin() + static_cast<std::ptrdiff_t>(count)};
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
  if (problem.robot.size() > MAX_ROBOT_GEOMETRIES ||
      problem.robot.size() + problem.world.size() + problem.half_spaces.size() > MAX_GEOMETRIES)
    throw Error(std::to_string(problem.robot.size()) + " shapes of the robot and " +
                std::to_string(problem.world.size()) + " of the world are more than " +
                std::to_string(MAX_ROBOT_GEOMETRIES) + " and " + std::to_string(MAX_GEOMETRIES) + "; merge meshes");
  robot_count_ = static_cast<std::uint32_t>(problem.robot.size());
  world_count_ = static_cast<std::uint32_t>(problem.world.size());
  buildShapeTrees(problem);
  buildWorldTree(problem);
  writeGeometries(problem);
  writeHalfSpaces(problem);
  selectPairs(problem);
}

void GpuScene::buildShapeTrees(const CollisionProblem& problem)
{
  std::vector<Shape> shapes = robotShapes(problem);
  trees_ = problem.trees.size();
  if (!sameShapes(shapes, robot_shapes_))
  {
    robot_shapes_.clear();
    robot_region_ = {};
    if (!shapes.empty())
      builder_.buildTriangles(meshes(problem.trees, 0, shapes.size()), robot_region_, nodes_, leaf_order_, triangles_);
    robot_shapes_ = std::move(shapes);
  }
  shape_region_ = {};
  shape_region_.first_node = robot_region_.node_count;
  shape_region_.first_primitive = robot_region_.primitive_count;
  if (trees_ > robot_shapes_.size())
    builder_.buildTriangles(meshes(problem.trees, robot_shapes_.size(), trees_), shape_region_, nodes_, leaf_order_,
                            triangles_);
  depth_bound_ = std::max({1U, robot_region_.depth, shape_region_.depth});
  first_triangle_.clear();
  std::uint32_t triangle = 0;
  for (const Tessellation& tree : problem.trees)
  {
    first_triangle_.push_back(triangle);
    triangle += static_cast<std::uint32_t>(tree.mesh->triangles.size());
  }
  triangle_count_ = triangle;
}

std::uint32_t GpuScene::rootOf(std::size_t tree) const
{
  const std::size_t robot_trees = robot_shapes_.size();
  return static_cast<std::uint32_t>(tree < robot_trees ? tree : shape_region_.first_node + tree - robot_trees);
}

/// The components of all trees as shaders/components.glsl reads them, and which triangles bound solids.
GpuScene::ComponentRanges GpuScene::writeComponents(const CollisionProblem& problem)
{
  std::vector<std::array<float, 4>> records;
  std::vector<std::uint8_t> bounds_solid(triangle_count_, 0);
  ComponentRanges ranges;
  has_mesh_solids_ = false;
  for (std::size_t tree = 0; tree < trees_; ++tree)
  {
    const MeshComponents parts = findComponents(*problem.trees[tree].mesh);
    const bool known = parts.components.size() <= MAX_COMPONENTS;
    ranges.push_back({static_cast<std::uint32_t>(records.size()),
                      known ? static_cast<std::uint32_t>(parts.components.size()) : 0U,
                      isMesh(problem.shapes[tree]) && parts.hasSolid()});
    has_mesh_solids_ = has_mesh_solids_ || ranges.back().mesh_solid;
    if (known)
      for (const Component& part : parts.components)
      {
        const Eigen::Vector3f point = part.point.cast<float>();
        const auto size = static_cast<float>((1.0 - 1e-6) * part.bounds.sizes().maxCoeff());
        records.push_back({point.x(), point.y(), point.z(), size});
      }
    std::copy(parts.bounds_solid.begin(), parts.bounds_solid.end(), bounds_solid.begin() + first_triangle_[tree]);
  }
  components_.reserve(records.size() * sizeof(records.front()));
  components_.write(records);
  writeBits(bounds_solid, solid_triangles_);
  return ranges;
}

void GpuScene::writeGeometries(const CollisionProblem& problem)
{
  const ComponentRanges components = writeComponents(problem);
  padded_ = false;
  std::vector<InstanceRecord> geometries;
  for (const std::vector<Geometry>* instances : {&problem.robot, &problem.world})
    for (const Geometry& geometry : *instances)
    {
      const double sagitta = problem.trees[geometry.tree].sagitta;
      InstanceRecord record{};
      record.root = rootOf(geometry.tree);
      record.slack = sagitta > 0.0 ? std::nextafter(static_cast<float>(sagitta), 1.0F) : 0.0F;
      record.first_component = components[geometry.tree].first;
      record.component_count = components[geometry.tree].count;
      record.padding = static_cast<float>(geometry.padding);
      padded_ = padded_ || geometry.padding > 0.0;
      describeSolid(problem.shapes[geometry.tree], record);
      if (components[geometry.tree].mesh_solid)
        record.kind = SOLID_MESH;
      geometries.push_back(record);
    }
  geometries_.reserve(geometries.size() * sizeof(InstanceRecord));
  geometries_.write(geometries);
}

void GpuScene::writeHalfSpaces(const CollisionProblem& problem)
{
  half_space_count_ = static_cast<std::uint32_t>(problem.half_spaces.size());
  std::vector<std::array<float, 4>> records;
  for (const WorldHalfSpace& half_space : problem.half_spaces)
  {
    const Eigen::Vector3f normal = half_space.normal.cast<float>();
    const auto offset = static_cast<float>(half_space.offset - half_space.normal.dot(problem.origin));
    records.push_back({normal.x(), normal.y(), normal.z(), offset});
    records.push_back({static_cast<float>(half_space.padding), 0.0F, 0.0F, 0.0F});
  }
  half_spaces_.reserve(records.size() * sizeof(std::array<float, 4>));
  half_spaces_.write(records);
}

void GpuScene::buildWorldTree(const CollisionProblem& problem)
{
  if (world_count_ == 0)
    return;
  std::vector<Eigen::AlignedBox3d> local;
  for (const Tessellation& tree : problem.trees)
    local.push_back(localBounds(tree));
  std::vector<Eigen::AlignedBox3f> bounds;
  std::vector<float> poses(12 * problem.world.size());
  for (std::size_t i = 0; i < problem.world.size(); ++i)
  {
    const Geometry& object = problem.world[i];
    const Eigen::Isometry3d pose = Eigen::Translation3d(-problem.origin) * object.pose;
    bounds.push_back(movedBounds(local[object.tree], pose, object.padding));
    writePoseRows(pose, &poses[12 * i]);
  }
  world_poses_.reserve(poses.size() * sizeof(float));
  world_poses_.buffer().write(poses);
  ForestRegion region;
  region.first_node = shape_region_.first_node + shape_region_.node_count;
  builder_.buildBoxes(bounds, region, nodes_, world_order_);
  world_root_ = region.first_node;
}

void GpuScene::selectPairs(const CollisionProblem& problem)
{
  // Offsets of each robot instance's partners, then the partners; a pair is with its lower instance.
  std::vector<std::vector<std::uint32_t>> of(robot_count_);
  for (const auto& pair : problem.self_pairs)
    of[std::min(pair[0], pair[1])].push_back(std::max(pair[0], pair[1]));
  std::vector<std::uint32_t> partners(robot_count_ + 1, 0);
  for (std::uint32_t i = 0; i < robot_count_; ++i)
    partners[i + 1] = partners[i] + static_cast<std::uint32_t>(of[i].size());
  for (const auto& list : of)
    partners.insert(partners.end(), list.begin(), list.end());
  partners_.reserve(partners.size() * sizeof(std::uint32_t));
  partners_.write(partners);
  has_self_pairs_ = !problem.self_pairs.empty();

  writeBits(problem.world_pairs, world_pairs_);
  writeBits(problem.half_space_pairs, half_space_pairs_);
}

void GpuScene::bind() const
{
  nodes_.bindTexture(UNIT_NODES);
  triangles_.bindTexture(UNIT_TRIANGLES);
  world_poses_.bindTexture(UNIT_WORLD_POSES);
  geometries_.bindStorage(BINDING_GEOMETRIES);
}

Forest GpuScene::readForest() const
{
  Forest forest;
  forest.nodes.resize(shape_region_.first_node + shape_region_.node_count);
  nodes_.buffer().read(forest.nodes.data(), forest.nodes.size() * sizeof(Node));
  forest.leaf_triangles.resize(shape_region_.first_primitive + shape_region_.primitive_count);
  leaf_order_.read(forest.leaf_triangles.data(), forest.leaf_triangles.size() * sizeof(std::uint32_t));
  // The world's shapes are numbered from 0 in their own forest.
  for (std::size_t i = shape_region_.first_primitive; i < forest.leaf_triangles.size(); ++i)
    forest.leaf_triangles[i] += shape_region_.first_primitive;
  forest.first_triangle = first_triangle_;
  for (std::size_t i = 0; i < trees_; ++i)
    forest.roots.push_back(rootOf(i));
  return forest;
}
}  // namespace gpu_planning_scene
