#include "service/change_queue.h"

#include <exception>
#include <utility>

#include "service/service_errors.h"

// Consecutive changes become one change if that leads to the same scene. If this change is rejected, bisection finds
// the wrong ones. Own method.
namespace gpu_planning_scene::core
{
namespace
{
bool changesNoSettings(const SceneChange& change)
{
  return change.is_diff && change.name.empty() && change.robot_model_name.empty() && change.fixed_frames.empty() &&
         change.state.variables.empty() && change.state.is_diff && !change.matrix && change.link_padding.empty() &&
         change.link_scale.empty() && change.colors.empty() && change.solids.empty();
}

/// Whether two changes can be merged: the objects, or the attached objects, of the second one are then appended to the
/// first one. Changes cannot be merged if one has objects and the other has attached objects, because a change applies
/// the two kinds in a fixed order.
bool canBeOne(const SceneChange& first, const SceneChange& second)
{
  // Rules for solids are applied after all objects of a change.
  if (!changesNoSettings(second) || !first.solids.empty())
    return false;
  if (second.state.attached.empty())
    return !second.objects.empty() && first.state.attached.empty();
  return second.objects.empty() && first.objects.empty() && changesNoSettings(first);
}

void append(const SceneChange& second, SceneChange& first)
{
  first.objects.insert(first.objects.end(), second.objects.begin(), second.objects.end());
  first.state.attached.insert(first.state.attached.end(), second.state.attached.begin(), second.state.attached.end());
}
}  // namespace

ChangeQueue::ChangeQueue(BeginBatch begin_batch, OnRejected on_rejected, std::size_t max_changes, std::size_t max_bytes)
  : begin_batch_(std::move(begin_batch)),
    on_rejected_(std::move(on_rejected)),
    max_changes_(max_changes),
    max_bytes_(max_bytes),
    thread_([this] { run(); })
{
}

ChangeQueue::~ChangeQueue()
{
  stop();
}

void ChangeQueue::add(std::string source, SceneChange change, std::size_t bytes)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (stopping_)
    throw ShuttingDown("shutting down: the change was not made");
  const std::size_t changes = making_ + waiting_.size();
  if (changes >= max_changes_ || (changes != 0 && bytes_ + bytes > max_bytes_))
    throw Busy("busy: " + std::to_string(changes) + " changes of " + std::to_string(bytes_) +
               " bytes are queued (limits/waiting_changes, limits/message_size); send changes at a lower "
               "rate, or use apply_planning_scene, which waits");
  bytes_ += bytes;
  waiting_.push_back({std::move(source), std::move(change), bytes});
  wake_.notify_one();
}

void ChangeQueue::stop()
{
  std::thread thread;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
    thread.swap(thread_);
  }
  wake_.notify_one();
  if (thread.joinable())
    thread.join();
}

bool ChangeQueue::isStopping() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return stopping_;
}

void ChangeQueue::run()
{
  for (;;)
  {
    Changes changes;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      making_ = 0;
      wake_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
      if (waiting_.empty())
        return;
      changes.swap(waiting_);
      making_ = changes.size();
    }
    makeAll(changes);
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const Waiting& made : changes)
      bytes_ -= made.bytes;
  }
}

void ChangeQueue::makeAll(const Changes& changes)
{
  const ApplyChange apply_change = begin_batch_();
  for (std::size_t begin = 0, end = 0; begin < changes.size(); begin = end)
  {
    for (end = begin + 1; end < changes.size() && canBeOne(changes[end - 1].change, changes[end].change);)
      ++end;
    make(apply_change, changes, begin, end);
  }
}

/// Makes the changes from `begin` to `end`, which can be merged. If the merged change is rejected, each half is tried
/// (bisection). So one wrong change among thousands is found, and all others are made, with few copies of the scene.
void ChangeQueue::make(const ApplyChange& apply_change, const Changes& changes, std::size_t begin, std::size_t end)
{
  try
  {
    if (isStopping())
      throw ShuttingDown("shutting down: the change was not made");
    if (end == begin + 1)
    {
      apply_change(changes[begin].change);
      return;
    }
    SceneChange all = changes[begin].change;
    for (std::size_t i = begin + 1; i < end; ++i)
      append(changes[i].change, all);
    apply_change(all);
  }
  catch (const std::exception& error)
  {
    if (end == begin + 1)
    {
      on_rejected_(changes[begin].source, error.what());
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    make(apply_change, changes, begin, middle);
    make(apply_change, changes, middle, end);
  }
}
}  // namespace gpu_planning_scene::core
