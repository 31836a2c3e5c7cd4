#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <gpu_planning_scene/Status.h>

namespace gpu_planning_scene::core
{
/// Why a request failed: the fields `status` and `message` of its response. Without a fault, the status is OK and the
/// message is empty.
struct Fault
{
  std::uint8_t status = Status::OK;
  std::string message;

  explicit operator bool() const { return status != Status::OK; }
};

/// The fault of the exception that is being handled. The type of the exception decides the status. The message is a
/// short line and not empty.
Fault currentFault();

/// Runs `work` and returns its fault.
template <class Work>
Fault faultOf(Work work)
{
  try
  {
    work();
    return {};
  }
  catch (...)
  {
    return currentFault();
  }
}

/// Runs `work` and returns its error as a short line; empty if it throws nothing.
template <class Work>
std::string errorOf(Work work)
{
  return faultOf(work).message;
}

/// Appends a warning to the message of a response. An empty warning changes nothing.
inline void addWarning(const std::string& warning, std::string& message)
{
  if (!warning.empty())
    message += (message.empty() ? "" : "; ") + warning;
}

/// Appends all warnings to the message of a response.
inline void addWarnings(const std::vector<std::string>& warnings, std::string& message)
{
  for (const std::string& warning : warnings)
    addWarning(warning, message);
}

/// The response to a request that failed. Its other fields are empty.
template <class Response>
Response failed(const Fault& fault)
{
  Response response;
  response.success = false;
  response.status = fault.status;
  response.message = fault.message;
  return response;
}

/// Returns the response that `work` fills in. `success` is true if `work` leaves the status OK. If `work` throws,
/// returns failed().
template <class Response, class Work>
Response respond(Work work)
{
  Response response;
  if (const Fault fault = faultOf([&] { work(response); }))
    return failed<Response>(fault);
  response.success = response.status == Status::OK;
  return response;
}
}  // namespace gpu_planning_scene::core
