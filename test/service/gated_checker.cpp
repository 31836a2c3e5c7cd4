#include "service/gated_checker.h"

#include <algorithm>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
void Gate::close()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  open_ = false;
}

void Gate::open()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  open_ = true;
  changed_.notify_all();
}

void Gate::waitForChecks(std::size_t checks)
{
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [&] { return batches_.size() >= checks; });
}

std::vector<std::size_t> Gate::batches() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return batches_;
}

std::size_t Gate::checkers() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return checkers_;
}

GatedChecker::GatedChecker(std::shared_ptr<const PlanningScene> scene, Gate& gate) : gate_(gate)
{
  setScene(std::move(scene));
  const std::lock_guard<std::mutex> lock(gate_.mutex_);
  ++gate_.checkers_;
}

void GatedChecker::setScene(std::shared_ptr<const PlanningScene> scene)
{
  if (scene->name == "unusable")
    throw Error("the scene is unusable");
  scene_ = std::move(scene);
}

BatchResult GatedChecker::checkSlice(const double* states, std::size_t count, const std::string& group)
{
  {
    std::unique_lock<std::mutex> lock(gate_.mutex_);
    gate_.batches_.push_back(count);
    gate_.changed_.notify_all();
    gate_.changed_.wait(lock, [this] { return gate_.open_; });
  }
  if (!group.empty())
    scene_->robot->group(group);
  const std::size_t width = scene_->robot->variables().size();
  BatchResult result;
  result.revision = scene_->revision;
  for (std::size_t i = 0; i < count; ++i)
  {
    if (states[i * width] == 13.0)
      throw Error("13 is not a position");
    const bool free = states[i * width] >= 0.0 && scene_->revision % 2 == 0;
    result.valid.push_back(free ? 1 : 0);
    result.colliding.push_back(free ? kNoPair : BodyPair{{1, 2}});
  }
  return result;
}

BatchResult GatedChecker::checkBatch(const StateBatch& batch)
{
  constexpr std::size_t kSlice = 24;
  const std::size_t width = scene_->robot->variables().size();
  BatchResult all;
  std::size_t done = 0;
  do
  {
    if (done != 0 && batch.go_on && !batch.go_on(done))
      throw Cancelled();
    const std::size_t count = std::min(kSlice, batch.count - done);
    all.append(checkSlice(batch.states + done * width, count, batch.group));
    done += count;
  } while (done < batch.count);
  return all;
}

SceneReport GatedChecker::report(const std::string& group)
{
  if (!group.empty())
    scene_->robot->group(group);
  SceneReport report;
  report.self_pairs = 7;
  return report;
}
}  // namespace gpu_planning_scene::core
