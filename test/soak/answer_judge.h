#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "node/messages/messages.h"
#include "soak/scene_history.h"

namespace gpu_planning_scene::core
{
/// Checks every answer again in its own thread, with the exact checker on the CPU and the scene that the answer names.
/// The oracle checks a sample of the states.
class AnswerJudge
{
 public:
  AnswerJudge(SceneHistory& history, std::size_t oracle_samples);
  ~AnswerJudge();

  /// `least_revision`: revision of the newest change that was acknowledged before the request was sent.
  void add(const CheckStates& answered, std::uint64_t least_revision);
  /// The number of answers that are not checked yet.
  std::size_t waiting() const;
  /// Waits until all answers are checked, then asks the oracle.
  void finish();
  /// Prints the counts after finish(). An answer that is wrong, malformed, too old or for an unknown scene is a failure
  /// of the test.
  void expectNoWrongAnswer() const;

  std::size_t answers = 0;  ///< valid after finish(), like the following counts
  std::size_t states = 0;
  std::size_t wrong = 0;           ///< states for which the exact checker has another verdict
  std::size_t malformed = 0;       ///< answers whose fields contradict each other
  std::size_t too_old = 0;         ///< answers for a scene that is older than an acknowledged change
  std::size_t unknown_scenes = 0;  ///< answers whose scene was never published
  std::size_t oracle_samples = 0;
  std::size_t oracle_wrong = 0;

 private:
  struct Answer
  {
    CheckStates call;
    std::uint64_t least_revision = 0;
  };
  struct Sample
  {
    std::vector<double> state;
    bool valid = false;
    std::shared_ptr<const PlanningScene> scene;
  };
  void run();
  void judge(const Answer& answer);
  void checkWithOracle(const Sample& sample);

  SceneHistory& history_;
  const std::size_t max_samples_;
  std::unique_ptr<class CpuChecker> checker_;
  std::shared_ptr<const PlanningScene> checked_;
  std::vector<Sample> samples_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Answer> waiting_;
  bool finishing_ = false;
  std::thread thread_;
};
}  // namespace gpu_planning_scene::core
