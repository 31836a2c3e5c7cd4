// A process that hangs at its end is ended at a deadline.

#include <chrono>
#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>

#include "node/shutdown_deadline.h"

namespace gpu_planning_scene::core
{
namespace
{
TEST(ShutdownDeadlineDeathTest, EndsAProcessThatHangs)
{
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        const ShutdownDeadline deadline(0.05);
        for (;;)
          std::this_thread::sleep_for(std::chrono::hours(1));
      },
      testing::ExitedWithCode(EXIT_FAILURE), "");
}

TEST(ShutdownDeadline, LeavesAProcessAloneThatEndsInTime)
{
  {
    const ShutdownDeadline deadline(0.2);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
}
}  // namespace
}  // namespace gpu_planning_scene::core
