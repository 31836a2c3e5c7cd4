// A thread gets the parts of another thread in order, and learns when the last one has come.

#include <thread>

#include <gtest/gtest.h>

#include "collision/gpu/part_queue.h"

namespace gpu_planning_scene::core
{
namespace
{
TEST(PartQueue, HandsAllPartsOverInOrderAndThenEnds)
{
  constexpr std::size_t kParts = 10'000;
  PartQueue queue;
  std::vector<std::size_t> verdicts(kParts, 0);
  std::thread producer(
      [&]
      {
        for (std::size_t i = 0; i < kParts; ++i)
        {
          verdicts[i] = i + 1;  // read by the other thread without a lock of its own
          queue.add({i, 1});
        }
        queue.end();
      });
  std::size_t taken = 0;
  while (const std::optional<StateRange> part = queue.next())
  {
    EXPECT_EQ(part->begin, taken);
    EXPECT_EQ(verdicts[part->begin], taken + 1);
    ++taken;
  }
  producer.join();
  EXPECT_EQ(taken, kParts);
  EXPECT_FALSE(queue.next());
}
}  // namespace
}  // namespace gpu_planning_scene::core
