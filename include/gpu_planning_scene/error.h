#pragma once

#include <stdexcept>
#include <string>

namespace gpu_planning_scene
{
/// A wrong input or a device that cannot be used. `what()` is one line: what is wrong, where, and what to do.
/// Whoever throws it has changed nothing.
class Error : public std::runtime_error
{
 public:
  explicit Error(const std::string& message) : std::runtime_error(message) {}
};
}  // namespace gpu_planning_scene
