#pragma once

#include <exception>
#include <new>
#include <string>
#include <vector>

#include "base/text/one_line.h"

namespace gpu_planning_scene::core
{
/// Runs `work` and returns its error as a short line; empty if it throws nothing.
template <class Work>
std::string errorOf(Work work)
{
  try
  {
    work();
    return "";
  }
  catch (const std::bad_alloc&)
  {
    return "out of memory; send smaller requests";
  }
  catch (const std::exception& error)
  {
    const std::string line = shortLine(error.what());
    return line.empty() ? "unknown error" : line;
  }
  catch (...)
  {
    return "unknown error";
  }
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

/// Returns the response that `work` fills in, with `success` set. If `work` throws, returns an empty response without
/// `success` and with the error in `message`.
template <class Response, class Work>
Response respond(Work work)
{
  Response response;
  const std::string error_text = errorOf([&] { work(response); });
  if (error_text.empty())
  {
    response.success = true;
    return response;
  }
  Response failed;
  failed.success = false;
  failed.message = error_text;
  return failed;
}
}  // namespace gpu_planning_scene::core
