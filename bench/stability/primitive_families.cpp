// Boxes, spheres, cylinders, cones and half-spaces, against each other and against meshes; required distances.

#include "stability/case.h"
#include "stability/placing.h"
#include "stability/shapes.h"

namespace gpu_planning_scene::core::stability
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

using MakeShape = Shape (*)(Random&);

// There are few sizes, so cases share trees.
double someSize(Random& random)
{
  constexpr double kSizes[] = {0.25, 0.4, 0.7};
  return kSizes[random.below(3)];
}

Shape someBox(Random& random)
{
  const double x = someSize(random);
  const double y = someSize(random);
  return Box{{x, y, someSize(random)}};
}

Shape someSphere(Random& random)
{
  return Sphere{0.5 * someSize(random)};
}

Shape someCylinder(Random& random)
{
  const double radius = 0.5 * someSize(random);
  return Cylinder{radius, someSize(random)};
}

Shape someCone(Random& random)
{
  const double radius = 0.5 * someSize(random);
  return Cone{radius, someSize(random)};
}

Shape someCurved(Random& random)
{
  constexpr MakeShape kCurved[] = {someSphere, someCylinder, someCone};
  return kCurved[random.below(3)](random);
}

Shape someMesh(Random& random)
{
  switch (random.below(4))
  {
    case 0:
      return randomTriangle(random);
    case 1:
      return sliver(random, random.logUniform(1e-7, 1e-3));
    case 2:
      return boxMesh({0.4, 0.3, 0.5});
    default:
      return bumpyBall(random, 3);
  }
}

Shape someConvex(Random& random)
{
  return random.coin() ? someBox(random) : someCurved(random);
}

Shape someShape(Random& random)
{
  return random.coin() ? someConvex(random) : someMesh(random);
}

/// One of three rotations aligns faces, rims and axes. The others are random.
Isometry3d someRotation(Random& random)
{
  constexpr double kPi = 3.14159265358979323846;
  if (random.below(3) != 0)
    return Isometry3d(random.rotation());
  return Isometry3d(Eigen::AngleAxisd(0.5 * kPi * random.below(4), Vector3d::Unit(random.below(3))));
}

Isometry3d nearPlace(Random& random, const Shape& a, const Shape& b, double offset)
{
  Isometry3d start = someRotation(random);
  const Vector3d point_a = innerPoint(random, a);
  start.translation() = point_a - start.linear() * innerPoint(random, b);
  const Vector3d direction = random.below(3) == 0 ? Vector3d::Unit(random.below(3)).eval() : random.direction();
  return poseNearContact(a, b, start, direction, offset);
}

std::function<Case(std::uint64_t, std::size_t)> contacts(MakeShape make_a, MakeShape make_b)
{
  return [=](std::uint64_t seed, std::size_t index)
  {
    Random random(seed, index);
    const Shape a = make_a(random);
    const Shape b = make_b(random);
    // In one of eight cases, the shapes overlap deeply or one is inside the other.
    if (random.below(8) == 0)
    {
      Isometry3d pose = someRotation(random);
      pose.translation() = random.inCube(0.2);
      return placed(random, a, b, pose);
    }
    return placed(random, a, b, nearPlace(random, a, b, random.offset()));
  };
}

/// A small closed mesh or triangle in a primitive, or a small primitive in a closed mesh.
Case containedInPrimitive(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const double size = random.logUniform(1e-3, 0.1);
  Isometry3d pose(random.rotation());
  pose.translation() = random.inCube(random.coin() ? 0.1 : 0.3);
  const Shape outer = random.coin() ? someBox(random) : someCurved(random);
  const MeshPtr inner =
      random.coin() ? scaled(*randomTetrahedron(random), size) : scaled(*randomTriangle(random), size);
  return placed(random, outer, inner, pose);
}

Case primitiveContained(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  constexpr double kSizes[] = {1e-3, 1e-2, 0.1};
  const double size = kSizes[random.below(3)];
  const Shape inner[] = {Box{Vector3d::Constant(size)}, Sphere{0.5 * size}, Cylinder{0.5 * size, size},
                         Cone{0.5 * size, size}};
  MeshPtr outer = random.coin() ? boxMesh(Vector3d::Ones()) : bumpyBall(random, 4);
  const int kind = random.below(4);
  if (kind == 0)
    outer = without(*outer, random.below(100));
  else if (kind == 1)
    outer = joined(*outer, *inverted(*scaled(*outer, 0.7)));
  Isometry3d pose(random.rotation());
  pose.translation() = random.inCube(random.coin() ? 0.2 : 0.5);
  return placed(random, outer, inner[random.below(4)], pose);
}

/// One of the two shapes is a primitive.
Case anyContact(Random& random, const Place& place)
{
  const Shape a = someConvex(random);
  const Shape b = someShape(random);
  return placed(random, a, b, nearPlace(random, a, b, random.offset()), place);
}

const Vector3d kFarAway(-5e4, 6e4, 6e4);

