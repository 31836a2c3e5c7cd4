#include "gpu_planning_scene/planning/path_shortcutter.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "planning/shortening/collinear_segments.h"
#include "planning/validity/bulk_validator.h"

// A round draws shortcuts between points of the path, checks them in one call, and takes valid shortcuts that do not
// overlap.
// R. Geraerts, M. H. Overmars: Creating high-quality paths for motion planning. IJRR 26(8), 2007.
namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;
using ompl::geometric::PathGeometric;

// A shortcut that gains less than this fraction of the path's length is not checked.
constexpr double kLeastGain = 1e-4;

// Number of draws for each shortcut to check. Near the end, most drawn shortcuts gain nothing.
constexpr std::size_t kDraws = 8;

/// A point of a path: a vertex or a point on an edge.
struct Point
{
  double along = 0.0;      // length of the path up to the point
  std::size_t before = 0;  // number of vertices before it
  std::size_t after = 0;   // index of the first vertex after it
  const ob::State* state = nullptr;

  bool isVertex() const { return before != after; }
};

struct Shortcut
{
  Point begin;
  Point end;
  double gain = 0.0;
};

/// The path at the start of a round, and the points drawn on it.
class CuttablePath
{
 public:
  CuttablePath(const ob::SpaceInformationPtr& information, const PathGeometric& path)
    : information_(information), path_(path), along_{0.0}
  {
    for (std::size_t i = 1; i < path.getStateCount(); ++i)
      along_.push_back(along_.back() + information->distance(state(i - 1), state(i)));
  }

  ~CuttablePath()
  {
    for (ob::State* made : made_)
      information_->freeState(made);
  }
  CuttablePath(const CuttablePath&) = delete;
  CuttablePath& operator=(const CuttablePath&) = delete;

  double length() const { return along_.back(); }
  std::size_t size() const { return along_.size(); }
  const ob::State* state(std::size_t vertex) const { return path_.getState(static_cast<unsigned int>(vertex)); }
  Point vertex(std::size_t i) const { return {along_[i], i, i + 1, state(i)}; }

  /// The point on an edge at a length along the path. Its state is null until place() creates it.
  Point pointAt(double along) const
  {
    const auto next = std::upper_bound(along_.begin() + 1, along_.end() - 1, along);
    const auto after = static_cast<std::size_t>(next - along_.begin());
    return {along, after, after, nullptr};
  }

  /// Creates the state of a point on an edge.
  void place(Point& point)
  {
    if (point.state)
      return;
    const double begin = along_[point.after - 1];
    const double length = along_[point.after] - begin;
    made_.push_back(information_->allocState());
    information_->getStateSpace()->interpolate(state(point.after - 1), state(point.after),
                                               length > 0.0 ? (point.along - begin) / length : 0.0, made_.back());
    point.state = made_.back();
  }

 private:
  const ob::SpaceInformationPtr& information_;
  const PathGeometric& path_;
  std::vector<double> along_;  // of each vertex: length of the path up to it
  std::vector<ob::State*> made_;
};

/// Draws a vertex in half of the cases. A shortcut between vertices removes a whole detour and leaves no part of an
/// edge.
Point drawPoint(const CuttablePath& path, ompl::RNG& random)
{
  if (random.uniformBool())
    return path.vertex(static_cast<std::size_t>(random.uniformInt(0, static_cast<int>(path.size()) - 1)));
  return path.pointAt(random.uniformReal(0.0, path.length()));
}

/// Selects the valid shortcuts to take. Returns them in the order of the path.
std::vector<Shortcut> bestOf(std::vector<Shortcut> candidates, const std::vector<std::uint8_t>& valid)
{
  std::vector<Shortcut> order;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (valid[i] != 0)
      order.push_back(candidates[i]);
  std::stable_sort(order.begin(), order.end(), [](const Shortcut& a, const Shortcut& b) { return a.gain > b.gain; });
  std::vector<Shortcut> taken;
  for (const Shortcut& shortcut : order)
    if (std::none_of(taken.begin(), taken.end(),
                     [&shortcut](const Shortcut& other)
                     { return shortcut.begin.along < other.end.along && other.begin.along < shortcut.end.along; }))
      taken.push_back(shortcut);
  std::sort(taken.begin(), taken.end(),
            [](const Shortcut& a, const Shortcut& b) { return a.begin.along < b.begin.along; });
  return taken;
}

