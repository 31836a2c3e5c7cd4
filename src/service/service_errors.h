#pragma once

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
// Errors that the request does not cause. Their types tell a client what to do: each is a status of msg/Status.msg.

/// A queue is full; the caller should ask again later.
class Busy : public Error
{
 public:
  using Error::Error;
};

/// The service ends.
class ShuttingDown : public Error
{
 public:
  using Error::Error;
  ShuttingDown() : Error("shutting down: the request was not answered") {}
};

/// The service does not have the scene with the requested revision.
class UnknownRevision : public Error
{
 public:
  using Error::Error;
};

/// The service cannot answer any request of this kind now.
class Unavailable : public Error
{
 public:
  using Error::Error;
};
}  // namespace gpu_planning_scene::core
