// The image-space methods agree with the oracle in easy cases of their domain, and fail where their papers say.

#include <random>

#include <gtest/gtest.h>

#include "gpu_planning_scene/device.h"
#include "gpu_planning_scene/error.h"
#include "literature/image_space/cullide.h"
#include "literature/image_space/failure_cases.h"
#include "literature/method.h"
#include "literature/solids.h"
#include "oracle/oracle.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;
using MeshPtr = std::shared_ptr<const Mesh>;

constexpr double kSize = 1.0;  // metres: all shapes

/// A pair of shapes for which the distance changes by as much as b moves along `direction`.
struct Pair
{
  MeshPtr a;
  MeshPtr b;
  Isometry3d touching;  ///< the pose of b in a's frame
  Vector3d direction;   ///< away from a
};

Isometry3d moved(const Pair& pair, double distance)
{
  Isometry3d pose = pair.touching;
  pose.pretranslate(distance * pair.direction);
  return pose;
}

/// Moves b along `direction` until the shapes touch, with the distances of the oracle.
Pair touching(const MeshPtr& a, const MeshPtr& b, const Isometry3d& start, const Vector3d& direction)
{
  const oracle::PreparedShape prepared_a{Shape(a)};
  const oracle::PreparedShape prepared_b{Shape(b)};
  double near = 0.0;
  double far = 4.0 * kSize;
  while (far - near > 1e-6)
  {
    const double middle = 0.5 * (near + far);
    Isometry3d pose = start;
    pose.pretranslate(middle * direction);
    const bool collides = oracle::verdict(prepared_a, oracle::Motion(), prepared_b, oracle::Motion(pose), 0.0) ==
                          oracle::Verdict::Collides;
    (collides ? near : far) = middle;
  }
  Isometry3d pose = start;
  pose.pretranslate(far * direction);
  return {a, b, pose, direction};
}

MeshPtr turned(const MeshPtr& mesh, const Eigen::Quaterniond& turn)
{
  auto copy = std::make_shared<Mesh>(*mesh);
  for (Vector3d& vertex : copy->vertices)
    vertex = turn * vertex;
  return copy;
}

Eigen::Quaterniond randomTurn(std::mt19937& generator)
{
  std::normal_distribution<double> normal;
  const double w = normal(generator);
  const double x = normal(generator);
  const double y = normal(generator);
  return Eigen::Quaterniond(w, x, y, normal(generator)).normalized();
}

/// Two spheres and two boxes, with random rotations and directions. No face of a box is parallel to a view.
std::vector<Pair> convexPairs()
{
  std::mt19937 generator(1);
  std::vector<Pair> pairs;
  for (int i = 0; i < 6; ++i)
  {
    const Isometry3d start(randomTurn(generator));
    const Vector3d direction = randomTurn(generator) * Vector3d::UnitX();
    if (i % 2 == 0)
      pairs.push_back(touching(sphereMesh(0.5 * kSize), sphereMesh(0.4 * kSize), start, direction));
    else
      pairs.push_back(touching(turned(boxMesh({kSize, 0.6, 0.5}), randomTurn(generator)), boxMesh({0.7, kSize, 0.4}),
                               start, direction));
  }
  return pairs;
}

const MethodInfo& named(const std::string& name)
{
  static const std::vector<MethodInfo> methods = imageSpaceMethods();
  for (const MethodInfo& method : methods)
    if (method.name == name)
      return method;
  throw std::logic_error("there is no method " + name);
}

std::vector<std::uint8_t> answers(const std::string& method, const MeshPtr& a, const MeshPtr& b,
                                  const std::vector<Isometry3d>& b_in_a)
{
  return named(method).make(a, b)->collide(b_in_a);
}

bool collides(const std::string& method, const MeshPtr& a, const MeshPtr& b, const Isometry3d& b_in_a)
{
  return answers(method, a, b, {b_in_a})[0] != 0;
}

bool hasDevice()
{
  try
  {
    return !listDevices().empty();
  }
  catch (const Error&)
  {
    return false;
  }
}

