#include "model/solids/surface_closer.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "model/solids/closed_core.h"
#include "model/solids/disjoint_sets.h"
#include "model/solids/free_rims.h"
#include "model/solids/hidden_chamber.h"
#include "model/solids/hole_filling.h"
#include "model/solids/orientation.h"
#include "model/solids/outer_shell.h"
#include "model/solids/seams.h"

// A surface without signed boundary is a cycle; it bounds the points around which its winding number is not 0. A cycle
// modulo 2 bounds the points with an odd number of crossings. What is left open is closed by chains over the same
// vertices: thin triangles along seams and between welded vertices, fillings of holes. (Cycles and boundaries: J. R.
// Munkres, Elements of Algebraic Topology, 1984. The winding number of a mesh with holes is that of the closed mesh
// less the solid angles of the fillings: A. Jacobson, L. Kavan, O. Sorkine-Hornung, Robust Inside-Outside Segmentation
// using Generalized Winding Numbers, 2013.)
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;
using Numbers = std::vector<std::uint32_t>;

/// Triangles of a part that bound a solid, together with the triangles that close them.
struct Cycle
{
  Numbers members;
  std::vector<Corners> turned;  // the members' welded corners, in the cycle's direction
  std::vector<FilledHole> holes = {};
  TriangleRole role = TriangleRole::Winding;
  std::vector<Corners> chain = {};  // the members with their own corners, then the triangles that close them
  double share = 0.0;               // area of the triangles that close the members, as a share of the part's area
};

