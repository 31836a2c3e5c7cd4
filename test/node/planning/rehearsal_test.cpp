// Plans are rehearsed before the first request.

#include <cstdint>
#include <memory>

#include <gtest/gtest.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/planning/batch_rrt_connect.h"
#include "node/planning/rehearsal.h"
#include "planning/validity/counted_checker.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::uint64_t kStatesBesidePlans = 1024;

/// The number of states that a rehearsal checks.
std::uint64_t statesOfRehearsal(PlanningScene scene, const std::string& group)
{
  const auto shared = std::make_shared<const PlanningScene>(std::move(scene));
  const auto checker = std::make_shared<CountedChecker>(std::make_shared<CpuChecker>(shared));
  rehearsePlans(shared, checker, group, {}, PlannerFactoryOf<BatchRrtConnect>());
  return checker->states();
}

TEST(Rehearsal, PlansMotions)
{
  EXPECT_GT(statesOfRehearsal(sliderAndWall(), "drive"), kStatesBesidePlans);
}

TEST(Rehearsal, MovesOnlyTheGroup)
{
  PlanningScene scene = sliderAndWall();
  scene.current_state = {0.3, 0.0};
  EXPECT_GT(statesOfRehearsal(scene, "mast"), kStatesBesidePlans);  // planMotion refuses a goal that moves the cart
}

TEST(Rehearsal, PlansNothingWhereAllStatesCollide)
{
  PlanningScene scene = sliderAndWall();
  scene.current_state = {1.0, 0.0};  // the cart is in the wall, and the group does not move it
  scene.link_padding.assign(scene.robot->links().size(), 0.5);  // so the pole, 0.4 m above the wall, collides too
  EXPECT_EQ(statesOfRehearsal(scene, "mast"), kStatesBesidePlans);
}
}  // namespace
}  // namespace gpu_planning_scene::core
