#include "planning/search/known_routes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <ompl/base/ScopedState.h>

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;
using ompl::geometric::PathGeometric;

// Beyond this part of the distance from start to goal, a known path saves too little.
constexpr double kLongestLines = 0.5;

// A plan for another task checks these routes in vain, so they are few.
constexpr std::size_t kMostRoutes = 2;

// The nearest place is searched in at most so many equal steps along a path, and a route has at most so many states: a
// plan may have any range.
constexpr double kMostSteps = 64.0;
constexpr double kMostStates = 2000.0;

/// A place on a path: on the motion from state `motion` to the next one, at this fraction of it.
struct PathPlace
{
  std::size_t motion = 0;
  double fraction = 0.0;
  double distance = std::numeric_limits<double>::infinity();  // from the state that is given
  const ob::State* state = nullptr;                           // the state that is given
};

struct Route
{
  const PathGeometric* path;
  PathPlace start;
  PathPlace goal;
  double lines() const { return start.distance + goal.distance; }
};

std::size_t piecesOf(double distance, double range)
{
  return static_cast<std::size_t>(std::max(1.0, std::ceil(distance / range)));
}

/// Finds the places of a path that are nearest to some start and to some goal.
class NearestPlaces
{
 public:
  NearestPlaces(const ob::SpaceInformationPtr& information, double range)
    : information_(information), range_(range), state_(information)
  {
  }

  Route on(const PathGeometric& path, const std::vector<const ob::State*>& starts,
           const std::vector<const ob::State*>& goals)
  {
    Route route{&path, {}, {}};
    const double step = std::max(range_, path.length() / kMostSteps);
    for (std::size_t motion = 0; motion + 1 < path.getStateCount(); ++motion)
    {
      const auto [from, to] = std::pair(stateOf(path, motion), stateOf(path, motion + 1));
      const std::size_t pieces = piecesOf(information_->distance(from, to), step);
      for (std::size_t piece = 0; piece <= pieces; ++piece)
      {
        const double fraction = static_cast<double>(piece) / static_cast<double>(pieces);
        information_->getStateSpace()->interpolate(from, to, fraction, state_.get());
        take(starts, motion, fraction, route.start);
        take(goals, motion, fraction, route.goal);
      }
    }
    return route;
  }

 private:
  static const ob::State* stateOf(const PathGeometric& path, std::size_t number)
  {
    return path.getState(static_cast<unsigned int>(number));
  }

  void take(const std::vector<const ob::State*>& states, std::size_t motion, double fraction, PathPlace& nearest)
  {
    for (const ob::State* state : states)
      if (const double distance = information_->distance(state, state_.get()); distance < nearest.distance)
        nearest = {motion, fraction, distance, state};
  }

  const ob::SpaceInformationPtr& information_;
  const double range_;
  ob::ScopedState<> state_;
};

/// Writes a route state by state.
class RouteWriter
{
 public:
  RouteWriter(const ob::SpaceInformationPtr& information, double range)
    : information_(information), range_(range), route_(information), state_(information), last_(information)
  {
  }

  PathGeometric write(const Route& route)
  {
    route_.append(route.start.state);
    goTo(*route.path, route.start);
    const bool is_forward =
        std::pair(route.start.motion, route.start.fraction) <= std::pair(route.goal.motion, route.goal.fraction);
    if (is_forward)
      for (std::size_t state = route.start.motion + 1; state <= route.goal.motion; ++state)
        goTo(*route.path, {state, 0.0});
    else
      for (std::size_t state = route.start.motion; state > route.goal.motion; --state)
        goTo(*route.path, {state, 0.0});
    goTo(*route.path, route.goal);
    goTo(route.goal.state);
    return route_;
  }

 private:
  void goTo(const PathGeometric& path, const PathPlace& place)
  {
    const auto motion = static_cast<unsigned int>(place.motion);
    information_->getStateSpace()->interpolate(path.getState(motion), path.getState(motion + 1), place.fraction,
                                               state_.get());
    goTo(state_.get());
  }

  void goTo(const ob::State* to)
  {
    information_->copyState(last_.get(), route_.getState(static_cast<unsigned int>(route_.getStateCount() - 1)));
    const double distance = information_->distance(last_.get(), to);
    if (distance == 0.0)
      return;
    const std::size_t pieces = piecesOf(distance, range_);
    for (std::size_t piece = 1; piece < pieces; ++piece)
    {
      information_->getStateSpace()->interpolate(
          last_.get(), to, static_cast<double>(piece) / static_cast<double>(pieces), between_.get());
      route_.append(between_.get());
    }
    route_.append(to);
  }

  const ob::SpaceInformationPtr& information_;
  const double range_;
  PathGeometric route_;
  ob::ScopedState<> state_;
  ob::ScopedState<> last_;
  ob::ScopedState<> between_{information_};
};
}  // namespace

std::vector<PathGeometric> knownRoutes(const ob::SpaceInformationPtr& information,
                                       const std::vector<PathGeometric>& known,
                                       const std::vector<const ob::State*>& starts,
                                       const std::vector<const ob::State*>& goals, double range)
{
  std::vector<Route> routes;
  NearestPlaces nearest(information, range);
  for (const PathGeometric& path : known)
  {
    const Route route = nearest.on(path, starts, goals);
    if (!route.start.state || !route.goal.state || path.length() + route.lines() > kMostStates * range)
      continue;
    const double distance = information->distance(route.start.state, route.goal.state);
    if (distance > 0.0 && route.lines() <= kLongestLines * distance)
      routes.push_back(route);
  }
  std::stable_sort(routes.begin(), routes.end(), [](const Route& a, const Route& b) { return a.lines() < b.lines(); });
  routes.resize(std::min(routes.size(), kMostRoutes));
  std::vector<PathGeometric> written;
  for (const Route& route : routes)
    written.push_back(RouteWriter(information, range).write(route));
  return written;
}
}  // namespace gpu_planning_scene::core
