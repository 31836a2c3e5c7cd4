#include "node/endpoints/bounded_message.h"

#include <atomic>

namespace gpu_planning_scene::core
{
namespace
{
std::atomic<std::uint32_t> message_limit{256U << 20};
}  // namespace

void setMessageLimit(std::uint32_t bytes)
{
  message_limit = bytes;
}

void requireMessageSize(std::uint32_t bytes)
{
  const std::uint32_t limit = message_limit;
  if (bytes > limit)
    throw std::runtime_error("the message has " + std::to_string(bytes) + " bytes; the limit is " +
                             std::to_string(limit) + " (~limits/message_size)");
}

void BoundedStream::next(std::string& text)
{
  const std::uint32_t size = length(1);
  text.assign(reinterpret_cast<const char*>(at_), size);
  at_ += size;
}

void BoundedStream::next(ros::Time& time)
{
  next(time.sec);
  next(time.nsec);
}

void BoundedStream::next(ros::Duration& duration)
{
  next(duration.sec);
  next(duration.nsec);
}

std::uint32_t BoundedStream::length(std::size_t least)
{
  std::uint32_t count = 0;
  copy(&count, sizeof count);
  require(count * least);
  return count;
}

void BoundedStream::copy(void* to, std::size_t bytes)
{
  require(bytes);
  if (bytes != 0)
    std::memcpy(to, at_, bytes);
  at_ += bytes;
}

void BoundedStream::require(std::size_t bytes) const
{
  if (static_cast<std::size_t>(end_ - at_) < bytes)
    throw std::runtime_error("the message ends early, or one of its lengths is wrong");
}
}  // namespace gpu_planning_scene::core
