// One thread at a time has the turn (also with the thread sanitizer).

#include <atomic>
#include <chrono>
#include <cstdint>
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
  EXPECT_FALSE(turn.waitFor(turn.given(), std::chrono::milliseconds(1)));
  turn.give();
  EXPECT_TRUE(turn.waitFor(turn.given(), std::chrono::milliseconds(0)));
  EXPECT_TRUE(turn.takeFor(std::chrono::milliseconds(0)));
}

TEST(Turn, ThatIsTakenAgainAtOnceEndsAWaitAllTheSame)
{
  Turn turn;
  ASSERT_TRUE(turn.takeFor(std::chrono::milliseconds(0)));
  const std::uint64_t before = turn.given();
  std::atomic<bool> has_ended{false};
  std::thread waiter([&] { has_ended = turn.waitFor(before, std::chrono::milliseconds(10'000)); });
  turn.give();
  ASSERT_TRUE(turn.takeFor(std::chrono::milliseconds(60'000)));
  waiter.join();
  EXPECT_TRUE(has_ended);
  EXPECT_FALSE(turn.waitFor(turn.given(), std::chrono::milliseconds(1)));
}
}  // namespace
}  // namespace gpu_planning_scene::core
