#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include <ros/node_handle.h>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/motion_checker.h"
#include "gpu_planning_scene/planning/collision_free_ik.h"
#include "gpu_planning_scene/state_inspector.h"
#include "node/checks/requested_scene.h"
#include "node/messages/messages.h"
#include "node/messages/other_frames.h"
#include "service/admission.h"
#include "service/checker_pool.h"
#include "service/memory_guard.h"

namespace gpu_planning_scene::core
{
struct KinematicsOptions
{
  std::size_t max_attempts = 1000000;        ///< of a request, over all its poses: ~limits/ik_attempts
  std::size_t max_solutions = 100000;        ///< of a request, over all its poses: ~limits/ik_solutions
  std::size_t max_waiting = 16;              ///< queued requests of ~compute_ik: ~limits/waiting_ik
  std::size_t max_inspected_states = 10000;  ///< solutions of a request with clearances: ~limits/inspected_states
  /// Poses in an answer of ~compute_fk, and states in one of ~compute_cartesian_path: ~limits/request_states
  std::size_t max_poses = 1000000;
  MotionCheckerOptions motions = {};  ///< of ~compute_cartesian_path: see PlanServiceOptions
};

/// The parameters ~limits/ik_attempts, ~limits/ik_solutions and ~limits/waiting_ik. Throws Error, which names the
/// parameter.
KinematicsOptions kinematicsOptionsFromParameters(const ros::NodeHandle& own);

/// Answers ~compute_ik, ~compute_cartesian_path and ~compute_fk, each in a file of its own. Throws nothing: the
/// response has the error. Thread-safe. A call blocks until it has its answer. Searches run on all cores, so at most
/// two requests of ~compute_ik and ~compute_cartesian_path are answered at the same time; further ones wait.
class KinematicsServices
{
 public:
  using InspectorOf =
      std::function<std::shared_ptr<const StateInspector>(const std::shared_ptr<const PlanningScene>& scene)>;

  static constexpr std::size_t kSearchingRequests = 2;  ///< at the same time

  /// `others`: the frames that the scene does not have. `make_checker`: makes the checkers of the searches, which
  /// check few states at a time. `inspector_of`: the inspector of a scene.
  KinematicsServices(const SceneStore& store, OtherFrames others, MakeChecker make_checker, InspectorOf inspector_of,
                     const MemoryGuard& memory, const KinematicsOptions& options);

  ComputeIk::Response computeIk(const ComputeIk::Request& request);
  ComputeCartesianPath::Response computeCartesianPath(const ComputeCartesianPath::Request& request);
  ComputeFk::Response computeFk(const ComputeFk::Request& request) const;

  /// Ends running searches. Running and queued requests get ShuttingDown.
  void stop();

 private:
  struct IkTask;

  IkTask taskOf(const ComputeIk::Request& request) const;
  void requireLimits(const ComputeIk::Request& request) const;
  std::vector<CollisionFreeIkResult> solve(const IkTask& task);
  void addClearances(const IkTask& task, const std::vector<CollisionFreeIkResult>& results,
                     ComputeIk::Response& response) const;
  void refuseIfStopping() const;

  /// Calls `work` with a leased checker. Gives the checker back, unless it may be the cause of an error. Throws
  /// ShuttingDown if the node stops meanwhile.
  template <class Work>
  auto withLease(CheckerPool::Lease& lease, const Work& work) const
  {
    try
    {
      auto result = work();
      lease.giveBack();
      refuseIfStopping();
      return result;
    }
    catch (const DeviceLost&)
    {
      throw;
    }
    catch (const Error&)
    {
      lease.giveBack();  // the request is the cause of the error
      throw;
    }
  }

  const SceneStore& store_;
  const OtherFrames others_;
  const InspectorOf inspector_of_;
  const MemoryGuard& memory_;
  const KinematicsOptions options_;
  Admission admission_;
  std::atomic<bool> stopping_{false};
  CheckerPool checkers_;
};
}  // namespace gpu_planning_scene::core
