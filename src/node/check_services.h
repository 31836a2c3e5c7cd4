#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>

#include "gpu_planning_scene/state_inspector.h"
#include "node/messages.h"
#include "service/admission.h"
#include "service/check_server.h"
#include "service/memory_guard.h"

namespace gpu_planning_scene::core
{
struct CheckServicesOptions
{
  std::size_t most_states = 1000000;           ///< of the motions of one request
  std::size_t most_inspected_states = 10000;   ///< of one request, for contacts and clearance
  std::size_t most_contacts = 100000;          ///< in one answer
  std::size_t most_waiting_inspections = 64;   ///< requests for contacts or clearance
  MotionRule motion_rule = MotionRule::Bound;  ///< of requests that name none: ~planning/motion_rule
};

/// Answers check_states, check_motions and get_report. Throws nothing: what is wrong with a request is said in the
/// response. Thread-safe; a call waits for its answer, and looks for contacts and clearance on its own thread: two at a
/// time do, as each of them can keep a core for long.
class CheckServices
{
 public:
  CheckServices(const SceneStore& store, CheckServer& server, const MemoryGuard& memory,
                const CheckServicesOptions& options);

  CheckStates::Response checkStates(const CheckStates::Request& request);
  CheckMotions::Response checkMotions(const CheckMotions::Request& request);
  GetReport::Response report(const GetReport::Request& request);

  /// Looks at no further state. What waits for its turn, or for a checker that takes more than some seconds, is told
  /// that it was not answered.
  void stop();

 private:
  CheckAnswer answerOf(CheckJob job) const;
  void inspect(const CheckStates::Request& request, const CheckAnswer& answer, CheckStates::Response& response);
  std::shared_ptr<const StateInspector> inspectorOf(const std::shared_ptr<const PlanningScene>& scene);

  const SceneStore& store_;
  CheckServer& server_;
  const MemoryGuard& memory_;
  const CheckServicesOptions options_;
  Admission inspections_;
  std::atomic<bool> stopping_{false};
  std::mutex mutex_;  // of the two below: the inspector of the newest scene that was asked about
  std::shared_ptr<const PlanningScene> inspected_;
  std::shared_ptr<const StateInspector> inspector_;
};
}  // namespace gpu_planning_scene::core
