// The batch size adapts to a wanted time of a batch.

#include "collision/problem/batch_size.h"

#include <gtest/gtest.h>

namespace gpu_planning_scene::core
{
namespace
{
TEST(BatchSizes, ApproachTheWantedTime)
{
  BatchSize size({0.05, 2048, 64, 65536});
  EXPECT_EQ(2048u, size.size());
  for (int i = 0; i < 10; ++i)
    size.took(size.size(), 1e-7 * static_cast<double>(size.size()));
  EXPECT_EQ(65536u, size.size()) << "0.1 us a state: the largest batch takes no 50 ms";
  size.took(65536, 1.0);
  EXPECT_NEAR(3276.0, static_cast<double>(size.size()), 1.0);
  const std::size_t before = size.size();
  size.took(0, 1e-6);
  size.took(10, 0.001);
  EXPECT_EQ(before, size.size()) << "short batches within the wanted time change nothing";
  size.took(10, 1e-6);
  EXPECT_EQ(before, size.size()) << "nor do quick ones that are not full";
  size.took(1000, 0.1);
  EXPECT_NEAR(500.0, static_cast<double>(size.size()), 1.0) << "a short batch that took too long";
  size.took(size.size(), 10.0);
  EXPECT_EQ(64u, size.size());
}

TEST(BatchSizes, BeginSmallAgainAfterARestart)
{
  BatchSize size({0.05, 2048, 64, 65536});
  for (int i = 0; i < 10; ++i)
    size.took(size.size(), 1e-6);
  EXPECT_EQ(65536u, size.size());
  size.restart();
  EXPECT_EQ(2048u, size.size());
  size.tooLarge(1000);
  size.restart();
  EXPECT_EQ(500u, size.size()) << "a list that was too short still counts";
}

TEST(BatchSizes, StaySmallForAWhileAfterOneThatDidNotFit)
{
  BatchSize size({0.05, 2048, 1, 65536});
  size.tooLarge(2048);
  EXPECT_EQ(1024u, size.size());
  for (int i = 0; i < 7; ++i)
    size.took(size.size(), 1e-6);
  EXPECT_EQ(1024u, size.size());
  for (int i = 0; i < 8; ++i)
    size.took(size.size(), 1e-6);
  EXPECT_EQ(2048u, size.size());
  size.tooLarge(1);
  EXPECT_EQ(1u, size.size());
}
}  // namespace
}  // namespace gpu_planning_scene::core
