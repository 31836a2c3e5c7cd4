// How many states of a batch go to a device at once.

#include "collision/part_size.h"

#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

namespace gpu_planning_scene
{
namespace
{
TEST(PartSize, IsSoSmallThatNoProductOfStatesWrapsInThirtyTwoBits)
{
  constexpr std::size_t kTextureBytes = std::size_t{1} << 40;
  for (const std::size_t instances : {1, 10, 1200, MAX_ROBOT_GEOMETRIES})
  {
    const std::size_t self_searches = instances * instances / (2 * SEARCH_PARTNERS) + instances;
    const std::size_t states = mostStatesOfPart(kTextureBytes, instances, self_searches);
    SCOPED_TRACE(instances);
    EXPECT_GE(states, 1u);
    // A dispatch in two dimensions may begin up to a row of workgroups more lanes than it needs.
    const std::uint64_t row = std::uint64_t{65535} * GROUP_SIZE;
    const std::uint64_t lanes = std::uint64_t{states} * std::max(instances, self_searches) + row;
    EXPECT_LE(lanes, std::numeric_limits<std::uint32_t>::max());
    EXPECT_LE(3 * std::uint64_t{states} * instances, std::numeric_limits<std::int32_t>::max()) << "texels of poses";
  }
}

TEST(PartSize, LetsThePosesOfAPartFitABufferTexture)
{
  constexpr std::size_t kTexelsOfMesa = std::size_t{1} << 27;
  EXPECT_EQ(kTexelsOfMesa / 3 / 8, mostStatesOfPart(kTexelsOfMesa * 16, 8, 1));
  EXPECT_EQ(1u, mostStatesOfPart(1, MAX_ROBOT_GEOMETRIES, 1));
}
}  // namespace
}  // namespace gpu_planning_scene
