// The hard cases have the difficulties that their names say.

#include <gtest/gtest.h>

#include "literature/hard_meshes.h"
#include "literature/hard_pairs.h"
#include "literature/image_space/view.h"
#include "literature/pair_truth.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
using Eigen::Vector3d;

constexpr std::size_t kCount = 6;
constexpr int kMostPixels = 512;  // along a side of a view

std::vector<HardPair> pairsOf(const std::string& family)
{
  std::vector<HardPair> found;
  for (const HardPair& pair : hardPairs(kCount, 3))
    if (pair.poses.front().family == family)
      found.push_back(pair);
  EXPECT_FALSE(found.empty()) << family;
  return found;
}

Eigen::AlignedBox3d boundsOf(const Mesh& mesh, const Eigen::Isometry3d& pose)
{
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : mesh.vertices)
    box.extend(pose * vertex);
  return box;
}

ViewVolume viewOf(const HardPair& pair, const HardPose& pose)
{
  return viewVolume(boundsOf(*pair.a, Eigen::Isometry3d::Identity()), boundsOf(*pair.b, pose.b_in_a)).value();
}

/// The smallest pixel of any view, metres.
double smallestPixel(const ViewVolume& volume)
{
  return volume.common.sizes().minCoeff() / kMostPixels;
}

/// Penetrations collide, and clearances do not.
void expectContacts(const HardPair& pair)
{
  const PairTruth truth(pair.a, pair.b);
  for (const HardPose& pose : pair.poses)
    EXPECT_EQ(truth.solids(pose.b_in_a, 1e-9) == 0.0, pose.level < 0.0) << pose.family << ", " << pose.level;
}
}  // namespace

TEST(HardPairs, NeedlesCrossAndAreThinnerThanAPixelOfEachView)
{
  const HardPair pair = pairsOf("needles").front();
  expectContacts(pair);
  const double thickness = 1e-4;
  for (const auto& t : pair.a->triangles)
    for (std::size_t i = 0; i < 3; ++i)
    {
      // An edge runs along the needle or across it.
      const double length = (pair.a->vertices[t[i]] - pair.a->vertices[t[(i + 1) % 3]]).norm();
      EXPECT_TRUE(length > 0.99 || length < 2.0 * thickness) << length;
    }
  for (const HardPose& pose : pair.poses)
    if (pose.level < 1e-2)
      EXPECT_GT(smallestPixel(viewOf(pair, pose)), thickness) << pose.level;
}

TEST(HardPairs, PlatesAreSeenFromTheEdgeByTheOnlyView)
{
  const HardPair pair = pairsOf("plates from the edge").front();
  expectContacts(pair);
  for (const HardPose& pose : pair.poses)
  {
    const ViewVolume volume = viewOf(pair, pose);
    const std::vector<int> axes = viewAxes(volume, 1);
    ASSERT_EQ(axes, std::vector<int>{2}) << pose.level;
    EXPECT_GT(std::min(volume.common.sizes().x(), volume.common.sizes().y()) / kMostPixels, 1e-4);
  }
  // The faces of both plates are parallel to the view.
  EXPECT_EQ(kPlateAxis.z(), 0.0);
}

TEST(HardPairs, GrainsHaveNoEdgeOfAPixelInAnyView)
{
  const HardPair pair = pairsOf("triangles below a pixel").front();
  expectContacts(pair);
  double longest = 0.0;
  for (const MeshPtr& mesh : {pair.a, pair.b})
    for (const auto& t : mesh->triangles)
      for (std::size_t i = 0; i < 3; ++i)
        longest = std::max(longest, (mesh->vertices[t[i]] - mesh->vertices[t[(i + 1) % 3]]).norm());
  EXPECT_NEAR(longest, kGrainSize, 0.05 * kGrainSize);
  for (const HardPose& pose : pair.poses)
    EXPECT_GT(smallestPixel(viewOf(pair, pose)), 10.0 * longest);
}
}  // namespace gpu_planning_scene::core::literature
