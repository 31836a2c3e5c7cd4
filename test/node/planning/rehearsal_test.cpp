// Plans are rehearsed before the first request.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "node/planning/rehearsal.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;

struct Rehearsed
{
  std::string group;
  double length;  // of the straight motion from start to goal
};

/// A planner that checks the start some times and finds nothing.
class Finder : public ob::Planner
{
 public:
  Finder(const ob::SpaceInformationPtr& information, std::vector<Rehearsed>& plans, int checks)
    : ob::Planner(information, "Finder"), plans_(plans), checks_(checks)
  {
  }

  ob::PlannerStatus solve(const ob::PlannerTerminationCondition& /*ptc*/) override
  {
    const ob::State* const start = pis_.nextStart();
    plans_.push_back({si_->getStateSpace()->getName(), si_->distance(start, pis_.nextGoal())});
    for (int i = 0; i < checks_; ++i)
      EXPECT_TRUE(si_->isValid(start));
    return ob::PlannerStatus::TIMEOUT;
  }

 private:
  std::vector<Rehearsed>& plans_;
  int checks_;
};

class FinderFactory : public PlannerFactory
{
 public:
  explicit FinderFactory(int checks) : checks_(checks) {}

  ob::PlannerPtr create(const ob::SpaceInformationPtr& information) const override
  {
    return std::make_shared<Finder>(information, plans, checks_);
  }

  mutable std::vector<Rehearsed> plans;

 private:
  int checks_;
};

/// The plans of a rehearsal in a scene. `checks`: of each plan. `most`: the node stops after so many plans.
std::vector<Rehearsed> rehearse(PlanningScene scene, int checks = 0, std::size_t most = 1000)
{
  const auto shared = std::make_shared<const PlanningScene>(std::move(scene));
  const FinderFactory factory(checks);
  rehearsePlans(shared, std::make_shared<CpuChecker>(shared), {}, factory,
                [&] { return factory.plans.size() >= most; });
  return factory.plans;
}

PlanningScene sliderWith(const std::string& srdf)
{
  std::string whole = sliderSrdf();
  return PlanningScene(RobotModel::fromXml(sliderUrdf(), whole.insert(whole.find("</robot>"), srdf), {}));
}

TEST(Rehearsal, PlansForEachGroupInTurn)
{
  const std::vector<Rehearsed> plans = rehearse(sliderAndWall());
  ASSERT_GE(plans.size(), 2U);
  EXPECT_NE(plans[0].group, plans[1].group);
}

TEST(Rehearsal, MovesOnlyTheGroup)
{
  PlanningScene scene(RobotModel::fromXml(
      sliderUrdf(), "<robot name='slider'><group name='mast'><joint name='turn'/></group></robot>", {}));
  scene.current_state = {0.3, 0.0};
  EXPECT_FALSE(rehearse(scene).empty());  // planMotion refuses a goal that moves the cart
}

TEST(Rehearsal, KeepsPassiveJoints)
{
  EXPECT_FALSE(rehearse(sliderWith("<passive_joint name='turn'/>")).empty());
}

TEST(Rehearsal, MovesBases)
{
  const std::vector<Rehearsed> plans = rehearse(PlanningScene(
      RobotModel::fromXml(sliderUrdf(),
                          "<robot name='slider'><virtual_joint name='floor' type='planar' parent_frame='hall' "
                          "child_link='rail'/><group name='base'><joint name='floor'/></group></robot>",
                          {})));
  ASSERT_FALSE(plans.empty());
  EXPECT_GT(plans.front().length, 0.0);
}

TEST(Rehearsal, LeavesOutGroupsThatCannotBePlannedFor)
{
  EXPECT_FALSE(rehearse(sliderWith("<group name='fixed'><joint name='bolt'/></group>")).empty());
}

TEST(Rehearsal, EndsWhenTheNodeStops)
{
  EXPECT_TRUE(rehearse(sliderAndWall(), 0, 0).empty());
  EXPECT_EQ(rehearse(sliderAndWall(), 0, 1).size(), 1U);
}

TEST(Rehearsal, EndsBeforeProofsAreMade)
{
  constexpr int kChecks = 5000;
  EXPECT_LE(rehearse(sliderAndWall(), kChecks).size(), 2U);  // 10,000 states, and those before the plans
}
}  // namespace
}  // namespace gpu_planning_scene::core
