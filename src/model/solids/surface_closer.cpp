#include "model/solids/surface_closer.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <set>
#include <utility>

#include "model/solids/enclosure.h"
#include "model/solids/free_rims.h"
#include "model/solids/orientation.h"
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

class SurfaceCloser
{
 public:
  SurfaceCloser(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles, const Closing& closing,
                FillingBudget& budget)
    : points_(points),
      closing_(closing),
      budget_(budget),
      input_count_(triangles.size()),
      welded_(points, triangles, closing.tolerance, closing.welded)
  {
    result_.triangles = triangles;
    result_.roles.assign(input_count_, TriangleRole::Surface);
    result_.cycles.assign(input_count_, 0);
    Numbers all = welded_.distinct();
    for (const Corners& seam : seamTriangles(points_, welded_.cornersOf(all), closing.tolerance))
      all.push_back(addTriangle(seam, TriangleRole::Surface));
    for (const Numbers& part : welded_.partsOf(all, closing.connected))
      closePart(part);
    keepCollapsed(all.empty());
  }

  ClosedSurface take() { return std::move(result_); }

 private:
  /// A later attempt, which welds less, may need the collapsed triangles at parts that are still open.
  void keepCollapsed(bool keeps_all)
  {
    if (welded_.collapsed().empty())
      return;
    std::set<std::uint32_t> open_places;
    for (const std::uint32_t t : result_.open)
      open_places.insert(welded_[t].begin(), welded_[t].end());
    for (const std::uint32_t t : welded_.collapsed())
      if (keeps_all || std::any_of(welded_[t].begin(), welded_[t].end(),
                                   [&](std::uint32_t place) { return open_places.count(place) != 0; }))
        result_.open.push_back(t);
  }

  /// Adds a triangle like those of the input, at the end of the list. Returns its number.
  std::uint32_t addTriangle(const Corners& triangle, TriangleRole role)
  {
    result_.triangles.push_back(triangle);
    result_.roles.push_back(role);
    result_.cycles.push_back(0);
    return welded_.add(triangle);
  }

  /// `filled`: holes whose triangles are already in the part.
  void closePart(const Numbers& part, const std::vector<FilledHole>& filled = {})
  {
    const OrientedSurface once = orient(points_, welded_.cornersOf(part));
    if (hasSimpleEdges(part) || !closeChambers(part, once, filled))
      accept(completed(part, once), part, filled);
  }

  /// Whether each edge has at most two triangles, and no triangle has a copy.
  bool hasSimpleEdges(const Numbers& part) const
  {
    bool is_simple = std::all_of(
        part.begin(), part.end(), [this](std::uint32_t t) { return !welded_.hasCopies(t); });
    visitEdges(edgeUses(welded_.cornersOf(part)),
               [&](auto first, auto last) { is_simple = is_simple && last - first <= 2; });
    return is_simple;
  }

  /// Closes what the part encloses, and separately the rest, for example a fin. `once`: the part, oriented. Returns
  /// false if nothing is enclosed, or if an attempt that fills holes may close more.
  bool closeChambers(const Numbers& part, const OrientedSurface& once, const std::vector<FilledHole>& filled)
  {
    const Enclosure found = enclosureOf(welded_, part);
    const bool may_have_holes =
        filled.empty() && !found.rest.empty() && (!found.members.empty() || closing_.fills_holes);
    if (const std::vector<FilledHole> holes =
            may_have_holes ? holesBeside(part, found.rest, once) : std::vector<FilledHole>();
        !holes.empty())
    {
      if (closing_.fills_holes)
        closePart(withHoles(part, holes), holes);
      return closing_.fills_holes;
    }
    if (found.members.empty())
      return false;
    accept(completed(found.members, found.surface), found.with_walls, filled);
    if (!found.is_certain)
      result_.uncertain.push_back(described(found.with_walls, PartKind::Surface, {}));
    for (const Numbers& other : welded_.partsOf(found.rest, closing_.connected))
      closePart(other);
    return true;
  }

  /// The small holes of a part whose rims are free edges; none if they are the whole boundary, because a surface
  /// without other boundary is filled as a whole.
  std::vector<FilledHole> holesBeside(const Numbers& part, const Numbers& rest, const OrientedSurface& once) const
  {
    const std::vector<BoundaryEdge> rims = freeRims(points_, once.triangles);
    if (rims.size() == once.boundary.size())
      return {};
    std::vector<FilledHole> holes = fillHoles(points_, rims, budget_);
    double area = 0.0;
    for (const FilledHole& hole : holes)
      area += hole.area;
    // The filling of a fin has about the area of the fin itself, so it is not worth filling.
    const bool are_small = area <= closing_.most_share * welded_.areaOf(part) && area < 0.5 * welded_.areaOf(rest);
    return are_small ? holes : std::vector<FilledHole>();
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
      cycle.holes = fillHoles(points_, surface.boundary, budget_);
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
      (members[i] < input_count_ ? area : added_area) += areaOf(points_, corners);
    }
    for (const FilledHole& hole : cycle.holes)
      cycle.chain.insert(cycle.chain.end(), hole.triangles.begin(), hole.triangles.end());
    for (const Corners& triangle : connections(cycle))
      cycle.chain.push_back(triangle);
    for (std::size_t i = members.size(); i < cycle.chain.size(); ++i)
      added_area += areaOf(points_, cycle.chain[i]);
    cycle.share = area > 0.0 ? added_area / area : 1.0;
    return cycle;
  }

  /// Where corners were welded, thin triangles connect each edge with the edge that stands for it.
  std::vector<Corners> connections(const Cycle& cycle) const
  {
    std::vector<Corners> added;
    const auto connect = [&](std::uint32_t from, std::uint32_t to)
    {
      for (const Corners& triangle : {Corners{to, from, welded_.representative(from)},
                                      Corners{to, welded_.representative(from), welded_.representative(to)}})
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
          for (const std::uint32_t copy : welded_.copies(t))
            result_.open.push_back(copy);
      result_.parts.push_back(described(part, PartKind::Surface, cycle));
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
    result_.parts.push_back(described(part, cycle.holes.empty() ? PartKind::Mended : PartKind::Filled, cycle));
  }

  MeshPart described(const Numbers& part, PartKind kind, const Cycle& cycle) const
  {
    MeshPart entry{kind, 0, {}};
    for (const std::uint32_t t : part)
    {
      if (t < input_count_)
        entry.triangles += welded_.copies(t).size();
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
    return entry;
  }

  const std::vector<Vector3d>& points_;
  const Closing& closing_;
  FillingBudget& budget_;
  const std::size_t input_count_;
  WeldedTriangles welded_;
  std::uint32_t cycle_count_ = 0;
  ClosedSurface result_;
};
}  // namespace

ClosedSurface closeSurface(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles,
                           const Closing& closing, FillingBudget& budget)
{
  return SurfaceCloser(points, triangles, closing, budget).take();
}
}  // namespace gpu_planning_scene::core
