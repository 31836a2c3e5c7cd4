#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <random>

namespace lanes
{
/// The commands that a device has accepted and not yet executed, in their order. A seed decides how far the device is
/// behind. So what the host does without a command, for example to mapped memory, may happen before earlier commands.
class CommandQueue
{
 public:
  /// The number of a command, from 1 on.
  using Serial = std::uint64_t;

  /// Also chooses how far the device lags.
  void setSeed(std::uint64_t seed);

  /// Adds a command. The device then executes some of the oldest commands.
  void add(std::function<void()> command);

  /// Executes all commands, or those up to `last`.
  void finish() { finish(added_); }
  void finish(Serial last);

  Serial lastAdded() const { return added_; }
  Serial lastExecuted() const { return executed_; }

  /// True in one of `n` cases.
  bool oneIn(std::uint32_t n) { return random_() % n == 0; }

 private:
  std::deque<std::function<void()>> commands_;
  Serial added_ = 0;
  Serial executed_ = 0;
  std::mt19937_64 random_{1};
  std::uint32_t catch_up_one_in_ = 4;
};
}  // namespace lanes
