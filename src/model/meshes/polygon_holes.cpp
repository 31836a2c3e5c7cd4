#include "model/meshes/polygon_holes.h"

#include <algorithm>
#include <tuple>

#include "gpu_planning_scene/error.h"
#include "model/meshes/orientation.h"

// A bridge is a diagonal from a hole to the outline: the shortest one that touches nothing between. The test is that of
// J. O'Rourke: Computational Geometry in C, 1998, section 1.6.
namespace gpu_planning_scene::core
{
namespace
{
using Points = std::vector<Eigen::Vector2d>;

/// A position in a loop.
struct Corner
{
  const Loop* loop;
  std::size_t at;

  std::uint32_t here() const { return (*loop)[at]; }
  std::uint32_t next() const { return (*loop)[(at + 1) % loop->size()]; }
  std::uint32_t previous() const { return (*loop)[(at + loop->size() - 1) % loop->size()]; }
};

/// Whether c lies on the segment from a to b. The three are on one line.
bool isBetween(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c)
{
  return (c.array() >= a.cwiseMin(b).array()).all() && (c.array() <= a.cwiseMax(b).array()).all();
}

/// Whether the open segments a-b and c-d meet in a point.
bool cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c, const Eigen::Vector2d& d)
{
  return orientation(a, b, c) * orientation(a, b, d) < 0 && orientation(c, d, a) * orientation(c, d, b) < 0;
}

bool touch(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c, const Eigen::Vector2d& d)
{
  return cross(a, b, c, d) || (orientation(a, b, c) == 0 && isBetween(a, b, c)) ||
         (orientation(a, b, d) == 0 && isBetween(a, b, d)) || (orientation(c, d, a) == 0 && isBetween(c, d, a)) ||
         (orientation(c, d, b) == 0 && isBetween(c, d, b));
}

/// Whether a segment that leaves the corner to `target` begins on the left of the loop, which is its inner side.
bool leavesInward(const Points& points, const Corner& corner, const Eigen::Vector2d& target)
{
  const Eigen::Vector2d& here = points[corner.here()];
  const Eigen::Vector2d& next = points[corner.next()];
  const Eigen::Vector2d& previous = points[corner.previous()];
  if (orientation(previous, here, next) >= 0)
    return orientation(here, target, previous) > 0 && orientation(target, here, next) > 0;
  return orientation(here, target, next) < 0 || orientation(target, here, previous) < 0;
}

class HoleJoiner
{
 public:
  HoleJoiner(const Points& points, Loop outline, std::vector<Loop> holes)
    : points_(points), outline_(std::move(outline)), holes_(std::move(holes))
  {
  }

  Loop joined()
  {
    while (!holes_.empty())
      if (!joinOne())
        throw Error("a polygon has a hole that crosses its outline or another hole, or lies outside the outline");
    return outline_;
  }

 private:
  /// The outline has the holes that were joined before.
  bool crossesOutline(const Loop& hole) const
  {
    for (std::size_t i = 0; i < hole.size(); ++i)
      for (std::size_t k = 0; k < outline_.size(); ++k)
        if (cross(points_[hole[i]], points_[hole[(i + 1) % hole.size()]], points_[outline_[k]],
                  points_[outline_[(k + 1) % outline_.size()]]))
          return true;
    return false;
  }

  /// Another hole can hide a hole from the outline, so the first hole that has a bridge is joined.
  bool joinOne()
  {
    for (std::size_t i = 0; i < holes_.size(); ++i)
      if (!crossesOutline(holes_[i]) && join(i))
      {
        holes_.erase(holes_.begin() + static_cast<std::ptrdiff_t>(i));
        return true;
      }
    return false;
  }

  bool join(std::size_t index)
  {
    const Loop& hole = holes_[index];
    std::vector<std::tuple<double, std::size_t, std::size_t>> bridges;  // squared length, places in the two loops
    for (std::size_t i = 0; i < outline_.size(); ++i)
      for (std::size_t k = 0; k < hole.size(); ++k)
        bridges.emplace_back((points_[outline_[i]] - points_[hole[k]]).squaredNorm(), i, k);
    std::sort(bridges.begin(), bridges.end());
    for (const auto& [length, i, k] : bridges)
      if (const Corner touched{&outline_, i}; length == 0.0)
      {
        // Where the hole touches the outline, no bridge is needed. Of several corners at this place, one has the hole.
        const std::uint32_t next = hole[(k + 1) % hole.size()];
        if (!leavesInward(points_, touched, points_[next]))
          continue;
        Loop inserted(hole.begin() + static_cast<std::ptrdiff_t>(k) + 1, hole.end());
        inserted.insert(inserted.end(), hole.begin(), hole.begin() + static_cast<std::ptrdiff_t>(k) + 1);
        outline_.insert(outline_.begin() + static_cast<std::ptrdiff_t>(i) + 1, inserted.begin(), inserted.end());
        return true;
      }
      else if (isFree({&outline_, i}, {&hole, k}))
      {
        Loop inserted(hole.begin() + static_cast<std::ptrdiff_t>(k), hole.end());
        inserted.insert(inserted.end(), hole.begin(), hole.begin() + static_cast<std::ptrdiff_t>(k) + 1);
        inserted.push_back(outline_[i]);
        outline_.insert(outline_.begin() + static_cast<std::ptrdiff_t>(i) + 1, inserted.begin(), inserted.end());
        return true;
      }
    return false;
  }

  bool isFree(const Corner& from, const Corner& to) const
  {
    const Eigen::Vector2d& a = points_[from.here()];
    const Eigen::Vector2d& b = points_[to.here()];
    return leavesInward(points_, from, b) && leavesInward(points_, to, a) && passes(outline_, a, b) &&
           std::all_of(holes_.begin(), holes_.end(), [&](const Loop& hole) { return passes(hole, a, b); });
  }

  /// Whether the segment touches no edge of the loop, except edges that begin or end where it does.
  bool passes(const Loop& loop, const Eigen::Vector2d& a, const Eigen::Vector2d& b) const
  {
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const Eigen::Vector2d& c = points_[loop[i]];
      const Eigen::Vector2d& d = points_[loop[(i + 1) % loop.size()]];
      if (c != a && c != b && d != a && d != b && touch(a, b, c, d))
        return false;
    }
    return true;
  }

  const Points& points_;
  Loop outline_;
  std::vector<Loop> holes_;
};
}  // namespace

Loop joinHoles(const std::vector<Eigen::Vector2d>& points, Loop outline, std::vector<Loop> holes)
{
  return HoleJoiner(points, std::move(outline), std::move(holes)).joined();
}
}  // namespace gpu_planning_scene::core
