#include "bindings/interrupt.h"

namespace gpu_planning_scene::python
{
bool Interrupt::requested()
{
  if (error_)
    return true;
  const Clock::time_point now = Clock::now();
  if (now < next_)
    return false;
  next_ = now + std::chrono::milliseconds(20);
  const pybind11::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0)
    error_.emplace();
  return error_.has_value();
}

void Interrupt::rethrow() const
{
  if (!error_)
    return;
  const pybind11::gil_scoped_acquire lock;
  throw *error_;
}
}  // namespace gpu_planning_scene::python
