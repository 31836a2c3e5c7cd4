#pragma once

#include <cstdint>
#include <string>
#include <typeinfo>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
// Errors that the request does not cause. Their types tell a client what to do: each is a status of
// msg/AnswerStatus.msg.

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
  UnknownRevision(const std::string& message, std::uint64_t newest) : Error(message), newest_(newest) {}
  /// The newest revision that the service has. If it is below the requested one, the requested one may still arrive.
  std::uint64_t newest() const { return newest_; }

 private:
  std::uint64_t newest_;
};

/// The service cannot answer any request of this kind now.
class Unavailable : public Error
{
 public:
  using Error::Error;
};

/// The service has too little memory for the request.
class OutOfMemory : public Error
{
 public:
  using Error::Error;
};

/// A fault of the service: its own scene, its parameters or its device. The request is not the cause.
class InternalError : public Error
{
 public:
  using Error::Error;
};

/// Runs `work`. A plain Error, which would blame the request, becomes an InternalError.
template <class Work>
void asFaultOfService(const Work& work)
{
  try
  {
    work();
  }
  catch (const Error& error)
  {
    if (typeid(error) != typeid(Error))
      throw;
    throw InternalError(error.what());
  }
}
}  // namespace gpu_planning_scene::core
