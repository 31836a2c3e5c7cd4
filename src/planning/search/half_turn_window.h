#pragma once

#include <vector>

#include <ompl/base/StateSpace.h>

namespace gpu_planning_scene::core
{
/// Moves random states nearer to the straight line between two states. An angle of a joint with limits, drawn from its
/// whole range, gets the same place in the part of the range that is within half a turn of the line: within half a turn
/// to both sides, a link has all its directions. Trees that grow towards such states spend less on the ends of wide
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
