#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <map>
#include <mutex>
#include <numeric>
#include <utility>

#include "gpu_planning_scene/solids.h"
#include "model/solids/disjoint_sets.h"
#include "model/solids/mesh_edges.h"
#include "model/solids/shells.h"
#include "model/solids/surface_closer.h"
#include "model/solids/welding.h"

// Components that are closed as they are need no copy of the mesh. closeSurface gets the triangles of all others.
namespace gpu_planning_scene::core
{
namespace
{
/// Tolerances of the attempts to close a part, as shares of the diagonal of the mesh. Files with float coordinates have
/// errors of a tenth of the first one. The larger ones close cracks.
constexpr std::array<double, 4> kTolerances = {1e-6, 1e-5, 1e-4, 1e-3};

std::vector<Corners> cornersOf(const Mesh& mesh, const Places& places)
{
  std::vector<Corners> corners;
  corners.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    corners.push_back({places.of_vertex[t[0]], places.of_vertex[t[1]], places.of_vertex[t[2]]});
  return corners;
}

/// The triangles' connected components: triangles that share a place are connected.
class TriangleComponents
{
 public:
  TriangleComponents(const std::vector<Corners>& triangles, std::size_t places) : sets_(places)
  {
    for (const Corners& t : triangles)
    {
      sets_.unite(t[0], t[1]);
      sets_.unite(t[1], t[2]);
    }
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> number_of_set(places, kNone);
    of_triangle_.reserve(triangles.size());
    for (const Corners& t : triangles)
    {
      std::uint32_t& number = number_of_set[sets_.find(t[0])];
      if (number == kNone)
        number = count_++;
      of_triangle_.push_back(number);
    }
  }

  std::uint32_t of(std::size_t triangle) const { return of_triangle_[triangle]; }
  std::size_t count() const { return count_; }

 private:
  DisjointSets sets_;
  std::vector<std::uint32_t> of_triangle_;
  std::uint32_t count_ = 0;
};

/// The corners of a triangle added up. Two triangles with a common edge have the same sum if they have the same
/// corners.
std::uint64_t sumOf(const Corners& corners)
{
  return std::accumulate(corners.begin(), corners.end(), std::uint64_t{0});
}

/// For each component: whether each of its edges belongs to two triangles of opposite direction. A triangle and its
/// back side bound nothing: they may be a part of a surface from which rounding separates them.
std::vector<bool> closedComponents(const std::vector<Corners>& triangles, const std::vector<EdgeUse>& uses,
                                   const TriangleComponents& components)
{
  std::vector<bool> closed(components.count(), false);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (hasDistinctCorners(triangles[t]))
      closed[components.of(t)] = true;
  visitEdges(uses,
             [&](auto first, auto last)
             {
               if (last - first != 2 || first[0].upwards == first[1].upwards ||
                   sumOf(triangles[first[0].triangle]) == sumOf(triangles[first[1].triangle]))
                 closed[components.of(first->triangle)] = false;
             });
  return closed;
}

/// A mesh to which triangles are added, and whose triangles may be turned. Without a change, it is not copied.
class ChangedMesh
{
 public:
  ChangedMesh(std::shared_ptr<const Mesh> mesh, const Places& places)
    : mesh_(std::move(mesh)), places_(places), vertex_at_(places.points.size())
  {
    for (std::size_t i = mesh_->vertices.size(); i-- > 0;)
      vertex_at_[places.of_vertex[i]] = static_cast<std::uint32_t>(i);
  }

  /// Gives the triangle the direction of `corners`, which are its places.
  void turn(std::size_t triangle, const Corners& corners)
  {
    const auto& vertices = mesh_->triangles[triangle];
    if (places_.of_vertex[vertices[1]] != corners[1])
      turn(triangle);
  }

  void turn(std::size_t triangle) { std::swap(copy().triangles[triangle][1], copy().triangles[triangle][2]); }

  void add(const Corners& corners)
  {
    copy().triangles.push_back({vertex_at_[corners[0]], vertex_at_[corners[1]], vertex_at_[corners[2]]});
  }

  const std::shared_ptr<const Mesh>& get() const { return mesh_; }

 private:
  Mesh& copy()
  {
    if (!copy_)
      mesh_ = copy_ = std::make_shared<Mesh>(*mesh_);
    return *copy_;
  }

