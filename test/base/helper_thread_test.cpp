// Threads beside the calling thread: where they start, where they may run, and when they end.

#include <atomic>
#include <list>
#include <optional>

#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include "base/available_cores.h"
#include "base/helper_thread.h"

namespace gpu_planning_scene::core
{
namespace
{
cpu_set_t coresOfThisThread()
{
  cpu_set_t cores;
  CPU_ZERO(&cores);
  EXPECT_EQ(0, sched_getaffinity(0, sizeof(cores), &cores));
  return cores;
}

TEST(HelperThread, StartsOnAnotherCoreThanItsCreatorAfterARest)
{
  if (availableCores() < 2)
    GTEST_SKIP() << "needs two cores";
  int starts = 0;
  int starts_on_another_core = 0;
  for (int i = 0; i < 40; ++i)
  {
    usleep(20'000);
    std::atomic<int> core{-1};
    const int before = sched_getcpu();
    std::optional<HelperThread> helper(std::in_place, [&core] { core = sched_getcpu(); });
    const int after = sched_getcpu();
    helper.reset();
    if (before != after)  // the system has moved this thread
      continue;
    ++starts;
    starts_on_another_core += core != before ? 1 : 0;
  }
  EXPECT_GT(starts, 0);
  // Not all: the system may move a thread before its first instruction.
  EXPECT_GE(starts_on_another_core, starts * 9 / 10) << "of " << starts;
}

TEST(HelperThread, MayRunOnAllCoresOfItsCreator)
{
  const cpu_set_t own = coresOfThisThread();
  cpu_set_t of_helper;
  {
    const HelperThread helper([&of_helper] { of_helper = coresOfThisThread(); });
  }
  EXPECT_TRUE(CPU_EQUAL(&own, &of_helper));
}

TEST(HelperThread, StaysOnTheOnlyCoreOfItsCreator)
{
  const cpu_set_t own = coresOfThisThread();
  cpu_set_t one;
  CPU_ZERO(&one);
  for (int core = 0; CPU_COUNT(&one) == 0; ++core)
    if (CPU_ISSET(core, &own))
      CPU_SET(core, &one);
  ASSERT_EQ(0, sched_setaffinity(0, sizeof(one), &one));
  cpu_set_t of_helper;
  {
    const HelperThread helper([&of_helper] { of_helper = coresOfThisThread(); });
  }
  EXPECT_EQ(0, sched_setaffinity(0, sizeof(own), &own));
  EXPECT_TRUE(CPU_EQUAL(&one, &of_helper));
}

TEST(HelperThread, HasDoneItsWorkAfterItsDestructor)
{
  std::atomic<int> done{0};
  {
    std::list<HelperThread> helpers;
    for (int i = 0; i < 8; ++i)
      helpers.emplace_back(
          [&done]
          {
            usleep(5'000);
            ++done;
          });
  }
  EXPECT_EQ(8, done);
}
}  // namespace
}  // namespace gpu_planning_scene::core
