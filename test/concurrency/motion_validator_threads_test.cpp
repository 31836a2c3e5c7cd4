// Several threads validate motions with one validator. A file of its own, because OMPL's planners, which other tests of
// the validator include, take long to compile with the thread sanitizer.

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "planning/point_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
TEST(MotionValidatorThreads, GetTheirVerdictsAndAreAllCounted)
{
  constexpr int kThreads = 4;
  constexpr int kMotions = 50;
  const PointRobot robot({{-0.5, -3.0, -0.3, 1.7}});
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t)
    threads.emplace_back(
        [&]
        {
          for (int i = 0; i < kMotions; ++i)
          {
            const bool free = i % 2 == 0;
            if (robot.validator().checkMotion(robot.at({-1.0, 0.0}).get(), robot.at({free ? -1.0 : 1.0, 1.0}).get()) !=
                free)
              ++wrong;
          }
        });
  for (std::thread& thread : threads)
    thread.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(robot.validator().getCheckedMotionCount(), static_cast<unsigned int>(kThreads * kMotions));
}
}  // namespace
}  // namespace gpu_planning_scene::core