class ImageSpace : public ::testing::Test
{
 protected:
  void SetUp() override
  {
    if (!hasDevice())
      GTEST_SKIP() << "there is no EGL device";
  }
};

/// Each method at each resolution and with one and three views.
class EachImageSpaceMethod : public ImageSpace, public ::testing::WithParamInterface<std::string>
{
};

std::vector<std::string> allNames()
{
  std::vector<std::string> names;
  for (const MethodInfo& method : imageSpaceMethods())
    names.push_back(method.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, EachImageSpaceMethod, ::testing::ValuesIn(allNames()),
                         [](const auto& tested) { return tested.param; });

TEST_P(EachImageSpaceMethod, FindsATenthOfPenetrationAndLeavesATenthOfClearanceFree)
{
  for (const Pair& pair : convexPairs())
  {
    const std::vector<std::uint8_t> expected{1, 0, 0};
    EXPECT_EQ(answers(GetParam(), pair.a, pair.b,
                      {moved(pair, -0.1 * kSize), moved(pair, 0.1 * kSize), moved(pair, 5.0 * kSize)}),
              expected);
  }
}

/// One method of each kind, with few pixels.
class EachKindOfImageSpaceMethod : public ImageSpace, public ::testing::WithParamInterface<std::string>
{
};

INSTANTIATE_TEST_SUITE_P(All, EachKindOfImageSpaceMethod,
                         ::testing::Values("recode", "cinder", "cullide", "cullide_fattened"),
                         [](const auto& tested) { return tested.param; });

TEST_P(EachKindOfImageSpaceMethod, ChecksMorePosesThanAnAtlasHolds)
{
  const Pair pair = convexPairs()[1];
  std::vector<Isometry3d> poses;
  std::vector<std::uint8_t> expected;
  for (int i = 0; i < 30; ++i)
  {
    const bool hit = i % 3 == 1;
    poses.push_back(moved(pair, (hit ? -0.1 : i % 3 == 0 ? 0.05 : 5.0) * kSize));
    expected.push_back(hit ? 1 : 0);
  }
  for (const char* kind : {"_512x1", "_512x3"})
    EXPECT_EQ(answers(GetParam() + kind, pair.a, pair.b, poses), expected) << kind;
}

TEST_P(EachKindOfImageSpaceMethod, DoesNotDependOnTheUnitOrOnThePlaceOfTheFrames)
{
  const Pair pair = convexPairs()[1];
  for (const double unit : {1e-3, 1.0, 1e2})
  {
    const Vector3d shift = 1e7 * unit * Vector3d(1.0, -2.0, 3.0);
    const auto changed = [&](const MeshPtr& mesh)
    {
      auto copy = std::make_shared<Mesh>(*mesh);
      for (Vector3d& vertex : copy->vertices)
        vertex = unit * vertex + shift;
      return copy;
    };
    std::vector<Isometry3d> poses;
    for (const double distance : {-0.1, 0.1})
    {
      Isometry3d pose = moved(pair, distance * kSize);
      pose.translation() *= unit;
      poses.push_back(Eigen::Translation3d(shift) * pose * Eigen::Translation3d(-shift));
    }
    EXPECT_EQ(answers(GetParam() + "_64x1", changed(pair.a), changed(pair.b), poses), (std::vector<std::uint8_t>{1, 0}))
        << unit;
  }
}

/// A ball in a box, at a distance from all surfaces.
bool reportsContainment(const std::string& method)
{
  const Isometry3d pose(Eigen::Translation3d(0.02, -0.05, 0.03));
  const MeshPtr box = boxMesh({kSize, 0.9, 0.8});
  const MeshPtr ball = sphereMesh(0.15 * kSize);
  EXPECT_EQ(collides(method, box, ball, pose), collides(method, ball, box, pose.inverse())) << "the order counts";
  return collides(method, box, ball, pose);
}

TEST_F(ImageSpace, RecodeAndCinderFindContainment)
{
  for (const char* method : {"recode_64x1", "recode_64x3", "cinder_64x1", "cinder_64x3"})
    EXPECT_TRUE(reportsContainment(method)) << method;
}

TEST_F(ImageSpace, CullideMissesContainment)
{
  for (const char* method : {"cullide_256x1", "cullide_256x3", "cullide_fattened_256x1", "cullide_fattened_256x3"})
    EXPECT_FALSE(reportsContainment(method)) << method;
}

// The views of a method with fewer views are among those of a method with more views.
TEST_F(ImageSpace, EachFurtherViewOfCullideAddsMisses)
{
  std::mt19937 generator(5);
  const MeshPtr ball = sphereMesh(0.5 * kSize);
  std::array<int, 3> hits{};
  for (int i = 0; i < 20; ++i)
  {
    const Pair pair = touching(ball, sphereMesh(0.4 * kSize), Isometry3d(randomTurn(generator)),
                               randomTurn(generator) * Vector3d::UnitX());
    bool last = true;
    for (std::size_t views = 0; views < hits.size(); ++views)
    {
      const bool found =
          collides("cullide_64x" + std::to_string(views + 1), pair.a, pair.b, moved(pair, -2e-3 * kSize));
      EXPECT_LE(found, last) << "pair " << i << ", " << views + 1 << " views";
      last = found;
      hits[views] += found ? 1 : 0;
    }
  }
  EXPECT_GT(hits[0], 15);
  EXPECT_LT(hits[2], hits[0]);
}

double distanceOf(const FailureCase& failure)
{
  return oracle::distance(oracle::PreparedShape(Shape(failure.a)), oracle::Motion(),
                          oracle::PreparedShape(Shape(failure.b)), oracle::Motion(failure.b_in_a));
}

bool collides(const std::string& method, const FailureCase& failure)
{
  return collides(method, failure.a, failure.b, failure.b_in_a);
}

TEST_F(ImageSpace, RecodeReportsLinkedToriThatAreApartAndNoOtherMethodDoes)
{
  const FailureCase tori = linkedTori();
  ASSERT_GT(distanceOf(tori), 0.05 * kSize);
  for (const char* method : {"recode_256x1", "recode_256x3"})
    EXPECT_TRUE(collides(method, tori)) << method;
  for (const char* kind : {"cinder", "cullide", "cullide_fattened"})
    for (const char* views : {"_256x1", "_256x3"})
      EXPECT_FALSE(collides(kind + std::string(views), tori)) << kind << views;
}

TEST_F(ImageSpace, CinderMissesEdgesThatOtherEdgesHideAndFindsThemInOtherViews)
{
  const FailureCase block = blockInPlate();
  ASSERT_EQ(distanceOf(block), 0.0);
  for (const char* resolution : {"64", "128", "256", "512"})
  {
    EXPECT_FALSE(collides(std::string("cinder_") + resolution + "x1", block));
    EXPECT_TRUE(collides(std::string("cinder_") + resolution + "x3", block));
    EXPECT_TRUE(collides(std::string("recode_") + resolution + "x1", block));
  }
}

TEST_F(ImageSpace, RecodeMissesAnOverlapBelowThePixelAndFindsItWithMorePixels)
{
  int coarse = 0;
  int fine = 0;
  for (const Pair& pair : convexPairs())
  {
    coarse += collides("recode_64x1", pair.a, pair.b, moved(pair, -2e-5 * kSize)) ? 1 : 0;
    fine += collides("recode_512x1", pair.a, pair.b, moved(pair, -1e-3 * kSize)) ? 1 : 0;
  }
  EXPECT_LT(coarse, 3);
  EXPECT_EQ(fine, 6);
}

TEST_F(ImageSpace, FattenedCullideFindsOverlapsBelowThePixelThatCullideMisses)
{
  std::mt19937 generator(2);
  int plain = 0;
  for (int i = 0; i < 30; ++i)
  {
    const MeshPtr a = turned(boxMesh({kSize, 0.6, 0.5}), randomTurn(generator));
    const MeshPtr b = boxMesh({0.7, kSize, 0.4});
    const Pair pair = touching(a, b, Isometry3d(randomTurn(generator)), randomTurn(generator) * Vector3d::UnitX());
    const Isometry3d pose = moved(pair, -1e-5 * kSize);
    plain += collides("cullide_64x3", a, b, pose) ? 1 : 0;
    EXPECT_TRUE(collides("cullide_fattened_64x3", a, b, pose)) << i;
    EXPECT_FALSE(collides("cullide_fattened_64x3", a, b, moved(pair, 1e-5 * kSize))) << i;
  }
  EXPECT_LT(plain, 10);
}

/// The boxes around the triangles of the thin plate reach beyond the depths of its tile.
TEST_F(ImageSpace, FattenedCullideFindsAThinPlateDeepInABox)
{
  const MeshPtr cube = boxMesh({kSize, kSize, kSize});
  const MeshPtr plate = boxMesh({kSize, 0.4 * kSize, 0.1 * kSize});
  const Isometry3d pose = Isometry3d(Eigen::Translation3d(0.9 * kSize, 0.0, 0.4 * kSize));
  for (const char* method : {"cullide_fattened_64x1", "cullide_fattened_64x3", "cullide_fattened_128x3"})
  {
    EXPECT_TRUE(collides(method, cube, plate, pose)) << method;
    EXPECT_TRUE(collides(method, plate, cube, pose.inverse())) << method;
  }
}

/// Three tetrahedra of `size`, far apart on a diagonal.
MeshPtr tinyTetrahedra(double size)
{
  auto mesh = std::make_shared<Mesh>();
  for (const double place : {-0.5, 0.0, 0.5})
  {
    const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
    for (const Vector3d& corner : {Vector3d(1, 1, 1), Vector3d(1, -1, -1), Vector3d(-1, 1, -1), Vector3d(-1, -1, 1)})
      mesh->vertices.push_back(Vector3d::Constant(place * kSize) + 0.5 * size * corner);
    for (const auto& t : std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}})
      mesh->triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return mesh;
}

