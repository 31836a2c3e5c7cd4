#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <vector>

#include "service/check_server.h"
#include "service/make_checker.h"
#include "service/request_queue.h"

namespace gpu_planning_scene::core
{
/// Answers batches of requests with a checker of its own. The checker is made when it is first needed, and follows the
/// scenes of the requests. One caller at a time.
class CheckWorker
{
 public:
  /// Counts answered requests, just before their clients get the answers.
  using Count = std::function<void(const CheckStatistics&)>;

  /// `queue` tells when to stop. `store` and `queue` must outlive the worker.
  CheckWorker(const SceneStore& store, const RequestQueue& queue, MakeChecker make_checker, Count count);

  /// Makes the checker for the newest scene. Throws the errors of `make_checker`.
  void open() { takeScene({}); }

  /// Gives the checker the newest scene, and checks one state, because the first check of a scene makes the trees.
  /// Throws the checker's errors.
  void prepare();
  /// Whether the checker has the newest scene.
  bool isReady() const { return checked_ && store_.snapshot().scene == checked_; }

  /// Drops the checker, so that no more proofs are made for it.
  void close()
  {
    checker_.reset();
    checked_.reset();
  }

  /// Answers all requests, if need be with an error. If the batch fails, each of its requests is checked alone, so that
  /// only the wrong requests get an error.
  void answer(CheckBatch& batch);

 private:
  CheckAnswer check(CheckBatch& batch, std::size_t count);
  Snapshot takeScene(const CheckJob& job);
  void giveScene(const std::shared_ptr<const PlanningScene>& scene, bool is_own);
  bool takesOwnScene();
  BatchResult checkStates(const std::vector<double>& states, std::size_t count, const std::string& group);
  void checkMotions(const CheckJob& job, const std::vector<double>& states, CheckAnswer& answer);
  void fail(CheckRequest& request, std::exception_ptr error) const;

  const SceneStore& store_;
  const RequestQueue& queue_;
  const MakeChecker make_checker_;
  const Count count_;
  std::shared_ptr<StateChecker> checker_;
  std::shared_ptr<const PlanningScene> checked_;  // the checker's scene
};
}  // namespace gpu_planning_scene::core
