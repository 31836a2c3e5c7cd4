#include "node/endpoints/respond.h"

#include <exception>
#include <new>

#include "base/text/one_line.h"
#include "gpu_planning_scene/error.h"
#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
namespace
{
Fault faultWith(std::uint8_t status, const std::exception& error)
{
  const std::string line = shortLine(error.what());
  return {status, line.empty() ? "unknown error" : line};
}
}  // namespace

Fault currentFault()
{
  try
  {
    throw;
  }
  catch (const Busy& error)
  {
    return faultWith(Status::BUSY, error);
  }
  catch (const UnknownRevision& error)
  {
    return faultWith(Status::UNKNOWN_REVISION, error);
  }
  catch (const ShuttingDown& error)
  {
    return faultWith(Status::SHUTTING_DOWN, error);
  }
  catch (const Unavailable& error)
  {
    return faultWith(Status::UNAVAILABLE, error);
  }
  catch (const DeviceLost& error)
  {
    return faultWith(Status::INTERNAL_ERROR, error);
  }
  catch (const Error& error)
  {
    return faultWith(Status::INVALID_REQUEST, error);
  }
  catch (const std::bad_alloc&)
  {
    return {Status::UNAVAILABLE, "out of memory; send smaller requests"};
  }
  catch (const std::exception& error)
  {
    return faultWith(Status::INTERNAL_ERROR, error);
  }
  catch (...)
  {
    return {Status::INTERNAL_ERROR, "unknown error"};
  }
}
}  // namespace gpu_planning_scene::core