  std::shared_ptr<const Mesh> mesh_;
  std::shared_ptr<Mesh> copy_;
  const Places& places_;
  std::vector<std::uint32_t> vertex_at_;
};

/// The attempts to close a part: with one tolerance after the other, then with filled holes. So a crack is joined
/// before the hole beside it is filled.
std::vector<Closing> attempts(double diagonal, SolidRule rule)
{
  std::vector<Closing> all;
  for (const double share : kTolerances)
    all.push_back({share * diagonal, share == kTolerances.front() ? WeldedCorners::All : WeldedCorners::OfFreeEdges,
                   false, ConnectedBy::CommonEdges, kSmallHoles});
  for (const ConnectedBy connected : {ConnectedBy::CommonEdges, ConnectedBy::CommonCorners})
    for (const double share : {kTolerances.front(), kTolerances.back()})
      all.push_back({share * diagonal, WeldedCorners::OfFreeEdges, true, connected, kSmallHoles});
  if (rule == SolidRule::Filled)
    all.back().most_share = std::numeric_limits<double>::infinity();
  return all;
}

/// Adds a part that remains a surface because its triangles are smaller than the tolerance.
void addSurface(const Places& places, const std::vector<Corners>& triangles, const std::vector<std::uint32_t>& numbers,
                SolidMesh& solid)
{
  MeshPart part{PartKind::Surface, numbers.size(), {}};
  for (const std::uint32_t t : numbers)
    for (const std::uint32_t place : triangles[t])
      part.bounds.extend(places.points[place]);
  part.hole_share = 1.0;
  solid.parts.other.push_back(part);
}

/// Closes the triangles with the numbers `open`. Returns the cycle of each triangle, see ClosedSurface.
std::vector<std::uint32_t> closeOpenParts(const std::vector<Corners>& triangles, const Places& places, double diagonal,
                                          std::vector<std::uint32_t> open, SolidMesh& solid)
{
  std::vector<std::uint32_t> cycles(triangles.size(), 0);
  std::uint32_t known_cycles = 0;  // of the attempts before
  ChangedMesh mesh(solid.mesh, places);
  const std::vector<Closing> closings = attempts(diagonal, solid.mesh->solid);
  for (const Closing& closing : closings)
  {
    std::vector<Corners> part;
    for (const std::uint32_t t : open)
      part.push_back(triangles[t]);
    const bool is_last = &closing == &closings.back();
    ClosedSurface surface = closeSurface(places.points, part, closing);
    for (std::size_t i = 0; i < surface.triangles.size(); ++i)
    {
      if (surface.roles[i] == TriangleRole::Surface)
        continue;
      if (i < open.size())
      {
        mesh.turn(open[i], surface.triangles[i]);
        solid.roles[open[i]] = surface.roles[i];
        cycles[open[i]] = known_cycles + surface.cycles[i];
      }
      else
      {
        mesh.add(surface.triangles[i]);
        solid.roles.push_back(surface.roles[i]);
        cycles.push_back(known_cycles + surface.cycles[i]);
      }
    }
    known_cycles = *std::max_element(cycles.begin(), cycles.end());
    for (const MeshPart& part_found : surface.parts)
      if (part_found.kind != PartKind::Surface || is_last)
        solid.parts.other.push_back(part_found);
    solid.parts.other.insert(solid.parts.other.end(), surface.uncertain.begin(), surface.uncertain.end());
    std::vector<std::uint32_t> left;
    for (const std::uint32_t t : surface.open)
      left.push_back(open[t]);
    open = std::move(left);
    if (open.empty())
      break;
    if (is_last && surface.parts.empty())
      addSurface(places, triangles, open, solid);
  }
  solid.mesh = mesh.get();
  return cycles;
}

void addComponents(SolidMesh& solid, const std::vector<Corners>& triangles, std::size_t places)
{
  const TriangleComponents components(triangles, places);
  solid.components.resize(components.count(), {Eigen::Vector3d::Zero(), {}, false});
  for (std::size_t t = triangles.size(); t-- > 0;)
  {
    Component& component = solid.components[components.of(t)];
    component.solid = component.solid || solid.roles[t] != TriangleRole::Surface;
    for (const std::uint32_t vertex : solid.mesh->triangles[t])
      component.bounds.extend(solid.mesh->vertices[vertex]);
    component.point = solid.mesh->vertices[solid.mesh->triangles[t][0]];
  }
}

/// Turns the shells that would cancel others. `uses` are those of all triangles, of which `closed` tells whether their
/// component is closed as it is in the file.
void turnShells(const Places& places, const std::vector<Corners>& original, const TriangleComponents& components,
                const std::vector<bool>& closed, const std::vector<EdgeUse>& uses,
                const std::vector<std::uint32_t>& cycles, SolidMesh& solid)
{
  // A closed component shares no edge with other triangles. So the edges of the others suffice, if they were changed.
  const std::vector<Corners> all = cornersOf(*solid.mesh, places);
  const auto is_closed = [&](std::uint32_t t) { return t < original.size() && closed[components.of(t)]; };
  std::vector<EdgeUse> counted_uses;
  std::copy_if(uses.begin(), uses.end(), std::back_inserter(counted_uses),
               [&](const EdgeUse& use) { return is_closed(use.triangle); });
  std::vector<Corners> counted;
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t t = 0; t < all.size(); ++t)
    if (solid.roles[t] == TriangleRole::Winding && !is_closed(t))
    {
      counted.push_back(all[t]);
      numbers.push_back(t);
    }
  for (EdgeUse use : edgeUses(counted))
  {
    use.triangle = numbers[use.triangle];
    counted_uses.push_back(use);
  }
  const std::vector<std::uint32_t> turned = trianglesToTurn(places.points, all, counted_uses, cycles);
  if (turned.empty())
    return;
  ChangedMesh mesh(solid.mesh, places);
  std::map<std::uint32_t, MeshPart> mended;
  for (const std::uint32_t t : turned)
  {
    mesh.turn(t);
    if (is_closed(t))
      mended.try_emplace(components.of(t), MeshPart{PartKind::Mended, 0, {}});
  }
  for (std::size_t t = 0; t < original.size(); ++t)
    if (const auto part = mended.find(components.of(t)); part != mended.end())
    {
      ++part->second.triangles;
      for (const std::uint32_t place : original[t])
        part->second.bounds.extend(places.points[place]);
    }
  for (const auto& [component, part] : mended)
    solid.parts.other.push_back(part);
  solid.parts.closed -= mended.size();
  solid.mesh = mesh.get();
}

SolidMesh makeSolidMesh(const std::shared_ptr<const Mesh>& mesh)
{
  const Places places = placesOf(mesh->vertices);
  const std::vector<Corners> triangles = cornersOf(*mesh, places);
  const TriangleComponents components(triangles, places.points.size());
  SolidMesh solid{mesh, std::vector<TriangleRole>(triangles.size(), TriangleRole::Surface), {}, {}};
  if (mesh->solid != SolidRule::Surface)
  {
    const std::vector<EdgeUse> uses = edgeUses(triangles);
    const std::vector<bool> closed = closedComponents(triangles, uses, components);
    solid.parts.closed = static_cast<std::size_t>(std::count(closed.begin(), closed.end(), true));
    std::vector<std::uint32_t> open;
    Eigen::AlignedBox3d bounds;
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
    {
      for (const std::uint32_t place : triangles[t])
        bounds.extend(places.points[place]);
      if (!closed[components.of(t)])
        open.push_back(t);
      else if (hasDistinctCorners(triangles[t]))
        solid.roles[t] = TriangleRole::Winding;
    }
    const std::vector<std::uint32_t> cycles =
        open.empty() ? std::vector<std::uint32_t>(triangles.size(), 0)
                     : closeOpenParts(triangles, places, bounds.diagonal().norm(), std::move(open), solid);
    turnShells(places, triangles, components, closed, uses, cycles, solid);
  }
  else
  {
    MeshPart whole{PartKind::Surface, triangles.size(), {}};
    for (const Eigen::Vector3d& point : places.points)
      whole.bounds.extend(point);
    solid.parts.other.push_back(whole);
  }
  addComponents(solid, cornersOf(*solid.mesh, places), places.points.size());
  return solid;
}

/// The solids of this process that someone holds, by the address of their original mesh.
class SolidRegistry
{
 public:
  std::shared_ptr<const SolidMesh> find(const std::shared_ptr<const Mesh>& mesh)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = entries_.find(mesh.get());
    // Another mesh may have had the same address.
    return found == entries_.end() || found->second.original.lock() != mesh ? nullptr : found->second.solid.lock();
  }