Case thinShapes(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  constexpr double kThin[] = {1e-2, 1e-3, 1e-4};
  const double thin = kThin[random.below(3)];
  const Shape shapes[] = {Cylinder{thin, 1.0}, Cylinder{0.5, thin},   Cone{thin, 1.0},
                          Cone{0.5, thin},     Box{{1.0, 1.0, thin}}, Box{{1.0, thin, thin}}};
  const Shape a = shapes[random.below(6)];
  const Shape b = random.coin() ? shapes[random.below(6)] : someShape(random);
  return placed(random, a, b, nearPlace(random, a, b, random.offset()));
}

Shape scaledShape(Random& random, double scale)
{
  const double radius = 0.5 * someSize(random) * scale;
  const double length = someSize(random) * scale;
  switch (random.below(5))
  {
    case 0:
      return Box{{length, radius, 0.5 * scale}};
    case 1:
      return Sphere{radius};
    case 2:
      return Cylinder{radius, length};
    case 3:
      return Cone{radius, length};
    default:
      return scaled(*randomTetrahedron(random), scale);
  }
}

Case scaledSizes(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  constexpr double kScales[] = {1e-3, 1e-2, 10.0};
  const double scale = kScales[random.below(3)];
  const Shape a = scaledShape(random, scale);
  const Shape b = scaledShape(random, scale);
  return placed(random, a, b, nearPlace(random, a, b, random.offset()));
}

Case onHalfSpace(Random& random, double offset)
{
  const Shape ground = HalfSpace{Vector3d::UnitZ(), 0.0};
  const Shape body = someShape(random);
  const Isometry3d start = someRotation(random);
  const Vector3d upwards = Vector3d(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 1.0).normalized();
  // The start is well below the ground, so the motion upwards passes through a contact.
  return placed(
      random, ground, body,
      poseNearContact(ground, body, Isometry3d(Eigen::Translation3d(0.0, 0.0, -2.0)) * start, upwards, offset));
}

Case halfSpaces(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  return onHalfSpace(random, random.offset());
}

double someGap(Random& random)
{
  return random.logUniform(1e-4, 0.3);
}

Case paddedMeshes(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const Shape a = someMesh(random);
  const Shape b = someMesh(random);
  return withPadding(random, placed(random, a, b, nearPlace(random, a, b, someGap(random))));
}

Case paddedPrimitives(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const Shape a = someConvex(random);
  const Shape b = someShape(random);
  return withPadding(random, placed(random, a, b, nearPlace(random, a, b, someGap(random))));
}

Case paddedHalfSpaces(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  return withPadding(random, onHalfSpace(random, someGap(random)));
}
}  // namespace

std::vector<Family> primitiveFamilies()
{
  std::vector<Family> families = {
      {"box - box", contacts(someBox, someBox), true, true},
      {"sphere - box", contacts(someSphere, someBox), false, true},
      {"sphere - mesh", contacts(someSphere, someMesh), false},
      {"sphere - sphere, cylinder, cone", contacts(someSphere, someCurved), false, true},
      {"cylinder - box", contacts(someCylinder, someBox), false, true},
      {"cylinder - mesh", contacts(someCylinder, someMesh), false},
      {"cylinder - cylinder", contacts(someCylinder, someCylinder), false, true},
      {"cone - box", contacts(someCone, someBox), false, true},
      {"cone - mesh", contacts(someCone, someMesh), false},
      {"cone - cylinder", contacts(someCone, someCylinder), false, true},
      {"cone - cone", contacts(someCone, someCone), false, true},
      {"box - mesh", contacts(someBox, someMesh), true},
      {"half-space - all shapes", halfSpaces, false},
      {"mesh in or near a primitive", containedInPrimitive, false},
      {"primitive in or near a mesh", primitiveContained, false},
      {"needles and sheets", thinShapes, false},
      {"all shapes, scaled 1e-3 to 10", scaledSizes, false},
      {"all shapes, up to 1e3 m from the root",
       [](std::uint64_t seed, std::size_t index)
       {
         Random random(seed, index);
         return anyContact(random, {570.0, Vector3d::Zero()});
       },
       false},
  };
  Family far{"all shapes, 1e5 m from the origin",
             [](std::uint64_t seed, std::size_t index)
             {
               Random random(seed, index);
               return anyContact(random, {1.0, kFarAway});
             },
             false};
  far.origin = kFarAway;
  families.push_back(far);
  return families;
}

std::vector<Family> paddingFamilies()
{
  return {
      {"padded meshes", paddedMeshes, false},
      {"padded primitives", paddedPrimitives, false},
      {"padded half-spaces", paddedHalfSpaces, false},
  };
}

std::vector<Family> allFamilies()
{
  std::vector<Family> all;
  for (const auto& part : {triangleFamilies(), contactFamilies(), containmentFamilies(), primitiveFamilies(),
                           paddingFamilies(), leakyFamilies(), literatureFamilies()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}
}  // namespace gpu_planning_scene::core::stability
