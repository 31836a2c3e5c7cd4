#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <ompl/base/StateSpace.h>

namespace gpu_planning_scene::core
{
/// A place on the straight line between a root of the start tree and a root of the goal tree.
struct PlaceBetweenRoots
{
  std::size_t start;  // number of the root
  std::size_t goal;
  double t;  // from 0 (start, included) to 1 (goal, excluded)
};

/// The place near which the random branch `number` of a tree grows. No value, for each fourth branch: it grows
/// towards states of the whole space, so a search without end finds a path if there is one. The branches are near all
/// pairs of roots and all parts of the lines in turn. There must be a root in each tree.
std::optional<PlaceBetweenRoots> placeOfBranch(std::size_t number, std::size_t starts, std::size_t goals);

/// Moves random states nearer to the straight line between two states. An angle of a revolute joint, drawn from its
/// whole range, keeps its relative place, but in a part of the range: that within half a turn to both sides of the
/// line. A turn has all directions of a link, so trees that grow towards such states spend less on the ends of wide
/// ranges. Other values stay as they are. Const functions are thread-safe.
class HalfTurnWindow
{
 public:
  /// `space`: a GroupStateSpace after setup().
  explicit HalfTurnWindow(ompl::base::StateSpacePtr space);

  /// `t`: the place on the line, from 0 (`from`) to 1 (`to`). The state stays within the bounds of the space.
  void moveInto(const ompl::base::State* from, const ompl::base::State* to, double t, ompl::base::State* state) const;

 private:
  /// A joint whose range is above half a turn: a narrower one is always within the window.
  struct WideJoint
  {
    ompl::base::StateSpace::ValueLocation location;
    double lower;  // radians
    double upper;
  };

  ompl::base::StateSpacePtr space_;
  std::vector<WideJoint> joints_;
};
}  // namespace gpu_planning_scene::core
