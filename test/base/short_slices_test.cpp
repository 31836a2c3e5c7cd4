// Threads of devices have short time slices, and nothing else of them changes.

#include <algorithm>
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
/// The kernel's sched_attr. Of a thread with the policy SCHED_OTHER, `slice` is its field sched_runtime.
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
  syscall(SYS_sched_getattr, 0, &attributes, sizeof(attributes), 0);
  return attributes;
}

/// Calls `run` on a thread of its own.
template <class Run>
void onAThread(const Run& run)
{
  std::thread(run).join();
}

class ShortSlices : public testing::Test
{
 protected:
  void SetUp() override
  {
    SliceAttributes own = ofThisThread();
    if (own.policy != SCHED_OTHER || own.slice == 0 || own.nice < 0)
      GTEST_SKIP() << "needs Linux 6.12, its usual policy and a nice value of at least 0";
    if (syscall(SYS_sched_setattr, 0, &own, 0) != 0)
      GTEST_SKIP() << "needs a system that lets threads change their slices";
  }
};

TEST_F(ShortSlices, AreThoseOfTheCallingThreadAndNotOfItsChildren)
{
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

TEST_F(ShortSlices, KeepTheNiceValueOfTheThreadAndOfItsChildren)
{
  onAThread(
      []
      {
        // On Linux, the nice value is that of the thread.
        const int nice = std::min(19, getpriority(PRIO_PROCESS, 0) + 1);
        ASSERT_EQ(0, setpriority(PRIO_PROCESS, 0, nice));
        runInShortSlices();
        EXPECT_EQ(ofThisThread().slice, 100'000U);
        EXPECT_EQ(getpriority(PRIO_PROCESS, 0), nice);
        onAThread([nice] { EXPECT_EQ(getpriority(PRIO_PROCESS, 0), nice); });
      });
}

TEST_F(ShortSlices, ChangeNothingForANegativeNiceValue)
{
  onAThread(
      []
      {
        if (setpriority(PRIO_PROCESS, 0, -1) != 0)
          GTEST_SKIP() << "needs the right to negative nice values";
        runInShortSlices();
        onAThread([] { EXPECT_EQ(getpriority(PRIO_PROCESS, 0), -1); });
      });
}

TEST_F(ShortSlices, LeaveAThreadWithAnotherPolicyAsItIs)
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
