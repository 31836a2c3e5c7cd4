// Threads beside the calling thread: where they start, where they may run, and when they end.

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <list>

#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

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
  cpu_set_t cores;
  if (sched_getaffinity(0, sizeof(cores), &cores) != 0 || CPU_COUNT(&cores) < 2)
    GTEST_SKIP() << "needs two cores, and at most 1024";
  int starts = 0;
  int starts_on_another_core = 0;
  for (int i = 0; i < 40; ++i)
  {
    usleep(20'000);
    std::atomic<int> core{-1};
    const int before = sched_getcpu();
    const HelperThread helper([&core] { core = sched_getcpu(); });
    while (core < 0)  // a core that rests takes the threads that wait for other cores
    {
    }
    const int after = sched_getcpu();
    if (before != after)  // the system has moved this thread
      continue;
    ++starts;
    starts_on_another_core += core != before ? 1 : 0;
  }
  EXPECT_GT(starts, 0);
  // Not all: the system may move a thread before its first instruction.
  EXPECT_GT(2 * starts_on_another_core, starts) << starts_on_another_core << " of " << starts;
}

TEST(HelperThread, MayRunOnAllCoresOfItsCreator)
{
  const cpu_set_t own = coresOfThisThread();
  cpu_set_t of_helper;
  std::atomic<bool> is_created{false};
  {
    const HelperThread helper(
        [&]
        {
          while (!is_created)
          {
          }
          of_helper = coresOfThisThread();
        });
    is_created = true;
  }
  EXPECT_TRUE(CPU_EQUAL(&own, &of_helper));
}

/// From now on, `filter` decides what the system does in calls of this thread and of those that it creates. Returns
/// whether the system can do this.
template <std::size_t N>
bool filterCalls(sock_filter (&filter)[N])
{
  const sock_fprog program = {N, filter};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

/// Ends the process: with 0 if helpers do their work although the system forbids to choose cores, or cannot forbid it.
[[noreturn]] void startWhereChoosingIsForbidden()
{
  sock_filter refuse[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, __NR_sched_setaffinity, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  if (!filterCalls(refuse))
    _exit(0);
  std::atomic<int> done{0};
  for (int i = 0; i < 3; ++i)
    const HelperThread helper([&done] { ++done; });
  _exit(done == 3 ? 0 : 1);
}

TEST(HelperThread, StartsWhereTheSystemForbidsToChooseCores)
{
  EXPECT_EXIT(startWhereChoosingIsForbidden(), testing::ExitedWithCode(0), "");
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
