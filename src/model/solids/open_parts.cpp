#include "model/solids/open_parts.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "model/solids/changed_mesh.h"
#include "model/solids/surface_closer.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Tolerances of the attempts to close a part, as shares of the diagonal of the mesh. Files with float coordinates have
/// errors of a tenth of the first one. The larger ones close cracks.
constexpr std::array<double, 4> kTolerances = {1e-6, 1e-5, 1e-4, 1e-3};

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
}  // namespace

std::vector<std::uint32_t> closeOpenParts(const std::vector<Corners>& triangles, const Places& places, double diagonal,
                                          std::vector<std::uint32_t> open, SolidMesh& solid)
{
  std::vector<std::uint32_t> cycles(triangles.size(), 0);
  std::uint32_t known_cycles = 0;  // of the attempts before
  ChangedMesh mesh(solid.mesh, places);
  FillingBudget budget;
  const std::vector<Closing> closings = attempts(diagonal, solid.mesh->solid);
  for (const Closing& closing : closings)
  {
    std::vector<Corners> part;
    for (const std::uint32_t t : open)
      part.push_back(triangles[t]);
    const bool is_last = &closing == &closings.back();
    ClosedSurface surface = closeSurface(places.points, part, closing, budget);
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
}  // namespace gpu_planning_scene::core
