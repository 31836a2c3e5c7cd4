#include "node/endpoints/respond.h"

#include <exception>
#include <new>
#include <system_error>

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
    return faultWith(AnswerStatus::BUSY, error);
  }
  catch (const UnknownRevision& error)
  {
    Fault fault = faultWith(AnswerStatus::UNKNOWN_REVISION, error);
    fault.newest_revision = error.newest();
    return fault;
  }
  catch (const ShuttingDown& error)
  {
    return faultWith(AnswerStatus::SHUTTING_DOWN, error);
  }
  catch (const Cancelled&)  // only a node that ends cancels the work on a request
  {
    return faultWith(AnswerStatus::SHUTTING_DOWN, ShuttingDown());
  }
  catch (const Unavailable& error)
  {
    return faultWith(AnswerStatus::UNAVAILABLE, error);
  }
  catch (const NotKnownYet& error)
  {
    return faultWith(AnswerStatus::UNAVAILABLE, error);
  }
  catch (const OutOfMemory& error)
  {
    return faultWith(AnswerStatus::OUT_OF_MEMORY, error);
  }
  catch (const InternalError& error)
  {
    return faultWith(AnswerStatus::INTERNAL_ERROR, error);
  }
  catch (const DeviceLost& error)
  {
    return faultWith(AnswerStatus::INTERNAL_ERROR, error);
  }
  catch (const Error& error)
  {
    return faultWith(AnswerStatus::INVALID_REQUEST, error);
  }
  catch (const std::bad_alloc&)
  {
    return {AnswerStatus::OUT_OF_MEMORY, "out of memory; send a smaller request, or remove objects"};
  }
  catch (const std::system_error& error)
  {
    // The system gives no further thread now. Other system errors would come again.
    if (error.code() == std::errc::resource_unavailable_try_again)
      return {AnswerStatus::UNAVAILABLE, "the system gives the node no further thread; send the request again later"};
    return faultWith(AnswerStatus::INTERNAL_ERROR, error);
  }
  catch (const std::exception& error)
  {
    return faultWith(AnswerStatus::INTERNAL_ERROR, error);
  }
  catch (...)
  {
    return {AnswerStatus::INTERNAL_ERROR, "unknown error"};
  }
}
}  // namespace gpu_planning_scene::core
