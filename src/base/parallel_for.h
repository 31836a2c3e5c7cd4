#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <list>

#include "base/available_cores.h"
#include "base/helper_thread.h"

namespace gpu_planning_scene::core
{
/// Calls `work(begin, end)` for chunks of [0, count) on all cores; the calling thread takes part. Each thread has its
/// own copy of `work`, so values that `work` captures by copy may serve as scratch memory. If `work` or its copy
/// throws, the remaining chunks are left out. After all threads have ended, the first exception is thrown again on the
/// calling thread. If the system cannot start more threads, the started threads do all the work.
template <class Work>
void parallelFor(std::size_t count, std::size_t per_chunk, const Work& work)
{
  const std::size_t chunks = (count + per_chunk - 1) / per_chunk;
  std::atomic<std::size_t> next{0};
  std::atomic<bool> has_failed{false};
  std::exception_ptr error;  // set by the first thread that fails, read after all threads have ended
  const auto run = [&]
  {
    try
    {
      // NOLINTNEXTLINE(performance-unnecessary-copy-initialization): `work` may write to what it has captured
      Work own = work;
      for (std::size_t chunk = next++; chunk < chunks && !has_failed; chunk = next++)
        own(chunk * per_chunk, std::min(count, (chunk + 1) * per_chunk));
    }
    catch (...)
    {
      // An exception that leaves the function of a thread would end the process.
      if (!has_failed.exchange(true))
        error = std::current_exception();
    }
  };
  std::list<HelperThread> helpers;
  try
  {
    for (std::size_t i = 1; i < std::min(availableCores(), chunks); ++i)
      helpers.emplace_back(run);
  }
  catch (const std::exception&)
  {
    // No thread, or no memory for one. The started threads do all the work.
  }
  run();
  helpers.clear();
  if (error)
    std::rethrow_exception(error);
}
}  // namespace gpu_planning_scene::core
