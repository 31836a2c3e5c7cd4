#pragma once

#include <chrono>
#include <optional>

#include <pybind11/pybind11.h>

namespace gpu_planning_scene::python
{
/// Lets a long call end when the user presses Ctrl-C. The call runs without the interpreter's lock and tests
/// requested() between its parts. Then it calls rethrow(). Lives on the thread of the call.
class Interrupt
{
 public:
  /// Lets Python run the handlers of signals, at most every 20 ms. True: a handler raised an exception, for example
  /// KeyboardInterrupt. Only the main thread runs handlers.
  bool requested();

  /// Throws the exception of the handler, if there is one.
  void rethrow() const;

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point next_ = Clock::now();
  std::optional<pybind11::error_already_set> error_;
};
}  // namespace gpu_planning_scene::python
