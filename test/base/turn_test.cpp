// One thread at a time has the turn (also with the thread sanitizer).

#include <atomic>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "base/turn.h"

namespace gpu_planning_scene::core
{
namespace
{
TEST(Turn, IsTakenByOneThreadAtATime)
{
  Turn turn;
  ASSERT_TRUE(turn.takeFor(std::chrono::milliseconds(0)));
  EXPECT_FALSE(turn.takeFor(std::chrono::milliseconds(1)));
  EXPECT_FALSE(turn.waitFor(std::chrono::milliseconds(1)));
  turn.give();
  EXPECT_TRUE(turn.waitFor(std::chrono::milliseconds(0)));
  EXPECT_TRUE(turn.takeFor(std::chrono::milliseconds(0)));
}

TEST(Turn, ThatIsTakenAgainAtOnceEndsAWaitAllTheSame)
{
  int waits = 0;
  for (int i = 0; i < 10; ++i)
  {
    Turn turn;
    ASSERT_TRUE(turn.takeFor(std::chrono::milliseconds(0)));
    std::atomic<bool> begins{false};
    std::thread waiter(
        [&]
        {
          begins = true;
          waits += turn.waitFor(std::chrono::milliseconds(1000)) ? 1 : 0;
        });
    while (!begins)
      std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    turn.give();
    ASSERT_TRUE(turn.takeFor(std::chrono::milliseconds(60'000)));
    waiter.join();
  }
  // Not all: on a loaded machine, the turn may be given before the wait begins.
  EXPECT_GT(waits, 5);
}
}  // namespace
}  // namespace gpu_planning_scene::core
