#include "scene/shape_order.h"

#include <cstddef>
#include <memory>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace gpu_planning_scene::core
{
namespace
{
PlacedShape placed(const Shape& shape, double x)
{
  PlacedShape result{shape};
  result.pose.translation().x() = x;
  return result;
}

TEST(ShapeOrder, PrimitivesThenMeshesThenPlanesEachInTheirOrder)
{
  const auto mesh = std::make_shared<const Mesh>();
  const HalfSpace plane{Eigen::Vector3d::UnitZ(), 0.0};
  std::vector<PlacedShape> shapes{placed(plane, 5.0), placed(mesh, 3.0), placed(Sphere{1.0}, 1.0),
                                  placed(plane, 6.0), placed(mesh, 4.0), placed(Box{Eigen::Vector3d::Ones()}, 2.0)};
  orderShapes(shapes);
  ASSERT_EQ(6u, shapes.size());
  for (std::size_t i = 0; i < shapes.size(); ++i)
    EXPECT_EQ(static_cast<double>(i + 1), shapes[i].pose.translation().x());
  EXPECT_TRUE(std::holds_alternative<Sphere>(shapes[0].shape));
  EXPECT_TRUE(std::holds_alternative<Box>(shapes[1].shape));
  EXPECT_EQ(mesh, std::get<std::shared_ptr<const Mesh>>(shapes[2].shape));
  EXPECT_EQ(mesh, std::get<std::shared_ptr<const Mesh>>(shapes[3].shape));
  EXPECT_TRUE(std::holds_alternative<HalfSpace>(shapes[4].shape));
  EXPECT_TRUE(std::holds_alternative<HalfSpace>(shapes[5].shape));
}
}  // namespace
}  // namespace gpu_planning_scene::core