/// Each triangle once, in whatever direction.
std::vector<Corners> withoutCopies(const std::vector<Corners>& triangles)
{
  std::vector<std::pair<Corners, std::uint32_t>> sorted;
  sorted.reserve(triangles.size());
  for (const Corners& t : triangles)
  {
    sorted.emplace_back(t, static_cast<std::uint32_t>(sorted.size()));
    std::sort(sorted.back().first.begin(), sorted.back().first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<Corners> once;
  for (std::size_t i = 0; i < sorted.size(); ++i)
    if (i == 0 || sorted[i].first != sorted[i - 1].first)
      once.push_back(triangles[sorted[i].second]);
  return once;
}

/// Whether two triangles with the same corners have the same front.
bool haveSameDirection(const Corners& a, const Corners& b)
{
  const auto first = static_cast<std::size_t>(std::find(b.begin(), b.end(), a[0]) - b.begin());
  return b[(first + 1) % 3] == a[1];
}

class SurfaceCloser
{
 public:
  SurfaceCloser(const std::vector<Vector3d>& points, std::vector<Corners> triangles, const Closing& closing)
    : points_(points), closing_(closing), input_count_(triangles.size())
  {
    result_.triangles = std::move(triangles);
    result_.roles.assign(input_count_, TriangleRole::Surface);
    result_.cycles.assign(input_count_, 0);
    weldCorners(closing.tolerance, closing.welded);
    countCopies();
    addSeams(closing.tolerance);
    for (const Numbers& part : partsOf(unique_))
      closePart(part);
    keepCollapsed();
  }

  ClosedSurface take() { return std::move(result_); }

 private:
  /// A later attempt, which welds less, may need the collapsed triangles at parts that are still open.
  void keepCollapsed()
  {
    std::set<std::uint32_t> open_places;
    for (const std::uint32_t t : result_.open)
      open_places.insert(welded_[t].begin(), welded_[t].end());
    for (const std::uint32_t t : collapsed_)
      if (unique_.empty() || std::any_of(welded_[t].begin(), welded_[t].end(),
                                         [&](std::uint32_t place) { return open_places.count(place) != 0; }))
        result_.open.push_back(t);
  }

  void weldCorners(double tolerance, WeldedCorners welded)
  {
    std::vector<bool> used(points_.size(), false);
    if (welded == WeldedCorners::All)
    {
      for (const Corners& t : result_.triangles)
        for (const std::uint32_t place : t)
          used[place] = true;
    }
    else
      visitEdges(edgeUses(withoutCopies(result_.triangles)),
                 [&](auto first, auto last)
                 {
                   if ((last - first) % 2 == 1)
                     used[first->low] = used[first->high] = true;
                 });
    representative_ = weld(points_, used, tolerance);
    for (const Corners& t : result_.triangles)
      welded_.push_back({representative_[t[0]], representative_[t[1]], representative_[t[2]]});
  }

  /// Fills unique_ with the first of the triangles with the same corners, and copies_ with all of them.
  void countCopies()
  {
    std::map<Corners, std::uint32_t> first_with;
    copies_.resize(welded_.size());
    for (std::uint32_t t = 0; t < welded_.size(); ++t)
    {
      if (!hasDistinctCorners(welded_[t]))
      {
        if (hasDistinctCorners(result_.triangles[t]))
          collapsed_.push_back(t);
        continue;
      }
      Corners sorted = welded_[t];
      std::sort(sorted.begin(), sorted.end());
      const auto [first, is_new] = first_with.try_emplace(sorted, t);
      if (is_new)
        unique_.push_back(t);
      copies_[first->second].push_back(t);
    }
  }

  /// Seam triangles become triangles like those of the input, at the end of the list.
  void addSeams(double tolerance)
  {
    std::vector<Corners> triangles;
    for (const std::uint32_t t : unique_)
      triangles.push_back(welded_[t]);
    for (const Corners& seam : seamTriangles(points_, triangles, tolerance))
      unique_.push_back(addTriangle(seam, TriangleRole::Surface));
  }

  /// Returns the triangle's number.
  std::uint32_t addTriangle(const Corners& triangle, TriangleRole role)
  {
    const auto number = static_cast<std::uint32_t>(result_.triangles.size());
    result_.triangles.push_back(triangle);
    result_.roles.push_back(role);
    result_.cycles.push_back(0);
    welded_.push_back(triangle);
    copies_.push_back({number});
    return number;
  }

  /// The sets of triangles that are connected.
  std::vector<Numbers> partsOf(const Numbers& numbers) const
  {
    DisjointSets sets(numbers.size());
    visitEdges(edgeUses(cornersOf(numbers)),
               [&](auto first, auto last)
               {
                 for (auto use = first; use != last; ++use)
                   sets.unite(first->triangle, use->triangle);
               });
    if (closing_.connected == ConnectedBy::CommonCorners)
    {
      std::map<std::uint32_t, std::uint32_t> first_at;
      for (std::uint32_t i = 0; i < numbers.size(); ++i)
        for (const std::uint32_t place : welded_[numbers[i]])
          sets.unite(first_at.try_emplace(place, i).first->second, i);
    }
    std::vector<Numbers> parts;
    std::vector<std::size_t> part_of_set(numbers.size(), numbers.size());
    for (std::uint32_t i = 0; i < numbers.size(); ++i)
    {
      std::size_t& part = part_of_set[sets.find(i)];
      if (part == numbers.size())
      {
        part = parts.size();
        parts.emplace_back();
      }
      parts[part].push_back(numbers[i]);
    }
    return parts;
  }

  std::vector<Corners> cornersOf(const Numbers& numbers) const
  {
    std::vector<Corners> corners;
    corners.reserve(numbers.size());
    for (const std::uint32_t t : numbers)
      corners.push_back(welded_[t]);
    return corners;
  }

  /// `filled`: holes whose triangles are already in the part.
  void closePart(const Numbers& part, const std::vector<FilledHole>& filled = {})
  {
    const OrientedSurface once = orient(points_, cornersOf(part));
    if (!hasSimpleEdges(part) && closeChambers(part, once, filled))
      return;
    // Two volumes with a common wall have it twice. Without the wall they are one volume.
    Numbers without_walls;
    std::copy_if(part.begin(), part.end(), std::back_inserter(without_walls),
                 [this](std::uint32_t t) { return copies_[t].size() % 2 == 1; });
    const bool has_walls = !without_walls.empty() && without_walls.size() < part.size();
    const OrientedSurface outer = has_walls ? orient(points_, cornersOf(without_walls)) : OrientedSurface();
    const bool is_closed = once.boundary.empty() || once.even;
    const bool is_outer_closed = has_walls && (outer.boundary.empty() || outer.even);
    if (!is_closed && !is_outer_closed && closeCore(part, largestCore(part), once, filled))
      return;
    if (once.boundary.empty() || (is_closed && !(is_outer_closed && outer.boundary.empty())))
      return accept(completed(part, once), part, filled);
    if (is_outer_closed)
      return accept(completed(without_walls, outer), part, filled);
    Cycle cycle = completed(part, once);
    if (has_walls)
    {
      Cycle outer_cycle = completed(without_walls, outer);
      if (outer_cycle.share < cycle.share)
        cycle = std::move(outer_cycle);
    }
    accept(cycle, part, filled);
  }

  /// Whether each edge has at most two triangles, and no triangle has a copy.
  bool hasSimpleEdges(const Numbers& part) const
  {
    bool is_simple = std::all_of(
        part.begin(), part.end(), [this](std::uint32_t t) { return copies_[t].size() == 1; });
    visitEdges(edgeUses(cornersOf(part)), [&](auto first, auto last) { is_simple = is_simple && last - first <= 2; });
    return is_simple;
  }

  /// A closed surface in a part.
  struct Core
  {
    Numbers members = {};
    std::vector<Corners> turned = {};  // the members' welded corners
    Numbers with_walls = {};           // the members and what they enclose
    Numbers rest = {};
    std::size_t hidden = 0;  // see hiddenChambers
    bool is_uncertain = false;
  };

  /// Closes a part with edges of more than two triangles: as it is in the file, or else everything that it encloses.
  /// The choice is the surface with the fewest hidden chambers; if there are any, the part is named. Returns false if
  /// nothing is enclosed, or if an attempt that fills holes may close more.
  bool closeChambers(const Numbers& part, const OrientedSurface& once, const std::vector<FilledHole>& filled)
  {
    Core best = coreOfFile(part);
    const bool is_of_file = !best.members.empty();
    const auto offer = [&](Core core)
    {
      if (!core.members.empty() && (best.members.empty() || core.hidden < best.hidden))
        best = std::move(core);
    };
    for (const SheetOrder order : {SheetOrder::FirstBehind, SheetOrder::FirstInFront})
      if (best.members.empty() || best.hidden != 0)
        offer(outerShellOf(part, order));
    if (best.hidden != 0 && !is_of_file)
      offer(largestCore(part));
    best.is_uncertain =
        best.hidden != 0 && !is_of_file && hiddenChambers(points_, cornersOf(best.with_walls), best.turned) != 0;
    return closeCore(part, best, once, filled);
  }

  void setHidden(const Numbers& part, Core& core) const
  {
    if (!core.members.empty())
      core.hidden = hiddenChambers(points_, cornersOf(part), core.turned);
  }

  /// The part as it is in the file, if it has no signed boundary. Pairs of a triangle and its back side are left out:
  /// between two bodies, they are a wall.
  Core coreOfFile(const Numbers& part) const
  {
    Core core;
    for (const std::uint32_t t : part)
    {
      std::array<Numbers, 2> sides;
      for (const std::uint32_t copy : copies_[t])
        sides[haveSameDirection(welded_[t], welded_[copy]) ? 0 : 1].push_back(copy);
      const std::size_t pairs = std::min(sides[0].size(), sides[1].size());
      for (const Numbers& side : sides)
        core.members.insert(core.members.end(), side.begin() + static_cast<std::ptrdiff_t>(pairs), side.end());
    }
    core.turned = cornersOf(core.members);
    if (!signedBoundary(core.turned).empty())
      return {};
    core.with_walls = part;
    setHidden(part, core);
    return core;
  }

  Core outerShellOf(const Numbers& part, SheetOrder order) const
  {
    const std::vector<Corners> corners = cornersOf(part);
    const OuterShell shell = outerShell(points_, corners, order);
    Core core;
    for (std::size_t i = 0; i < part.size(); ++i)
    {
      const ShellPlace place = shell.places[i];
      (place == ShellPlace::Beside ? core.rest : core.with_walls).push_back(part[i]);
      if (place != ShellPlace::Shell)
        continue;
      core.members.push_back(part[i]);
      core.turned.push_back(corners[i]);
      if (shell.turned[i])
        std::swap(core.turned.back()[1], core.turned.back()[2]);
    }
    setHidden(part, core);
    return core;
  }

  /// The part's largest surface that has an even number of triangles at each edge. This surface may cross itself.
  Core largestCore(const Numbers& part) const
  {
    const std::vector<CorePlace> places = closedCore(points_, cornersOf(part));
    Core core;
    for (std::size_t i = 0; i < part.size(); ++i)
    {
      if (places[i] == CorePlace::Core)
        core.members.push_back(part[i]);
      (places[i] == CorePlace::Beside ? core.rest : core.with_walls).push_back(part[i]);
    }
    const OrientedSurface surface = orient(points_, cornersOf(core.members));
    core.turned = surface.triangles;
    setHidden(part, core);
    return core;
  }

  /// Closes a surface in a part, and separately what is beside it, for example a fin. If the free edges of the part are
  /// the rims of small holes, these are filled first. Returns false if there is no such surface, or if an attempt that
  /// fills holes may close more.
  bool closeCore(const Numbers& part, const Core& core, const OrientedSurface& once,
                 const std::vector<FilledHole>& filled)
  {
    const double area = areaOf(part);
    const double rest_area = areaOf(core.rest);
    if (filled.empty() && !core.rest.empty() && (!core.members.empty() || closing_.fills_holes))
    {
      const std::vector<BoundaryEdge> rims = freeRims(points_, once.triangles);
      // A surface without other boundary is filled as a whole.
      const std::vector<FilledHole> holes =
          rims.size() == once.boundary.size() ? std::vector<FilledHole>() : fillHoles(points_, rims);
      double holes_area = 0.0;
      for (const FilledHole& hole : holes)
        holes_area += hole.area;
      // The filling of a fin has about the area of the fin itself, so it is not worth filling.
      if (!holes.empty() && holes_area <= closing_.most_share * area && holes_area < 0.5 * rest_area)
      {
        if (!closing_.fills_holes)
          return false;
        closePart(withHoles(part, holes), holes);
        return true;
      }
    }
    if (core.members.empty())
      return false;
    accept(completed(core.members, surfaceOf(core.turned)), core.with_walls, filled);
    if (core.is_uncertain)
      nameUncertain(core.with_walls);
    for (const Numbers& other : partsOf(core.rest))
      closePart(other);
    return true;
  }

  static OrientedSurface surfaceOf(const std::vector<Corners>& triangles)
  {
    OrientedSurface surface;
    surface.triangles = triangles;
    surface.boundary = signedBoundary(triangles);
    visitEdges(edgeUses(triangles),
               [&](auto first, auto last) { surface.even = surface.even && (last - first) % 2 == 0; });
    return surface;
  }

  /// Names a part whose inside may be larger than what counts as inside.
  void nameUncertain(const Numbers& part)
  {
    report(part, PartKind::Surface, {});
    result_.uncertain.push_back(result_.parts.back());
    result_.parts.pop_back();
  }

  double areaOf(const Numbers& numbers) const
  {
    double area = 0.0;
    for (const std::uint32_t t : numbers)
      area += core::areaOf(points_, welded_[t]);
    return area;
  }

  /// Fillings become triangles like those of the input, at the end of the list.
  Numbers withHoles(Numbers part, const std::vector<FilledHole>& holes)
  {
    for (const FilledHole& hole : holes)
      for (const Corners& triangle : hole.triangles)
        part.push_back(addTriangle(triangle, TriangleRole::Surface));
    return part;
  }

  /// The cycle of an oriented surface: with its holes filled, unless it is closed or parity decides.
  Cycle completed(const Numbers& members, const OrientedSurface& surface) const
  {
    Cycle cycle{members, surface.triangles};
    if (surface.even && !surface.boundary.empty())
      cycle.role = TriangleRole::Parity;
    else if (closing_.fills_holes)
      cycle.holes = fillHoles(points_, surface.boundary);
    else if (!surface.boundary.empty())
    {
      cycle.share = std::numeric_limits<double>::infinity();
      return cycle;
    }
    double area = 0.0;
    double added_area = 0.0;
    for (std::size_t i = 0; i < members.size(); ++i)
    {
      Corners corners = result_.triangles[members[i]];
      if (cycle.turned[i] != welded_[members[i]])
        std::swap(corners[1], corners[2]);
      cycle.chain.push_back(corners);
      (members[i] < input_count_ ? area : added_area) += core::areaOf(points_, corners);
    }
    for (const FilledHole& hole : cycle.holes)
      cycle.chain.insert(cycle.chain.end(), hole.triangles.begin(), hole.triangles.end());
    for (const Corners& triangle : connections(cycle))
      cycle.chain.push_back(triangle);
    for (std::size_t i = members.size(); i < cycle.chain.size(); ++i)
      added_area += core::areaOf(points_, cycle.chain[i]);
    cycle.share = area > 0.0 ? added_area / area : 1.0;
    return cycle;
  }

  /// Where corners were welded, thin triangles connect each edge with the edge that stands for it.
  std::vector<Corners> connections(const Cycle& cycle) const
  {
    std::vector<Corners> added;
    const auto connect = [&](std::uint32_t from, std::uint32_t to)
    {
      for (const Corners& triangle :
           {Corners{to, from, representative_[from]}, Corners{to, representative_[from], representative_[to]}})
        if (hasDistinctCorners(triangle))
          added.push_back(triangle);
    };
    if (cycle.role == TriangleRole::Winding)
      for (const BoundaryEdge& edge : signedBoundary(cycle.chain))
        connect(edge.from, edge.to);
    else
      visitEdges(edgeUses(cycle.chain),
                 [&](auto first, auto last)
                 {
                   if ((last - first) % 2 == 1)
                     connect(first->low, first->high);
                 });
    return added;
  }

  /// Adds a cycle to the solid, unless too much of it would have to be added. `filled`: holes whose triangles are
  /// members.
  void accept(Cycle cycle, const Numbers& part, const std::vector<FilledHole>& filled)
  {
    cycle.holes.insert(cycle.holes.end(), filled.begin(), filled.end());
    if (cycle.chain.empty() || !(cycle.share <= closing_.most_share))
    {
      for (const std::uint32_t t : part)
        if (t < input_count_)
          result_.open.insert(result_.open.end(), copies_[t].begin(), copies_[t].end());
      report(part, PartKind::Surface, cycle);
      return;
    }
    ++cycle_count_;
    for (std::size_t i = 0; i < cycle.chain.size(); ++i)
    {
      const std::uint32_t t = i < cycle.members.size() ? cycle.members[i] : addTriangle(cycle.chain[i], cycle.role);
      result_.triangles[t] = cycle.chain[i];
      result_.roles[t] = cycle.role;
      result_.cycles[t] = cycle_count_;
    }
    report(part, cycle.holes.empty() ? PartKind::Mended : PartKind::Filled, cycle);
  }

  void report(const Numbers& part, PartKind kind, const Cycle& cycle)
  {
    MeshPart entry{kind, 0, {}};
    for (const std::uint32_t t : part)
    {
      if (t < input_count_)
        entry.triangles += copies_[t].size();
      for (const std::uint32_t place : result_.triangles[t])
        entry.bounds.extend(points_[place]);
    }
    entry.holes = cycle.holes.size();
    for (const FilledHole& hole : cycle.holes)
    {
      Eigen::AlignedBox3d box;
      for (const std::uint32_t place : hole.rim)
        box.extend(points_[place]);
      entry.largest_hole = std::max(entry.largest_hole, box.diagonal().norm());
    }
    entry.hole_share = cycle.share;
    result_.parts.push_back(entry);
  }

  const std::vector<Vector3d>& points_;
  const Closing& closing_;
  const std::size_t input_count_;
  Numbers representative_;       // of each place
  std::vector<Corners> welded_;  // the corners of each triangle by their representatives
  std::vector<Numbers> copies_;  // for the first of equal triangles: all of them
  Numbers collapsed_;            // triangles whose corners were welded to one another
  Numbers unique_;               // the first of each set of equal triangles
  std::uint32_t cycle_count_ = 0;
  ClosedSurface result_;
};
}  // namespace

ClosedSurface closeSurface(const std::vector<Vector3d>& points, std::vector<Corners> triangles, const Closing& closing)
{
  return SurfaceCloser(points, std::move(triangles), closing).take();
}
}  // namespace gpu_planning_scene::core
