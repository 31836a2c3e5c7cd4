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

/// The length of the straight motion from start to goal, of each plan.
using Lengths = std::vector<double>;

/// A planner that finds nothing.
class Finder : public ob::Planner
{
 public:
  Finder(const ob::SpaceInformationPtr& information, Lengths& lengths)
    : ob::Planner(information, "Finder"), lengths_(lengths)
  {
  }

  ob::PlannerStatus solve(const ob::PlannerTerminationCondition& /*ptc*/) override
  {
    lengths_.push_back(si_->distance(pis_.nextStart(), pis_.nextGoal()));
    return ob::PlannerStatus::TIMEOUT;
  }

 private:
  Lengths& lengths_;
};

class FinderFactory : public PlannerFactory
{
 public:
  ob::PlannerPtr create(const ob::SpaceInformationPtr& information) const override
  {
    return std::make_shared<Finder>(information, lengths);
  }

  mutable Lengths lengths;
};

/// The plans of a rehearsal in a scene.
Lengths rehearse(PlanningScene scene, bool stop = false)
{
  const auto shared = std::make_shared<const PlanningScene>(std::move(scene));
  const FinderFactory factory;
  rehearsePlans(shared, std::make_shared<CpuChecker>(shared), {}, factory, [stop] { return stop; });
  return factory.lengths;
}

PlanningScene sliderWith(const std::string& srdf)
{
  std::string whole = sliderSrdf();
  return PlanningScene(RobotModel::fromXml(sliderUrdf(), whole.insert(whole.find("</robot>"), srdf), {}));
}

TEST(Rehearsal, PlansBetweenDifferentStates)
{
  const Lengths lengths = rehearse(sliderAndWall());
  ASSERT_FALSE(lengths.empty());
  for (const double length : lengths)
    EXPECT_GT(length, 0.0);
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
  const Lengths lengths = rehearse(PlanningScene(
      RobotModel::fromXml(sliderUrdf(),
                          "<robot name='slider'><virtual_joint name='floor' type='planar' parent_frame='hall' "
                          "child_link='rail'/><group name='base'><joint name='floor'/></group></robot>",
                          {})));
  ASSERT_FALSE(lengths.empty());
  for (const double length : lengths)
    EXPECT_GT(length, 0.0);
}

TEST(Rehearsal, LeavesOutGroupsThatCannotBePlannedFor)
{
  EXPECT_FALSE(rehearse(sliderWith("<group name='fixed'><joint name='bolt'/></group>")).empty());
}

TEST(Rehearsal, EndsWhenTheNodeStops)
{
  EXPECT_TRUE(rehearse(sliderAndWall(), true).empty());
}
}  // namespace
}  // namespace gpu_planning_scene::core
