#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>

#include "collision/problem/state_range.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/state_inspector.h"
#include "node/messages/messages.h"
#include "node/messages/other_frames.h"
#include "service/admission.h"
#include "service/check_server.h"
#include "service/memory_guard.h"

namespace gpu_planning_scene::core
{
struct CheckServicesOptions
{
  std::size_t max_states = 1000000;               ///< samples of all motions of one request
  std::size_t max_motion_checks = 10000000;       ///< state checks for all motions of one request
  std::size_t max_inspected_states = 10000;       ///< states of one request with contacts or clearance
  std::size_t max_contacts = 100000;              ///< in one response
  std::size_t max_waiting_inspections = 64;       ///< queued requests for contacts or clearance
  MotionRule motion_rule = MotionRule::Bound;     ///< rule of requests that name none: ~planning/motion_rule
  std::chrono::milliseconds revision_wait{1000};  ///< longest wait for the revision that a request names
  std::size_t max_revision_waits = 64;            ///< requests that wait for their revision
};

/// Answers check_states, check_motions, check_trajectory and get_report, each in a file of its own. Throws nothing: the
/// response has the error. Thread-safe. A call blocks until it has its answer. Contacts and clearance are computed on
/// the thread of the call. They can keep a core busy for long, so at most two calls compute them at the same time.
class CheckServices
{
 public:
  /// `others`: the frames of requests that the scene does not have.
  CheckServices(const SceneStore& store, CheckServer& server, const MemoryGuard& memory,
                const CheckServicesOptions& options, OtherFrames others);

  CheckStates::Response checkStates(const CheckStates::Request& request);
  CheckMotions::Response checkMotions(const CheckMotions::Request& request);
  CheckTrajectory::Response checkTrajectory(const CheckTrajectory::Request& request);
  GetReport::Response report(const GetReport::Request& request);

  /// An inspector of this scene. The inspector of the newest scene is kept. Throws Error as StateInspector does.
  std::shared_ptr<const StateInspector> inspectorOf(const std::shared_ptr<const PlanningScene>& scene);

  /// Stops the computation of contacts, clearance and distances, and the waits for revisions. These requests, running
  /// and queued, get the status SHUTTING_DOWN. Other requests get this status if they wait for a checker for some
  /// seconds more.
  void stop();

 private:
  CheckAnswer answerOf(CheckJob job) const;
  std::optional<Snapshot> wantedScene(std::uint64_t revision);
  void inspect(const CheckStates::Request& request, const CheckAnswer& answer,
               const std::vector<int>& gradient_variables, CheckStates::Response& response);
  void measure(const CheckStates::Request& request, const CheckAnswer& answer, const StateInspector& inspector,
               const StateRange& part, const std::vector<int>& gradient_variables,
               CheckStates::Response& response) const;

  const SceneStore& store_;
  CheckServer& server_;
  const MemoryGuard& memory_;
  const CheckServicesOptions options_;
  const OtherFrames others_;
  Admission inspections_;
  Admission revision_waits_;
  std::atomic<bool> stopping_{false};
  std::mutex mutex_;                                 // guards the two members below
  std::shared_ptr<const PlanningScene> inspected_;   // the newest scene of a request for contacts or clearance
  std::shared_ptr<const StateInspector> inspector_;  // of that scene
};
}  // namespace gpu_planning_scene::core
