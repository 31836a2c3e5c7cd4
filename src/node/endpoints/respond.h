#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include <gpu_planning_scene/AnswerStatus.h>
#include <gpu_planning_scene/CheckStates.h>
#include <gpu_planning_scene/GetPlanningScene.h>

namespace gpu_planning_scene::core
{
/// Why a request failed: the fields `status` and `message` of its response. Without a fault, the status is OK and the
/// message is empty.
struct Fault
{
  std::uint8_t status = AnswerStatus::OK;
  std::string message;
  std::uint64_t newest_revision = 0;  ///< of the scene, with the status UNKNOWN_REVISION

  explicit operator bool() const { return status != AnswerStatus::OK; }
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

/// The response to a request that failed. Its other fields are empty, except scene_revision if the fault has a newest
/// revision. A scene becomes an empty difference: a client that sends it back changes nothing, where a full scene would
/// remove all objects.
template <class Response>
Response failed(const Fault& fault)
{
  Response response;
  response.success = false;
  response.status = fault.status;
  response.message = fault.message;
  if constexpr (std::is_same_v<Response, CheckStates::Response>)
    response.scene_revision = fault.newest_revision;
  if constexpr (std::is_same_v<Response, GetPlanningScene::Response>)
    response.scene.is_diff = response.scene.robot_state.is_diff = true;
  return response;
}

/// Returns the response that `work` fills in. Its status is the one that `work` returns, or OK if `work` returns
/// nothing. If `work` throws, returns failed().
template <class Response, class Work>
Response respond(Work work)
{
  Response response;
  std::uint8_t status = AnswerStatus::OK;
  const Fault fault = faultOf(
      [&]
      {
        if constexpr (std::is_void_v<std::invoke_result_t<Work, Response&>>)
          work(response);
        else
          status = work(response);
      });
  if (fault)
    return failed<Response>(fault);
  response.status = status;
  response.success = status == AnswerStatus::OK;
  return response;
}
}  // namespace gpu_planning_scene::core
