// Random states move within half a turn of a straight line between two roots.

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <ompl/base/PlannerData.h>
#include <ompl/base/ScopedState.h>

#include "base/math_constants.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/planning/batch_rrt_connect.h"
#include "gpu_planning_scene/planning/group_state_space.h"
#include "gpu_planning_scene/planning/motion_validator.h"
#include "gpu_planning_scene/planning/state_validity_checker.h"
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
TEST(PlaceOfBranch, IsNearAllPairsOfRootsEquallyOften)
{
  constexpr std::size_t kTimes = 100;
  for (const std::size_t starts : {1, 2})
    for (std::size_t goals = 1; goals <= 8; ++goals)
    {
      std::map<std::pair<std::size_t, std::size_t>, std::vector<double>> places;
      std::size_t whole_space = 0;
      for (std::size_t i = 0; i < 4 * starts * goals * kTimes; ++i)
        if (const auto place = placeOfBranch(i, starts, goals))
          places[{place->start, place->goal}].push_back(place->t);
        else
          ++whole_space;
      EXPECT_EQ(whole_space, starts * goals * kTimes);
      EXPECT_EQ(places.size(), starts * goals);
      for (const auto& [pair, along] : places)
      {
        EXPECT_EQ(along.size(), 3 * kTimes);
        EXPECT_NEAR(std::accumulate(along.begin(), along.end(), 0.0) / (3.0 * kTimes), 0.5, 0.01);
        EXPECT_GE(*std::min_element(along.begin(), along.end()), 0.0);
        EXPECT_LT(*std::max_element(along.begin(), along.end()), 1.0);
      }
    }
}
/// A cube that turns about x by up to 40 rad to both sides and slides along x, before a wall that it cannot pass.
TEST(BatchRrtConnect, GrowsMostlyNearTheLine)
{
  auto scene = std::make_shared<PlanningScene>(
      robotOf(boxLink("base") + boxLink("cart") + boxLink("cube") +
                  jointXml("slide", "prismatic", "base", "cart",
                           "<axis xyz='1 0 0'/><limit lower='3' upper='5' effort='1' velocity='1'/>") +
                  jointXml("wide", "revolute", "cart", "cube",
                           "<axis xyz='1 0 0'/><limit lower='-40' upper='40' effort='1' velocity='1'/>"),
              "<group name='all'><joint name='slide'/><joint name='wide'/></group>"
              "<disable_collisions link1='cart' link2='cube' reason='Adjacent'/>"));
  scene->objects.emplace_back();
  scene->objects.back().id = "wall";
  scene->objects.back().pose.translation().x() = 4.0;
  scene->objects.back().shapes = {{Box{Eigen::Vector3d(0.1, 9.0, 9.0)}, Eigen::Isometry3d::Identity()}};
  const auto space = std::make_shared<GroupStateSpace>(scene->robot, "all");
  const auto information = std::make_shared<ob::SpaceInformation>(space);
  const auto checker = std::make_shared<CpuChecker>(scene);
  information->setStateValidityChecker(std::make_shared<StateValidityChecker>(information, scene, checker));
  information->setMotionValidator(std::make_shared<MotionValidator>(information, scene, checker));
  information->setup();
  ob::ScopedState<> start(space);
  ob::ScopedState<> goal(space);
  start = std::vector<double>{3.0, 0.0};
  goal = std::vector<double>{5.0, 0.0};
  const auto problem = std::make_shared<ob::ProblemDefinition>(information);
  problem->setStartAndGoalStates(start, goal);
  BatchRrtConnect planner(information);
  planner.setSearches(1);
  planner.setMaxRounds(50);
  planner.setExactOnly(true);
  planner.setProblemDefinition(problem);
  planner.setup();
  ASSERT_EQ(planner.Planner::solve(60.0), ob::PlannerStatus::TIMEOUT);

  ob::PlannerData data(information);
  planner.getPlannerData(data);
  unsigned int near = 0;
  for (unsigned int i = 0; i < data.numVertices(); ++i)
    near += std::abs(ob::ScopedState<>(space, data.getVertex(i).getState()).reals()[1]) <= kPi ? 1 : 0;
  ASSERT_GT(data.numVertices(), 50U);
  EXPECT_GT(4 * near, data.numVertices());  // of uniform states, one in thirteen
}
}  // namespace
}  // namespace gpu_planning_scene::core
