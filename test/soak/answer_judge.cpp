#include "soak/answer_judge.h"

#include "collision/collision_problem.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "oracle/problem_oracle.h"

namespace gpu_planning_scene
{
AnswerJudge::AnswerJudge(SceneHistory& history, std::size_t oracle_samples_wanted)
  : history_(history), most_samples_(oracle_samples_wanted), thread_([this] { run(); })
{
}

AnswerJudge::~AnswerJudge()
{
  finish();
}

void AnswerJudge::add(std::vector<double> asked, std::vector<std::uint8_t> valid, std::uint64_t revision)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  waiting_.push_back({std::move(asked), std::move(valid), revision});
  changed_.notify_one();
}

void AnswerJudge::finish()
{
  if (!thread_.joinable())
    return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    finishing_ = true;
    changed_.notify_one();
  }
  thread_.join();
  for (const Sample& sample : samples_)
    askOracle(sample);
}

void AnswerJudge::run()
{
  for (;;)
  {
    Answer answer;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return finishing_ || !waiting_.empty(); });
      if (waiting_.empty())
        return;
      answer = std::move(waiting_.front());
      waiting_.pop_front();
    }
    judge(answer);
  }
}

void AnswerJudge::judge(const Answer& answer)
{
  const std::shared_ptr<const PlanningScene> scene = history_.at(answer.revision);
  ++answers;
  if (!scene)
  {
    ++unknown_scenes;
    return;
  }
  if (!checker_)
    checker_ = std::make_unique<CpuChecker>(scene);
  else if (checked_ != scene)
    checker_->setScene(scene);
  checked_ = scene;
  const std::size_t count = answer.valid.size();
  const BatchResult again = checker_->check(answer.states.data(), count);
  for (std::size_t i = 0; i < count; ++i)
    wrong += again.valid[i] == answer.valid[i] ? 0 : 1;
  states += count;

  // One state of each hundredth answer.
  const std::size_t width = scene->robot->variables().size();
  if (answers % 100 == 1 && samples_.size() < most_samples_ && count != 0)
    samples_.push_back({{answer.states.begin(), answer.states.begin() + static_cast<std::ptrdiff_t>(width)},
                        answer.valid[0] != 0,
                        scene});
}

void AnswerJudge::askOracle(const Sample& sample)
{
  const oracle::ProblemOracle judge_of_scene(
      std::make_shared<const CollisionProblem>(makeProblem(*sample.scene, "", nullptr)));
  const oracle::Verdict verdict = judge_of_scene.verdict(oracle::linkPoses(*sample.scene->robot, sample.state.data()));
  ++oracle_samples;
  if (verdict == (sample.valid ? oracle::Verdict::Collides : oracle::Verdict::Free))
    ++oracle_wrong;
}
}  // namespace gpu_planning_scene
