// Random states move within half a turn of a straight line.

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <ompl/base/ScopedState.h>

#include "base/math_constants.h"
#include "gpu_planning_scene/planning/group_state_space.h"
#include "model/model_testing.h"
#include "planning/search/half_turn_window.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;

/// Joints of four kinds: `wide` turns by up to 6 rad to both sides, `narrow` by 1.5 rad, `slide` moves by up to 20 m,
/// and `wheel` has no limits.
std::shared_ptr<GroupStateSpace> space()
{
  const auto limits = [](double reach)
  {
    return "<limit lower='" + std::to_string(-reach) + "' upper='" + std::to_string(reach) +
           "' effort='1' velocity='1'/>";
  };
  std::string urdf;
  for (const char* link : {"base", "arm", "hand", "plate", "disc"})
    urdf += boxLink(link);
  urdf += jointXml("wide", "revolute", "base", "arm", limits(6.0)) +
          jointXml("narrow", "revolute", "arm", "hand", limits(1.5)) +
          jointXml("slide", "prismatic", "hand", "plate", limits(20.0)) +
          jointXml("wheel", "continuous", "plate", "disc");
  const std::string srdf =
      "<group name='all'><joint name='wide'/><joint name='narrow'/><joint name='slide'/>"
      "<joint name='wheel'/></group>";
  auto space = std::make_shared<GroupStateSpace>(robotOf(urdf, srdf), "all");
  space->setup();
  return space;
}

/// The values wide, narrow, slide and wheel of a state that was moved.
std::vector<double> moved(const std::shared_ptr<GroupStateSpace>& space, const std::vector<double>& from,
                          const std::vector<double>& to, double t, const std::vector<double>& values)
{
  ob::ScopedState<> begin(space);
  ob::ScopedState<> end(space);
  ob::ScopedState<> state(space);
  begin = from;
  end = to;
  state = values;
  HalfTurnWindow(space).moveInto(begin.get(), end.get(), t, state.get());
  return state.reals();
}

TEST(HalfTurnWindow, SpansHalfATurnToBothSidesOfTheLine)
{
  const std::vector<double> from = {-2.0, 0.0, 0.0, 0.0};
  const std::vector<double> to = {2.0, 0.0, 0.0, 0.0};
  for (const auto& [value, place] : {std::pair(-6.0, -kPi), {-3.0, -kPi / 2.0}, {0.0, 0.0}, {6.0, kPi}})
  {
    EXPECT_NEAR(moved(space(), from, to, 0.5, {value, 0.0, 0.0, 0.0})[0], place, 1e-12);
    EXPECT_NEAR(moved(space(), from, to, 0.25, {value, 0.0, 0.0, 0.0})[0], place - 1.0, 1e-12);
  }
}

TEST(HalfTurnWindow, EndsAtTheLimits)
{
  const std::vector<double> at_limit = {5.5, 0.0, 0.0, 0.0};
  EXPECT_DOUBLE_EQ(moved(space(), at_limit, at_limit, 0.5, {6.0, 0.0, 0.0, 0.0})[0], 6.0);
  EXPECT_NEAR(moved(space(), at_limit, at_limit, 0.5, {-6.0, 0.0, 0.0, 0.0})[0], 5.5 - kPi, 1e-12);
}

TEST(HalfTurnWindow, KeepsOtherValues)
{
  const std::vector<double> line = {0.0, 1.4, -19.0, 3.0};
  const std::vector<double> drawn = {0.0, -1.5, 20.0, -3.0};
  EXPECT_EQ(moved(space(), line, line, 0.5, drawn), drawn);
}
}  // namespace
}  // namespace gpu_planning_scene::core
