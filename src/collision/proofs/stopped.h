#pragma once

#include <exception>
#include <functional>

namespace gpu_planning_scene::core
{
/// Tells whether proofs that are being made are no longer needed. Several threads may call it. An empty function never
/// stops the work.
using Stopped = std::function<bool()>;

/// Thrown by the functions that make proofs if their work is stopped.
class ProofsStopped : public std::exception
{
 public:
  const char* what() const noexcept override { return "the proofs are no longer needed"; }
};

inline bool isStopped(const Stopped& stopped)
{
  return stopped && stopped();
}

/// Ends a loop of many short steps: throws ProofsStopped soon after the work was stopped.
class StopTest
{
 public:
  /// `steps`: a step in so many calls `stopped`. They should take less than a millisecond together, because a thread of
  /// low priority may get a small share of a busy processor.
  explicit StopTest(const Stopped& stopped, unsigned steps = 1) : stopped_(stopped), steps_(steps) {}

  void operator()()
  {
    if (++step_ % steps_ == 0 && isStopped(stopped_))
      throw ProofsStopped();
  }

 private:
  const Stopped& stopped_;
  unsigned steps_;
  unsigned step_ = 0;
};
}  // namespace gpu_planning_scene::core
