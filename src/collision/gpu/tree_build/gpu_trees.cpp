#include "collision/gpu/tree_build/gpu_trees.h"

#include <algorithm>
#include <stdexcept>
#include <unordered_map>

#include "gpu_planning_scene/error.h"
#include "shader_constants.h"

// New trees are appended to the buffers, so existing ones need not be moved. If too much memory is unused, all trees
// are dropped and the current ones are built again. New trees are read back and checked on the CPU. Own method.
namespace gpu_planning_scene::core
{
namespace
{
/// Unused trees are dropped when they have more triangles than the used trees plus this number.
constexpr std::size_t kFewTriangles = 65536;

/// Meshes are built together up to this number of triangles, so that a dispatch takes about 50 ms on llvmpipe and the
/// work space stays small. A larger mesh is built alone.
constexpr std::size_t kTrianglesAtOnce = std::size_t{1} << 18U;

static_assert(static_cast<unsigned>(TriangleRole::Surface) == ROLE_SURFACE &&
                  static_cast<unsigned>(TriangleRole::Winding) == ROLE_WINDING &&
                  static_cast<unsigned>(TriangleRole::Parity) == ROLE_PARITY && ROLES_PER_WORD * ROLE_BITS == 32,
              "the shaders read roles");
/// The roles and components of a shape's triangles. Those of a primitive are a closed mesh.
std::shared_ptr<const SolidMesh> solidOf(const Tessellation& shape)
{
  if (shape.solid)
    return shape.solid;
  std::shared_ptr<const SolidMesh> solid = solidMeshOf(shape.mesh);
  if (solid->mesh != shape.mesh)
    throw std::logic_error("the tessellation of mesh '" + shape.mesh->name + "' lacks its solid; use tessellate()");
  return solid;
}
}  // namespace

void GpuTrees::setShapes(const std::vector<Tessellation>& shapes)
{
  std::unordered_map<const Mesh*, std::uint32_t> uses;
  std::vector<Key> keys;
  keys.reserve(shapes.size());
  for (const Tessellation& shape : shapes)
    keys.emplace_back(shape.mesh.get(), uses[shape.mesh.get()]++);
  if (keys == keys_)
    return;
  try
  {
    std::vector<Key> missing = claim(keys, shapes);
    std::size_t live = 0;
    for (const auto& [key, entry] : entries_)
      live += entry.mesh->triangles.size();
    std::size_t added = 0;
    for (const Key& key : missing)
      added += key.first->triangles.size();
    if (primitive_count_ + added > 2 * live + kFewTriangles)
    {
      clear();
      missing = claim(keys, shapes);
    }
    for (auto begin = missing.cbegin(); begin != missing.cend();)
    {
      auto end = begin;
      for (std::size_t triangles = 0; end != missing.cend(); ++end)
      {
        triangles += end->first->triangles.size();
        if (end != begin && triangles > kTrianglesAtOnce)
          break;
      }
      build({begin, end});
      begin = end;
    }
  }
  catch (...)
  {
    clear();
    throw;
  }
  chosen_.clear();
  for (const Key& key : keys)
    chosen_.push_back(&entries_.at(key));
  keys_ = std::move(keys);
}

std::vector<GpuTrees::Key> GpuTrees::claim(const std::vector<Key>& keys, const std::vector<Tessellation>& shapes)
{
  for (auto& [key, entry] : entries_)
    entry.used = false;
  std::vector<Key> missing;
  for (std::size_t i = 0; i < keys.size(); ++i)
  {
    const auto [entry, is_new] = entries_.try_emplace(keys[i]);
    entry->second.used = true;
    if (is_new)
    {
      entry->second.mesh = shapes[i].mesh;
      entry->second.solid = solidOf(shapes[i]);
      missing.push_back(keys[i]);
    }
  }
  for (auto entry = entries_.begin(); entry != entries_.end();)
    entry = entry->second.used ? std::next(entry) : entries_.erase(entry);
  return missing;
}

void GpuTrees::clear()
{
  entries_.clear();
  keys_.clear();
  chosen_.clear();
  builds_.clear();
  component_records_.clear();
  role_bits_.clear();
  node_count_ = primitive_count_ = reserved_first_ = 0;
  reserved_ = 0;
  depth_ = 1;
}

void GpuTrees::build(const std::vector<Key>& keys)
{
  ForestRegion region;
  region.first_node = node_count_;
  region.first_primitive = primitive_count_;
  std::vector<const Mesh*> meshes;
  for (const Key& key : keys)
    meshes.push_back(key.first);
  builder_.buildTriangles(meshes, region, nodes_, leaf_order_, triangles_);
  oriented_boxes_.fit(region, nodes_, triangles_, oriented_nodes_);
  if (const std::string fault = faultOf(read(region), meshes); !fault.empty())
    throw Error("the GPU built wrong trees (" + fault +
                "): its driver does not work as OpenGL specifies; choose another device");

  std::uint32_t root = region.first_node;
  std::uint32_t triangle = region.first_primitive;
  role_bits_.resize((region.first_primitive + region.primitive_count) / ROLES_PER_WORD + 1, 0);
  for (const Key& key : keys)
  {
    Entry& entry = entries_.at(key);
    entry.build = builds_.size();
    entry.first_triangle = triangle;
    entry.tree.root = root++;
    addComponents(entry);
    triangle += static_cast<std::uint32_t>(key.first->triangles.size());
  }
  components_.reserve(component_records_.size() * sizeof(component_records_.front()));
  components_.write(component_records_);
  triangle_roles_.reserve(role_bits_.size() * sizeof(std::uint32_t));
  triangle_roles_.write(role_bits_);

  builds_.push_back(region);
  node_count_ += region.node_count;
  primitive_count_ += region.primitive_count;
  depth_ = std::max(depth_, region.depth);
}

BuiltTrees GpuTrees::read(const ForestRegion& region) const
{
  BuiltTrees trees;
  trees.region = region;
  const auto read = [](const Buffer& from, std::size_t first, std::size_t count, auto& to)
  {
    constexpr std::size_t kBytes = sizeof(to.front());
    to.resize(count);
    from.read(to.data(), count * kBytes, first * kBytes);
  };
  constexpr std::size_t kFloats = TRIANGLE_TEXELS * TexelBuffer::kTexelBytes / sizeof(float);
  read(nodes_.buffer(), region.first_node, region.node_count, trees.nodes);
  read(oriented_nodes_.buffer(), region.first_node, region.node_count, trees.oriented);
  read(leaf_order_, region.first_primitive, region.primitive_count, trees.leaf_order);
  read(triangles_.buffer(), region.first_primitive * kFloats, region.primitive_count * kFloats, trees.corners);
  return trees;
}

void GpuTrees::addComponents(Entry& entry)
{
  const SolidMesh& solid = *entry.solid;
  entry.tree.has_solid = solid.hasSolid();
  entry.tree.first_component = static_cast<std::uint32_t>(component_records_.size());
  for (const Component& part : solid.components)
    entry.tree.bounds.extend(part.bounds);
  if (solid.components.size() <= MAX_COMPONENTS)
  {
    entry.tree.component_count = static_cast<std::uint32_t>(solid.components.size());
    for (const Component& part : solid.components)
    {
      const Eigen::Vector3f point = part.point.cast<float>();
      const auto size = static_cast<float>((1.0 - 1e-6) * part.bounds.sizes().maxCoeff());
      component_records_.push_back({point.x(), point.y(), point.z(), size});
    }
  }
  for (std::size_t i = 0; i < solid.roles.size(); ++i)
  {
    const std::size_t number = entry.first_triangle + i;
    role_bits_[number / ROLES_PER_WORD] |= static_cast<std::uint32_t>(solid.roles[i])
                                           << (ROLE_BITS * (number % ROLES_PER_WORD));
  }
}

std::uint32_t GpuTrees::placeNodes(const std::vector<Node>& nodes)
{
  const std::size_t count = nodes.size();
  if (count > reserved_)
  {
    nodes_.reserve((std::size_t{node_count_} + 2 * count) * sizeof(Node));
    oriented_nodes_.reserve((std::size_t{node_count_} + 2 * count) * sizeof(OrientedNode));
    reserved_first_ = node_count_;
    reserved_ = 2 * count;
    node_count_ += static_cast<std::uint32_t>(reserved_);
  }
  std::vector<OrientedNode> oriented;
  oriented.reserve(count);
  for (const Node& node : nodes)
    oriented.push_back({node.center, node.first, node.half, node.count, {0.0F, 0.0F, 0.0F, 1.0F}});
  nodes_.buffer().write(nodes.data(), count * sizeof(Node), reserved_first_ * sizeof(Node));
  oriented_nodes_.buffer().write(oriented.data(), count * sizeof(OrientedNode), reserved_first_ * sizeof(OrientedNode));
  return reserved_first_;
}

Forest GpuTrees::readForest(const std::vector<std::size_t>& numbers) const
{
  Forest forest;
  struct Place
  {
    std::uint32_t first_node;
    std::uint32_t first_leaf;
  };
  std::map<std::size_t, Place> places;  // key: build; value: its place in the forest
  for (const std::size_t number : numbers)
  {
    const Entry& entry = *chosen_[number];
    const ForestRegion& region = builds_[entry.build];
    const auto [place, is_new] =
        places.try_emplace(entry.build, Place{static_cast<std::uint32_t>(forest.nodes.size()),
                                              static_cast<std::uint32_t>(forest.leaf_triangles.size())});
    const auto [first_node, first_leaf] = place->second;
    if (is_new)
    {
      forest.nodes.resize(first_node + region.node_count);
      nodes_.buffer().read(&forest.nodes[first_node], region.node_count * sizeof(Node),
                           region.first_node * sizeof(Node));
      for (auto node = forest.nodes.begin() + first_node; node != forest.nodes.end(); ++node)
        node->first = node->count == 0 ? node->first - region.first_node + first_node
                                       : node->first - region.first_primitive + first_leaf;
      forest.leaf_triangles.resize(first_leaf + region.primitive_count);
      leaf_order_.read(&forest.leaf_triangles[first_leaf], region.primitive_count * sizeof(std::uint32_t),
                       region.first_primitive * sizeof(std::uint32_t));
    }
    forest.roots.push_back(entry.tree.root - region.first_node + first_node);
    forest.first_triangle.push_back(entry.first_triangle);
  }
  return forest;
}
}  // namespace gpu_planning_scene::core
