#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <ros/node_handle.h>

#include "node/markers/shown_plan.h"
#include "node/messages/other_frames.h"
#include "node/planning/ompl_log.h"
#include "node/planning/plan_request.h"
#include "planners/planner_configs.h"
#include "planners/planner_loader.h"
#include "service/admission.h"
#include "service/checker_pool.h"
#include "service/memory_guard.h"

namespace gpu_planning_scene::core
{
/// Answers ~plan, and hands each plan over to RViz's markers. Throws nothing: the response has the error. Several
/// requests are planned at the same time, each with its own checker; further requests wait. Checkers are kept for later
/// requests. Thread-safe.
class PlanService
{
 public:
  using Show = std::function<void(std::shared_ptr<const ShownPlan>)>;

  /// `make_checker`: makes checkers whose errors are those of requests, except if they do not take the store's own
  /// scene. Each check should begin on the caller's thread, because a planner checks some hundred states at a time.
  /// `others`: the frames of requests that the scene does not have. `show`: gets each plan, on the thread of its
  /// request. Throws Error for wrong values in ~planners.
  PlanService(ros::NodeHandle& own, const SceneStore& store, OtherFrames others, MakeChecker make_checker,
              const MemoryGuard& memory, Show show, const PlanServiceOptions& options);

  /// Loads the planners that the groups have by default, and rehearses plans (rehearsePlans), so that the first request
  /// takes about as long as later ones. What fails here fails again in a request, which then says why.
  void prepare();

  PlanMotion::Response plan(const PlanMotion::Request& request);

  /// Ends running planners. Running and queued requests get ShuttingDown.
  void stop();

 private:
  /// A request, converted, with the scene for which it is planned.
  struct Task
  {
    std::shared_ptr<const PlanningScene> scene;
    bool is_own_scene;  // the request does not change the scene for itself
    PlanningQuery query;
    std::optional<PathTimingOptions> timing;  // no value: the answer has no times
    std::shared_ptr<const PlannerFactory> factory;
    std::string planner;                // plugin name of the planner
    std::vector<std::string> warnings;  // for the answer
  };

  struct Answer
  {
    PlanningResult plan;
    std::optional<TimedPath> timed;  // of a path, if the request wants times
  };

  /// Returns the status of the response.
  std::uint8_t fill(const PlanMotion::Request& request, PlanMotion::Response& response);
  std::shared_ptr<const PlannerFactory> factoryOf(const PlannerConfig& config, const std::string& requested);
  Task taskOf(const PlanMotion::Request& request);
  Answer plan(const Task& task);

  const SceneStore& store_;
  const OtherFrames others_;
  const MemoryGuard& memory_;
  const Show show_;
  const PlanServiceOptions options_;
  const std::shared_ptr<KnownPaths> known_paths_;
  const PlannerConfigs configs_;
  const OmplLog log_;
  PlannerLoader plugins_;
  Admission admission_;
  std::atomic<bool> stopping_{false};
  CheckerPool checkers_;
};
}  // namespace gpu_planning_scene::core
