#include "lanes/command_queue.h"

#include <utility>

namespace lanes
{
void CommandQueue::setSeed(std::uint64_t seed)
{
  random_.seed(seed + 77);
  constexpr std::uint32_t kCatchUpOneIn[] = {1, 4, 16, 256};
  catch_up_one_in_ = kCatchUpOneIn[random_() % 4];
}

void CommandQueue::add(std::function<void()> command)
{
  commands_.push_back(std::move(command));
  ++added_;
  if (oneIn(catch_up_one_in_))
    finish(added_ - random_() % commands_.size());
}

void CommandQueue::finish(Serial last)
{
  while (!commands_.empty() && executed_ < last)
  {
    const std::function<void()> command = std::move(commands_.front());
    commands_.pop_front();
    ++executed_;
    command();
  }
}
}  // namespace lanes
