// The largest number of states of a batch that go to a device at once.

#include "collision/gpu/part_limits.h"

#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

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
}  // namespace
}  // namespace gpu_planning_scene::core
