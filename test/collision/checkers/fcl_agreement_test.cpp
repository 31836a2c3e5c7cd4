// The comparison with FCL must detect errors and accept only the differences that its rules allow.

#include "support/fcl_agreement.h"

#include <gtest/gtest.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

const Vector3d kCubeSize(0.2, 0.2, 0.2);

/// A cube on a slide along x, on a base without shapes.
std::shared_ptr<PlanningScene> cubeOnASlide()
{
  return std::make_shared<PlanningScene>(robotOf(
      "<link name='base'/><link name='cube'><collision><geometry><box size='0.2 0.2 0.2'/></geometry></collision>"
      "</link>" +
      jointXml("slide", "prismatic", "base", "cube",
               "<axis xyz='1 0 0'/><limit lower='-5' upper='5' effort='1' velocity='1'/>")));
}

WorldObject objectAt(double x, const Shape& shape)
{
  WorldObject object;
  object.id = "object";
  object.pose.translation().x() = x;
  object.shapes = {{shape}};
  return object;
}

BatchResult answer(bool free)
{
  BatchResult result;
  result.valid = {static_cast<std::uint8_t>(free ? 1 : 0)};
  result.colliding = {free ? BodyPair{-1, -1} : BodyPair{1, 2}};
  return result;
}

/// The comparison of an answer for the cube at 0 and the object at `x`.
FclAgreement compared(double x, const Shape& shape, bool free)
{
  const auto scene = cubeOnASlide();
  scene->objects = {objectAt(x, shape)};
  return compareWithFcl(*scene, {0.0}, answer(free));
}

TEST(FclAgreement, AgreesWithRightAnswers)
{
  for (const Shape& shape :
       {Shape(Box{kCubeSize}), Shape(Sphere{0.1}), Shape(Cylinder{0.1, 0.2}), Shape(tessellate(Sphere{0.1}).mesh)})
  {
    EXPECT_EQ(1u, compared(0.15, shape, false).agreed) << shape.index();
    EXPECT_EQ(1u, compared(0.25, shape, true).agreed) << shape.index();
  }
}

TEST(FclAgreement, ReportsWrongAnswers)
{
  for (const Shape& shape :
       {Shape(Box{kCubeSize}), Shape(Sphere{0.1}), Shape(Cylinder{0.1, 0.2}), Shape(tessellate(Sphere{0.1}).mesh)})
  {
    EXPECT_EQ(1u, compared(0.15, shape, true).failures.size()) << shape.index();
    EXPECT_EQ(1u, compared(0.25, shape, false).failures.size()) << shape.index();
    EXPECT_EQ(1u, compared(0.2 - 1e-4, shape, true).failures.size()) << shape.index();
    EXPECT_EQ(1u, compared(0.2 + 1e-4, shape, false).failures.size()) << shape.index();
  }
}

TEST(FclAgreement, ExcusesEitherAnswerWithinAMicrometreOfTouching)
{
  EXPECT_EQ(1u, compared(0.2 - 5e-7, Box{kCubeSize}, true).barely_touching);
  EXPECT_EQ(1u, compared(0.2 + 5e-7, Box{kCubeSize}, false).within_micrometre);
}

TEST(FclAgreement, ExcusesAHitByContainmentThatFclCannotSee)
{
  EXPECT_EQ(1u, compared(0.01, Box{0.5 * kCubeSize}, false).contained);
  EXPECT_EQ(1u, compared(0.01, tessellate(Sphere{0.05}).mesh, false).contained);
  EXPECT_EQ(1u, compared(0.01, tessellate(Sphere{0.5}).mesh, false).contained);
}

TEST(FclAgreement, ReportsAPairThatDoesNotCollideThoughTheStateDoes)
{
  const auto scene = cubeOnASlide();
  scene->objects = {objectAt(3.0, Box{kCubeSize}), objectAt(0.1, Box{kCubeSize})};
  scene->objects[1].id = "other";
  EXPECT_EQ(1u, compareWithFcl(*scene, {0.0}, answer(false)).failures.size());
}
}  // namespace
}  // namespace gpu_planning_scene::core
