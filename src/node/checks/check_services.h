#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>

#include "gpu_planning_scene/state_inspector.h"
#include "node/messages/messages.h"
#include "service/admission.h"
#include "service/check_server.h"
#include "service/memory_guard.h"

namespace gpu_planning_scene::core
{
struct CheckServicesOptions
{
  std::size_t max_states = 1000000;            ///< samples of all motions of one request
  std::size_t max_motion_checks = 10000000;    ///< state checks for all motions of one request
  std::size_t max_inspected_states = 10000;    ///< states of one request with contacts or clearance
  std::size_t max_contacts = 100000;           ///< in one response
  std::size_t max_waiting_inspections = 64;    ///< queued requests for contacts or clearance
  MotionRule motion_rule = MotionRule::Bound;  ///< rule of requests that name none: ~planning/motion_rule
};

/// Answers check_states, check_motions and get_report. Throws nothing: the response has the error. Thread-safe. A call
/// blocks until it has its answer. Contacts and clearance are computed on the thread of the call. They can keep a core
/// busy for long, so at most two calls compute them at the same time.
class CheckServices
{
 public:
  CheckServices(const SceneStore& store, CheckServer& server, const MemoryGuard& memory,
                const CheckServicesOptions& options);

  CheckStates::Response checkStates(const CheckStates::Request& request);
  /// Checks one state in another scene than the store's, on the CPU. `state`: one value per variable. Of `request`,
  /// only the group and the numbers of contacts are used. Of the response, only `valid`, the bodies and the contacts
  /// are set.
  CheckStates::Response checkState(std::shared_ptr<const PlanningScene> scene, const std::vector<double>& state,
                                   const CheckStates::Request& request);
  CheckMotions::Response checkMotions(const CheckMotions::Request& request);
  GetReport::Response report(const GetReport::Request& request);

  /// Stops the computation of contacts and clearance. Running and queued requests for them get the error "shutting
  /// down". Other requests get this error if they wait for a checker for some seconds more.
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
  std::mutex mutex_;                                 // guards the two members below
  std::shared_ptr<const PlanningScene> inspected_;   // the newest scene of a request for contacts or clearance
  std::shared_ptr<const StateInspector> inspector_;  // of that scene
};
}  // namespace gpu_planning_scene::core