  void add(const std::shared_ptr<const Mesh>& mesh, const std::shared_ptr<const SolidMesh>& solid)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (entries_.size() > 2 * size_when_cleared_ + kFewEntries)
    {
      for (auto entry = entries_.begin(); entry != entries_.end();)
        entry = entry->second.solid.expired() ? entries_.erase(entry) : std::next(entry);
      size_when_cleared_ = entries_.size();
    }
    entries_[mesh.get()] = {mesh, solid};
  }

 private:
  static constexpr std::size_t kFewEntries = 1024;
  struct Entry
  {
    std::weak_ptr<const Mesh> original;
    std::weak_ptr<const SolidMesh> solid;
  };

  std::mutex mutex_;  // guards the members below; not held while a mesh is closed
  std::map<const Mesh*, Entry> entries_;
  std::size_t size_when_cleared_ = 0;
};

SolidRegistry& solidRegistry()
{
  static SolidRegistry registry;
  return registry;
}
}  // namespace

std::size_t MeshParts::count(PartKind kind) const
{
  return (kind == PartKind::Closed ? closed : 0) +
         static_cast<std::size_t>(std::count_if(
             other.begin(), other.end(), [kind](const MeshPart& part) { return part.kind == kind; }));
}

bool SolidMesh::hasSolid() const
{
  return std::any_of(
      components.begin(), components.end(), [](const Component& part) { return part.solid; });
}

bool SolidMesh::isAllSolid() const
{
  for (std::size_t t = 0; t < roles.size(); ++t)
  {
    const auto corner = [&](std::size_t i) -> const Eigen::Vector3d& { return mesh->vertices[mesh->triangles[t][i]]; };
    if (roles[t] == TriangleRole::Surface && corner(0) != corner(1) && corner(1) != corner(2) && corner(2) != corner(0))
      return false;
  }
  return true;
}

bool SolidMesh::isOpen(std::size_t triangle) const
{
  return roles[triangle] == TriangleRole::Surface && parts.count(PartKind::Surface) != 0;
}

std::shared_ptr<const SolidMesh> solidMeshOf(const std::shared_ptr<const Mesh>& mesh)
{
  if (std::shared_ptr<const SolidMesh> known = solidRegistry().find(mesh))
    return known;
  const auto solid = std::make_shared<const SolidMesh>(makeSolidMesh(mesh));
  solidRegistry().add(mesh, solid);
  return solid;
}
}  // namespace gpu_planning_scene::core
