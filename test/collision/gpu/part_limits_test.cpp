// The largest number of states of a batch that go to a device at once, and the batch size for a wanted time.

#include "collision/gpu/part_limits.h"

#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

#include "collision/batch_size.h"

namespace gpu_planning_scene::core
{
namespace
{
TEST(PartLimits, IsSoSmallThatNoProductOfStatesWrapsInThirtyTwoBits)
{
  constexpr std::size_t kTextureBytes = std::size_t{1} << 40;
  for (const std::size_t instances : {1, 10, 1200, MAX_ROBOT_INSTANCES})
  {
    const std::size_t self_queries = instances * instances / (std::size_t{2} * QUERY_PARTNERS) + instances;
    const std::size_t states = maxStatesOfPart(kTextureBytes, instances, self_queries);
    SCOPED_TRACE(instances);
    EXPECT_GE(states, 1u);
    // A dispatch in two dimensions may have up to one row of work groups more than it needs.
    const std::uint64_t row = std::uint64_t{65535} * GROUP_SIZE;
    const std::uint64_t invocations = std::uint64_t{states} * std::max(instances, self_queries) + row;
    EXPECT_LE(invocations, std::numeric_limits<std::uint32_t>::max());
    EXPECT_LE(3 * std::uint64_t{states} * instances, std::numeric_limits<std::int32_t>::max()) << "texels of poses";
  }
}

TEST(PartLimits, LetsThePosesOfAPartFitABufferTexture)
{
  constexpr std::size_t kTexelsOfMesa = std::size_t{1} << 27;
  EXPECT_EQ(kTexelsOfMesa / 3 / 8, maxStatesOfPart(kTexelsOfMesa * 16, 8, 1));
  EXPECT_EQ(1u, maxStatesOfPart(1, MAX_ROBOT_INSTANCES, 1));
}

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
