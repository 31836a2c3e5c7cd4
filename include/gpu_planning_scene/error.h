#pragma once

#include <stdexcept>
#include <string>

namespace gpu_planning_scene::core
{
/// A wrong input or a device that cannot be used. `what()` is one line: what is wrong, where, and what to do.
/// Whoever throws it has changed nothing.
class Error : public std::runtime_error
{
 public:
  explicit Error(const std::string& message) : std::runtime_error(message) {}
};

/// The device, or its context, is gone or failed in a way that no input causes. Whoever throws it can do nothing more:
/// what uses the device has to be made anew.
class DeviceLost : public Error
{
 public:
  using Error::Error;
};
}  // namespace gpu_planning_scene::core
