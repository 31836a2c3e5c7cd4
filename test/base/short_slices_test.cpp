// Threads of devices have short time slices, and nothing else of them changes.

#include <cerrno>
#include <cstdint>
#include <thread>

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "base/short_slices.h"

namespace gpu_planning_scene::core
{
namespace
{
/// The part of the kernel's sched_attr up to the slice, and what follows.
struct SliceAttributes
{
  std::uint32_t size, policy;
  std::uint64_t flags;
  std::int32_t nice;
  std::uint32_t priority;
  std::uint64_t slice, deadline, period;
};

SliceAttributes ofThisThread()
{
  SliceAttributes attributes{};
  EXPECT_EQ(0, syscall(SYS_sched_getattr, 0, &attributes, sizeof(attributes), 0));
  return attributes;
}

/// Calls `run` on a thread of its own.
template <class Run>
void onAThread(const Run& run)
{
  std::thread(run).join();
}

TEST(ShortSlices, AreThoseOfTheCallingThreadAndNotOfItsChildren)
{
  if (ofThisThread().slice == 0)
    GTEST_SKIP() << "needs Linux 6.12";
  const std::uint64_t usual = ofThisThread().slice;
  onAThread(
      [usual]
      {
        runInShortSlices();
        EXPECT_EQ(ofThisThread().slice, 100'000U);
        onAThread([usual] { EXPECT_EQ(ofThisThread().slice, usual); });
      });
  EXPECT_EQ(ofThisThread().slice, usual);
}

TEST(ShortSlices, KeepTheNiceValue)
{
  onAThread(
      []
      {
        // On Linux, the nice value is that of the thread.
        const int nice = getpriority(PRIO_PROCESS, 0) + 1;
        ASSERT_EQ(0, setpriority(PRIO_PROCESS, 0, nice));
        runInShortSlices();
        EXPECT_EQ(getpriority(PRIO_PROCESS, 0), nice);
      });
}

TEST(ShortSlices, LeaveAThreadWithAnotherPolicyAsItIs)
{
  onAThread(
      []
      {
        const sched_param none{};
        ASSERT_EQ(0, sched_setscheduler(0, SCHED_BATCH, &none));
        const SliceAttributes before = ofThisThread();
        runInShortSlices();
        EXPECT_EQ(ofThisThread().policy, before.policy);
        EXPECT_EQ(ofThisThread().slice, before.slice);
      });
}
}  // namespace
}  // namespace gpu_planning_scene::core