/// The path with the shortcuts. `parts`: its motions that are mere parts of motions of the old path.
struct CutPath
{
  PathGeometric path;
  std::vector<MotionValidator::Motion> parts;

  CutPath(const ob::SpaceInformationPtr& information, const CuttablePath& old, const std::vector<Shortcut>& shortcuts)
    : path(information)
  {
    std::size_t next = 0;  // index of a vertex of the old path
    for (const Shortcut& shortcut : shortcuts)
    {
      while (next < shortcut.begin.before)
        goTo(old.vertex(next++));
      goTo(shortcut.begin);
      goTo(shortcut.end, true);
      next = shortcut.end.after;
    }
    while (next < old.size())
      goTo(old.vertex(next++));
  }

 private:
  void goTo(const Point& point, bool by_shortcut = false)
  {
    if (last_.state == point.state)  // one shortcut ends where the next one begins
      return;
    if (last_.state && !by_shortcut && !(last_.isVertex() && point.isVertex()))
      parts.emplace_back(last_.state, point.state);
    path.append(point.state);
    last_ = point;
  }

  Point last_;
};
}  // namespace

PathShortcutter::PathShortcutter(const ob::SpaceInformationPtr& information, const ShortcutterOptions& options)
  : information_(information), options_(options)
{
  bulkValidatorOf(*information, "PathShortcutter");
}

bool PathShortcutter::shorten(PathGeometric& path, const ob::PlannerTerminationCondition& ptc)
{
  mergeCollinearSegments(path, bulkValidatorOf(*information_, "PathShortcutter"), ptc);
  bool shorter = false;
  std::size_t idle = 0;
  for (std::size_t round = 0; round < options_.max_rounds && idle < options_.idle_rounds && !ptc; ++round)
  {
    const double gain = shortenOnce(path, round == 0, ptc);
    shorter = shorter || gain > 0.0;
    idle = gain < options_.least_gain ? idle + 1 : 0;
  }
  return shorter;
}

/// Runs one round. Returns the gain as a fraction of the path's length.
double PathShortcutter::shortenOnce(PathGeometric& path, bool first, const ob::PlannerTerminationCondition& ptc)
{
  if (path.getStateCount() < 3)
    return 0.0;
  const MotionValidator& validator = bulkValidatorOf(*information_, "PathShortcutter");
  CuttablePath old(information_, path);
  std::vector<Shortcut> candidates;
  std::vector<MotionValidator::Motion> motions;
  const auto propose = [&](Point begin, Point end)
  {
    if (begin.along > end.along)
      std::swap(begin, end);
    old.place(begin);
    old.place(end);
    const double gain = end.along - begin.along - information_->distance(begin.state, end.state);
    if (gain <= kLeastGain * old.length())
      return;
    candidates.push_back({begin, end, gain});
    motions.emplace_back(begin.state, end.state);
  };
  if (first)
    propose(old.vertex(0), old.vertex(old.size() - 1));
  for (std::size_t draws = 0; draws < kDraws * options_.candidates && candidates.size() < options_.candidates; ++draws)
  {
    const Point one = drawPoint(old, random_);
    propose(one, drawPoint(old, random_));
  }
  const std::vector<Shortcut> shortcuts = bestOf(candidates, validator.validateMotions(motions, ptc));
  if (shortcuts.empty())
    return 0.0;

  CutPath cut(information_, old, shortcuts);
  const std::vector<std::uint8_t> valid = validator.validateMotions(cut.parts, ptc);
  const double length = cut.path.length();
  if (length >= old.length() || std::find(valid.begin(), valid.end(), 0) != valid.end())
    return 0.0;
  path = cut.path;
  return 1.0 - length / old.length();
}
}  // namespace gpu_planning_scene::core
