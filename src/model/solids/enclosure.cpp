#include "model/solids/enclosure.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "model/solids/missed_places.h"
#include "model/solids/outer_shell.h"

// Several bodies in one part: they touch each other or share walls, and some of them may be inside out. If the file's
// own triangles have no signed boundary and miss no place, they are taken as they are, cavities included. Otherwise
// every chamber is solid. Own method.
namespace gpu_planning_scene::core
{
namespace
{
/// Whether two triangles with the same corners have the same front.
bool haveSameDirection(const Corners& a, const Corners& b)
{
  const auto first = static_cast<std::size_t>(std::find(b.begin(), b.end(), a[0]) - b.begin());
  return b[(first + 1) % 3] == a[1];
}

/// The part as it is in the file. Pairs of a triangle and its back side are left out: between two bodies, they are a
/// wall.
Enclosure asInFile(const WeldedTriangles& triangles, const Numbers& part)
{
  Enclosure found;
  for (const std::uint32_t t : part)
  {
    std::array<Numbers, 2> sides;
    for (const std::uint32_t copy : triangles.copies(t))
      sides[haveSameDirection(triangles[t], triangles[copy]) ? 0 : 1].push_back(copy);
    const std::size_t pairs = std::min(sides[0].size(), sides[1].size());
    for (const Numbers& side : sides)
      found.members.insert(found.members.end(), side.begin() + static_cast<std::ptrdiff_t>(pairs), side.end());
  }
  found.surface = asOriented(triangles.cornersOf(found.members));
  found.with_walls = part;
  return found.surface.boundary.empty() ? found : Enclosure();
}

Enclosure outerShellOf(const WeldedTriangles& triangles, const Numbers& part, SheetOrder order)
{
  const std::vector<Corners> corners = triangles.cornersOf(part);
  const OuterShell shell = outerShell(triangles.points(), corners, order);
  Enclosure found;
  std::vector<Corners> turned;
  for (std::size_t i = 0; i < part.size(); ++i)
  {
    const ShellPlace place = shell.places[i];
    (place == ShellPlace::Beside ? found.rest : found.with_walls).push_back(part[i]);
    if (place != ShellPlace::Shell)
      continue;
    found.members.push_back(part[i]);
    turned.push_back(corners[i]);
    if (shell.turned[i])
      std::swap(turned.back()[1], turned.back()[2]);
  }
  found.surface = asOriented(std::move(turned));
  return found;
}
}  // namespace

Enclosure enclosureOf(const WeldedTriangles& triangles, const Numbers& part)
{
  const auto missed = [&](const Enclosure& found, const Numbers& by)
  { return countMissedPlaces(triangles.points(), triangles.cornersOf(by), found.surface.triangles); };
  Enclosure best = asInFile(triangles, part);
  bool is_as_in_file = !best.members.empty();
  bool has_shell = false;
  std::size_t least = is_as_in_file ? missed(best, part) : 0;
  for (const SheetOrder order : {SheetOrder::FirstBehind, SheetOrder::FirstInFront})
  {
    if (!best.members.empty() && least == 0)
      break;
    Enclosure shell = outerShellOf(triangles, part, order);
    if (shell.members.empty())
      continue;
    has_shell = true;
    const std::size_t count = missed(shell, part);
    if (!best.members.empty() && count >= least)
      continue;
    best = std::move(shell);
    least = count;
    is_as_in_file = false;
  }
  // Places that a shell misses too are deep pockets.
  const bool are_pockets = is_as_in_file && has_shell;
  best.is_certain = least == 0 || are_pockets || missed(best, best.with_walls) == 0;
  return best;
}
}  // namespace gpu_planning_scene::core
