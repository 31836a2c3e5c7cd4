#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <ros/node_handle.h>

#include "node/ompl_log.h"
#include "node/plan_request.h"
#include "node/planner_configs.h"
#include "node/planner_plugins.h"
#include "service/admission.h"
#include "service/check_server.h"
#include "service/memory_guard.h"

namespace gpu_planning_scene::core
{
/// Answers ~plan, and draws the last path on ~plan_markers. Throws nothing: what is wrong is said in the response. Some
/// plan at a time, each with a checker of its own, which is kept for the next; others wait. Thread-safe.
class PlanService
{
 public:
  /// Throws Error for wrong ~planners.
  PlanService(ros::NodeHandle& own, const SceneStore& store, CheckServer::MakeChecker make_checker,
              const MemoryGuard& memory, const PlanServiceOptions& options);

  PlanMotion::Response plan(const PlanMotion::Request& request);

  /// Ends the planning that runs, and tells those who wait.
  void stop();

 private:
  class CheckerLease;

  /// What a request asks for, and in which scene.
  struct Task
  {
    std::shared_ptr<const PlanningScene> scene;
    PlanningQuery query;
    std::shared_ptr<const PlannerFactory> factory;
    std::string planner;  // its name as a plugin
  };

  void fill(const PlanMotion::Request& request, PlanMotion::Response& response);
  Task taskOf(const PlanMotion::Request& request);
  PlanningResult plan(const Task& task);

  const SceneStore& store_;
  const CheckServer::MakeChecker make_checker_;
  const MemoryGuard& memory_;
  const PlanServiceOptions options_;
  const PlannerConfigs configs_;
  const OmplLog log_;
  PlannerPlugins plugins_;
  ros::Publisher markers_;
  Admission admission_;
  std::atomic<bool> stopping_{false};
  std::mutex mutex_;
  std::vector<std::shared_ptr<StateChecker>> idle_;  // mutex_ guards it
};
}  // namespace gpu_planning_scene::core
