#include <memory>

#include <ompl/geometric/planners/est/BiEST.h>
#include <ompl/geometric/planners/est/EST.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/kpiece/BKPIECE1.h>
#include <ompl/geometric/planners/kpiece/KPIECE1.h>
#include <ompl/geometric/planners/kpiece/LBKPIECE1.h>
#include <ompl/geometric/planners/prm/LazyPRM.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/prm/PRMstar.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/geometric/planners/rrt/TRRT.h>
#include <ompl/geometric/planners/sbl/SBL.h>
#include <pluginlib/class_list_macros.hpp>

#include "gpu_planning_scene/planning/anytime_batch.h"
#include "gpu_planning_scene/planning/batch_rrt_connect.h"
#include "gpu_planning_scene/planning/planner_factory.h"

// The planners that this package exports to pluginlib, by the names of planner_plugins.xml: its own, and those of
// OMPL's that MoveIt's users know, by the names that they have in an ompl_planning.yaml.
namespace gpu_planning_scene::core
{
/// Without the parameters for ordered sampling, with which OMPL 1.5's RRTstar uses a sampler that it has not made.
class RrtStarFactory : public PlannerFactory
{
 public:
  ompl::base::PlannerPtr create(const ompl::base::SpaceInformationPtr& information) const override
  {
    auto planner = std::make_shared<ompl::geometric::RRTstar>(information);
    planner->params().remove("ordered_sampling");
    planner->params().remove("ordering_batch_size");
    return planner;
  }
};
}  // namespace gpu_planning_scene::core

#define GPS_EXPORT_PLANNER(planner) \
  PLUGINLIB_EXPORT_CLASS(gpu_planning_scene::core::PlannerFactoryOf<planner>, gpu_planning_scene::core::PlannerFactory)

GPS_EXPORT_PLANNER(gpu_planning_scene::core::AnytimeBatch)
GPS_EXPORT_PLANNER(gpu_planning_scene::core::BatchRrtConnect)
GPS_EXPORT_PLANNER(ompl::geometric::BITstar)
GPS_EXPORT_PLANNER(ompl::geometric::BiEST)
GPS_EXPORT_PLANNER(ompl::geometric::BKPIECE1)
GPS_EXPORT_PLANNER(ompl::geometric::EST)
GPS_EXPORT_PLANNER(ompl::geometric::KPIECE1)
GPS_EXPORT_PLANNER(ompl::geometric::LBKPIECE1)
GPS_EXPORT_PLANNER(ompl::geometric::LazyPRM)
GPS_EXPORT_PLANNER(ompl::geometric::PRM)
GPS_EXPORT_PLANNER(ompl::geometric::PRMstar)
GPS_EXPORT_PLANNER(ompl::geometric::RRT)
GPS_EXPORT_PLANNER(ompl::geometric::RRTConnect)
GPS_EXPORT_PLANNER(ompl::geometric::SBL)
GPS_EXPORT_PLANNER(ompl::geometric::TRRT)
PLUGINLIB_EXPORT_CLASS(gpu_planning_scene::core::RrtStarFactory, gpu_planning_scene::core::PlannerFactory)
