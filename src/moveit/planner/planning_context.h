#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <moveit/planning_interface/planning_interface.h>

#include "gpu_planning_scene/planning/plan_motion.h"
#include "moveit/planner/joint_goals.h"
#include "moveit/planner/scene_conversion.h"
#include "planners/planner_loader.h"
#include "service/checker_pool.h"

namespace gpu_planning_scene::pipeline
{
/// The parts that all requests of a planner manager share. Contexts keep them, so a context may outlive its manager.
/// Thread-safe.
struct Workshop
{
  static constexpr std::size_t kKnownPaths = 16;  ///< as ~planning/known_paths of the node

  /// `paths`: that are kept for each group.
  explicit Workshop(core::MakeChecker make_checker, std::size_t paths = kKnownPaths)
    : checkers(std::move(make_checker)), known_paths(std::make_shared<core::KnownPaths>(paths))
  {
  }

  SceneConverter converter;
  core::CheckerPool checkers;
  core::PlannerLoader plugins;
  const std::shared_ptr<core::KnownPaths> known_paths;
};

/// How a request is planned.
struct PlannerChoice
{
  std::string type;  ///< plugin name
  std::shared_ptr<const core::PlannerFactory> factory;
  std::map<std::string, std::string> parameters;  ///< by OMPL's names
  std::vector<std::string> projection;
  std::optional<double> longest_valid_segment_fraction;
  double waypoint_distance;  ///< radians or metres: the largest change of a joint between waypoints; 0: no limit
};

/// Plans one request. The motions of a path are proven free by MotionRule::Bound. If the request asks for several
/// attempts, they follow each other within the allowed time, and the shortest path is returned. solve() must not be
/// called by two threads at once; terminate() may be called by any thread.
class PlanningContext : public planning_interface::PlanningContext
{
 public:
  PlanningContext(const std::string& group, PlannerChoice choice, std::shared_ptr<Workshop> workshop);

  bool solve(planning_interface::MotionPlanResponse& response) override;
  bool solve(planning_interface::MotionPlanDetailedResponse& response) override;
  bool terminate() override;
  void clear() override {}

 private:
  struct Outcome;

  Outcome plan();
  Outcome planOrThrow();
  core::PlanningQuery queryOf(const core::GroupStateSpace& space) const;
  core::PlanningResult planShortest(const ConvertedScene& converted, const std::shared_ptr<core::StateChecker>& checker,
                                    core::PlanningQuery query) const;
  robot_trajectory::RobotTrajectoryPtr trajectoryOf(const ConvertedScene& converted, const core::PlanningResult& result,
                                                    const moveit::core::RobotState& start) const;

  const std::shared_ptr<Workshop> workshop_;
  const PlannerChoice choice_;  // destroyed before the plugins of the workshop, because its factory is one of them
  std::atomic<bool> stopped_{false};
};
}  // namespace gpu_planning_scene::pipeline
