#pragma once

#include <stdexcept>
#include <string>

namespace gpu_planning_scene::core
{
/// A wrong input, or a device that cannot be used. `what()` is one line: the fault, its place, and the remedy. A call
/// that throws an Error has changed nothing. This does not hold for DeviceLost.
class Error : public std::runtime_error
{
 public:
  explicit Error(const std::string& message) : std::runtime_error(message) {}
};

/// A call was ended by its caller.
class Cancelled : public Error
{
 public:
  Cancelled() : Error("cancelled") {}
};

/// A value is not known now, but may be known later: a value of the robot's current state, or a transform of tf. The
/// same call may then succeed.
class NotKnownYet : public Error
{
 public:
  using Error::Error;
};

/// The device or its context is lost, or it failed for a reason that is not the input. The object that threw this error
/// is no longer usable: create a new one.
class DeviceLost : public Error
{
 public:
  using Error::Error;
};
}  // namespace gpu_planning_scene::core
