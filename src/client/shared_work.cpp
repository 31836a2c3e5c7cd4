#include "client/shared_work.h"

#include <numeric>

namespace gpu_planning_scene::core
{
SharedWork::SharedWork(std::vector<CheckStates::Request> parts)
  : parts_(std::move(parts)), answers_(parts_.size()), open_(parts_.size())
{
  std::iota(open_.begin(), open_.end(), 0);
}

std::optional<std::size_t> SharedWork::take()
{
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return is_stopped_ || !open_.empty() || answered_ == parts_.size(); });
  if (is_stopped_ || open_.empty())
    return std::nullopt;
  const std::size_t part = open_.front();
  open_.pop_front();
  return part;
}

void SharedWork::answer(std::size_t part, CheckStates::Response answer)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  answers_[part] = std::move(answer);
  if (++answered_ == parts_.size())
    changed_.notify_all();
}

void SharedWork::giveBack(std::size_t part)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  open_.push_front(part);
  changed_.notify_one();
}

void SharedWork::stop()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  is_stopped_ = true;
  changed_.notify_all();
}

std::size_t SharedWork::answeredCount() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return answered_;
}
}  // namespace gpu_planning_scene::core
