#include "soak/answer_judge.h"

#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>

#include "collision/bounds/problem_maker.h"
#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "oracle/problem_oracle.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Whole states. Variables that the request does not name have the values of the scene's current state.
std::vector<double> statesOf(const CheckStates::Request& request, const PlanningScene& scene)
{
  const std::size_t width = scene.robot->variables().size();
  const std::size_t given = request.joint_names.size();
  const std::vector<double> current = scene.current_state.empty() ? scene.robot->defaultState() : scene.current_state;
  std::vector<double> states;
  for (std::size_t row = 0; row < request.positions.size() / given; ++row)
  {
    states.insert(states.end(), current.begin(), current.end());
    for (std::size_t i = 0; i < given; ++i)
      states[row * width + static_cast<std::size_t>(scene.robot->variableIndex(request.joint_names[i]))] =
          request.positions[row * given + i];
  }
  return states;
}

/// Whether the response has a verdict for each state, has names and contacts exactly for states in collision, and has
/// clearance 0 for them.
bool fits(const CheckStates& call, std::size_t count)
{
  const CheckStates::Response& response = call.response;
  if (response.valid.size() != count || response.body_1.size() != count || response.body_2.size() != count)
    return false;
  std::vector<bool> touched(count, false);
  for (const ContactInformation& contact : response.contacts)
    if (contact.state >= count || response.valid[contact.state] != 0)
      return false;
    else
      touched[contact.state] = true;
  if (call.request.clearance && response.clearance_world.size() != count)
    return false;
  for (std::size_t i = 0; i < count; ++i)
  {
    const bool collides = response.valid[i] == 0;
    if (response.body_1[i].empty() == collides || response.body_2[i].empty() == collides)
      return false;
    if (call.request.max_contacts != 0 && touched[i] != collides)
      return false;
    if (call.request.clearance && collides && std::min(response.clearance_world[i], response.clearance_self[i]) != 0.0)
      return false;
  }
  return true;
}
}  // namespace

AnswerJudge::AnswerJudge(SceneHistory& history, std::size_t oracle_samples_wanted)
  : history_(history), max_samples_(oracle_samples_wanted), thread_([this] { run(); })
{
}

AnswerJudge::~AnswerJudge()
{
  finish();
}

void AnswerJudge::add(const CheckStates& answered, std::uint64_t least_revision)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  waiting_.push_back({answered, least_revision});
  changed_.notify_one();
}

std::size_t AnswerJudge::waiting() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return waiting_.size();
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
    checkWithOracle(sample);
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
  const CheckStates::Response& response = answer.call.response;
  const std::shared_ptr<const PlanningScene> scene = history_.at(response.scene_revision);
  ++answers;
  too_old += response.scene_revision < answer.least_revision ? 1 : 0;
  if (!scene)
  {
    ++unknown_scenes;
    return;
  }
  const std::vector<double> asked = statesOf(answer.call.request, *scene);
  const std::size_t width = scene->robot->variables().size();
  const std::size_t count = asked.size() / width;
  if (!fits(answer.call, count))
  {
    ++malformed;
    return;
  }
  if (!checker_)
    checker_ = std::make_unique<CpuChecker>(scene);
  else if (checked_ != scene)
    checker_->setScene(scene);
  checked_ = scene;
  const BatchResult again = checker_->check(asked.data(), count);
  for (std::size_t i = 0; i < count; ++i)
    wrong += again.valid[i] == response.valid[i] ? 0 : 1;
  states += count;

  // The first state of every 20th answer.
  constexpr std::size_t kAnswersPerSample = 20;
  if (answers % kAnswersPerSample == 1 && samples_.size() < max_samples_ && count != 0)
    samples_.push_back(
        {{asked.begin(), asked.begin() + static_cast<std::ptrdiff_t>(width)}, response.valid[0] != 0, scene});
}

void AnswerJudge::checkWithOracle(const Sample& sample)
{
  const oracle::ProblemOracle judge_of_scene(
      std::make_shared<const CollisionProblem>(makeProblem(*sample.scene, "", nullptr)));
  const oracle::Verdict verdict = judge_of_scene.verdict(oracle::linkPoses(*sample.scene->robot, sample.state.data()));
  ++oracle_samples;
  if (verdict == (sample.valid ? oracle::Verdict::Collides : oracle::Verdict::Free))
    ++oracle_wrong;
}

void AnswerJudge::expectNoWrongAnswer() const
{
  std::printf("%zu answers with %zu states checked again, %zu by the oracle\n", answers, states, oracle_samples);
  EXPECT_EQ(0u, wrong);
  EXPECT_EQ(0u, malformed);
  EXPECT_EQ(0u, too_old);
  EXPECT_EQ(0u, unknown_scenes);
  EXPECT_EQ(0u, oracle_wrong);
}
}  // namespace gpu_planning_scene::core
