#include <algorithm>
#include <iterator>
#include <map>

#include "gpu_planning_scene/solids.h"
#include "model/solids/changed_mesh.h"
#include "model/solids/mesh_edges.h"
#include "model/solids/open_parts.h"
#include "model/solids/shells.h"
#include "model/solids/solid_registry.h"
#include "model/solids/triangle_components.h"
#include "model/solids/welding.h"

// Components that are closed as they are need no copy of the mesh. closeOpenParts gets the triangles of all others.
namespace gpu_planning_scene::core
{
namespace
{
std::vector<Corners> cornersOf(const Mesh& mesh, const Places& places)
{
  std::vector<Corners> corners;
  corners.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    corners.push_back({places.of_vertex[t[0]], places.of_vertex[t[1]], places.of_vertex[t[2]]});
  return corners;
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
  auto solid = std::make_shared<const SolidMesh>(makeSolidMesh(mesh));
  solidRegistry().add(mesh, solid);
  return solid;
}
}  // namespace gpu_planning_scene::core
