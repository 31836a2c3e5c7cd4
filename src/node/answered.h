#pragma once

#include <exception>
#include <new>
#include <string>

#include "model/one_line.h"

namespace gpu_planning_scene::core
{
/// What `work` throws, as a short line; empty if it throws nothing.
template <class Work>
std::string faultOf(Work work)
{
  try
  {
    work();
    return "";
  }
  catch (const std::bad_alloc&)
  {
    return "out of memory; send less at once";
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

/// The response that `work` fills in, with `success`; what `work` throws becomes one without, and `message` says why.
template <class Response, class Work>
Response answered(Work work)
{
  Response response;
  const std::string fault = faultOf([&] { work(response); });
  if (fault.empty())
  {
    response.success = true;
    return response;
  }
  Response failed;
  failed.success = false;
  failed.message = fault;
  return failed;
}
}  // namespace gpu_planning_scene::core