TEST_F(ImageSpace, FattenedCullideFindsTrianglesBelowThePixelThatCullideMisses)
{
  const MeshPtr mesh = tinyTetrahedra(1e-3 * kSize);  // a pixel has 0.016 of the size
  std::mt19937 generator(4);
  std::vector<Isometry3d> poses;
  for (int i = 0; i < 30; ++i)
    poses.emplace_back(Eigen::Translation3d(randomTurn(generator) * Vector3d(3e-4 * kSize, 0.0, 0.0)));
  const oracle::PreparedShape prepared{Shape(mesh)};
  for (const Isometry3d& pose : poses)
    ASSERT_EQ(oracle::distance(prepared, oracle::Motion(), prepared, oracle::Motion(pose)), 0.0);
  const auto hits = [&](const char* method)
  {
    const std::vector<std::uint8_t> found = answers(method, mesh, mesh, poses);
    return std::count(found.begin(), found.end(), 1);
  };
  EXPECT_LT(hits("cullide_64x1"), 3);
  EXPECT_EQ(hits("cullide_fattened_64x1"), 30);
  EXPECT_EQ(hits("cullide_fattened_64x3"), 30);
}

// No fragment shows a face that is parallel to the view.
TEST_F(ImageSpace, CullideMissesADeepOverlapOfABoxWithThreeViewsAlongItsAxes)
{
  Isometry3d pose(Eigen::AngleAxisd(0.7, Vector3d(1.0, 2.0, 3.0).normalized()));
  pose.pretranslate(Vector3d(0.4, 0.3, 0.2));
  const MeshPtr box = boxMesh({kSize, kSize, kSize});
  EXPECT_TRUE(collides("cullide_256x1", box, box, pose));
  EXPECT_FALSE(collides("cullide_256x3", box, box, pose));
  ImageOptions options;
  options.views = 3;
  options.view_frame = Eigen::AngleAxisd(0.5, Vector3d(3.0, 1.0, 2.0).normalized());
  EXPECT_TRUE(Cullide(box, box, options).collide({pose})[0] != 0) << "views along other directions";
  EXPECT_TRUE(collides("cullide_fattened_256x3", box, box, pose));
}
}  // namespace
}  // namespace gpu_planning_scene::core::literature
