// Admission lets in a few requests at a time, in order. A full queue and a shutdown cause errors.

#include <atomic>
#include <future>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "service/admission.h"
#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
namespace
{
TEST(Admission, NoMoreThanAFewAreInsideAndAllGetIn)
{
  Admission admission(2, 100);
  std::atomic<int> inside{0};
  std::atomic<int> most{0};
  std::atomic<int> done{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back(
        [&]
        {
          for (int k = 0; k < 200; ++k)
          {
            const Admission::Pass pass(admission);
            const int now = ++inside;
            for (int known = most; known < now && !most.compare_exchange_weak(known, now);)
              ;
            std::this_thread::yield();
            --inside;
            ++done;
          }
        });
  for (std::thread& thread : threads)
    thread.join();
  EXPECT_EQ(1600, done);
  EXPECT_LE(most, 2);
}

TEST(Admission, RejectsAtOnceWhenFull)
{
  Admission admission(1, 0);
  {
    const Admission::Pass inside(admission);
    EXPECT_THROW(Admission::Pass late(admission), Busy);
  }
  EXPECT_NO_THROW(Admission::Pass later(admission));
}

TEST(Admission, StopRejectsQueuedRequests)
{
  Admission admission(1, 1);
  const Admission::Pass inside(admission);
  auto waiting = std::async(std::launch::async,
                            [&admission]
                            {
                              try
                              {
                                const Admission::Pass pass(admission);
                              }
                              catch (const ShuttingDown& error)
                              {
                                return std::string(error.what());
                              }
                              return std::string("let in");
                            });
  admission.stop();
  EXPECT_EQ("shutting down: the request was not answered", waiting.get());
  EXPECT_THROW(Admission::Pass late(admission), ShuttingDown);
}
}  // namespace
}  // namespace gpu_planning_scene::core
