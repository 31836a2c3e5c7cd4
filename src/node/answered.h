#pragma once

#include <exception>
#include <new>

namespace gpu_planning_scene
{
/// The response that `work` fills in, with `success`; what `work` throws becomes one without, and `message` says why.
template <class Response, class Work>
Response answered(Work work)
{
  Response failed;
  try
  {
    Response response;
    work(response);
    response.success = true;
    return response;
  }
  catch (const std::bad_alloc&)
  {
    failed.message = "out of memory; send less at once";
  }
  catch (const std::exception& error)
  {
    failed.message = error.what();
  }
  catch (...)
  {
    failed.message = "unknown error";
  }
  failed.success = false;
  return failed;
}
}  // namespace gpu_planning_scene
