#include <limits>

#include <gtest/gtest.h>

#include "gpu_planning_scene/shapes.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string shapeError(const Shape& shape)
{
  return errorOf([&] { validateShape(shape, "object 'table'"); });
}

Mesh triangle()
{
  return {"part.stl", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
}

std::string meshError(const Mesh& mesh)
{
  return errorOf([&] { validateMesh(mesh); });
}

TEST(Shapes, DimensionsMustBeFiniteAndPositive)
{
  EXPECT_EQ(shapeError(Box{{1, 2, 3}}), "");
  EXPECT_EQ(shapeError(Cone{1, 2}), "");
  for (const double bad : {0.0, -1.0, kNan, kInfinity})
    for (const Shape& shape :
         {Shape(Box{{1, 1, bad}}), Shape(Box{{bad, 1, 1}}), Shape(Box{{1, bad, 1}}), Shape(Sphere{bad}),
          Shape(Cylinder{bad, 1}), Shape(Cylinder{1, bad}), Shape(Cone{bad, 1}), Shape(Cone{1, bad})})
      EXPECT_NE(shapeError(shape).find("object 'table'"), std::string::npos);
}

TEST(Shapes, MeshShapesMustHaveAGoodMesh)
{
  EXPECT_EQ(shapeError(std::make_shared<const Mesh>(triangle())), "");
  EXPECT_NE(shapeError(std::shared_ptr<const Mesh>()), "");
  const std::string error = shapeError(std::make_shared<const Mesh>());
  EXPECT_NE(error.find("object 'table'"), std::string::npos) << error;
}

TEST(Shapes, MeshesMustHaveTrianglesOfFiniteVertices)
{
  EXPECT_EQ(meshError(triangle()), "");

  Mesh empty = triangle();
  empty.triangles.clear();
  EXPECT_EQ(meshError(empty), "mesh 'part.stl' has no triangles");

  Mesh infinite = triangle();
  infinite.vertices[2].y() = kInfinity;
  EXPECT_EQ(meshError(infinite), "mesh 'part.stl': vertex 2 is not finite or farther than 1000 km away");

  infinite.vertices[2].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(meshError(infinite), "");
  infinite.vertices[2].y() = -1e7;
  EXPECT_NE(meshError(infinite), "");

  Mesh out_of_range = triangle();
  out_of_range.triangles.push_back({0, 1, 3});
  EXPECT_EQ(meshError(out_of_range), "mesh 'part.stl': triangle 1 names vertex 3, but there are 3 vertices");
}

TEST(Shapes, DegenerateTrianglesAreAccepted)
{
  Mesh mesh = triangle();
  mesh.triangles.push_back({1, 1, 1});
  mesh.triangles.push_back({0, 1, 2});
  EXPECT_EQ(meshError(mesh), "");
}
}  // namespace
}  // namespace gpu_planning_scene::core
