// The markers of an animated path.

#include <set>

#include <gtest/gtest.h>

#include "node/markers/animated_bodies.h"
#include "node/messages/object_from_message.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

/// The slider robot beside a wall; its cart carries a triangle, 0.3 m from the cart's centre along x.
PlanningScene sceneWithTriangle()
{
  PlanningScene scene = sliderAndWall();
  auto mesh = std::make_shared<Mesh>();
  mesh->vertices = {{0.3, 0.0, 0.0}, {0.5, 0.0, 0.0}, {0.3, 0.1, 0.2}};
  mesh->triangles.push_back({0, 1, 2});
  WorldObject object;
  object.id = "triangle";
  object.shapes.push_back({std::shared_ptr<const Mesh>(mesh), Eigen::Isometry3d::Identity()});
  scene.objects.push_back(object);
  scene.attach("triangle", "cart", {}, scene.robot->defaultState().data());
  return scene;
}

std::vector<double> cartAt(const PlanningScene& scene, double x)
{
  std::vector<double> state = scene.robot->defaultState();
  state[static_cast<std::size_t>(scene.robot->variableIndex("slide"))] = x;
  return state;
}

MarkerArray animated(const PlanningScene& scene, double x, std::size_t max_triangles)
{
  AnimatedBodies bodies(scene, scene.robot->group("drive"), {cartAt(scene, -1.0), cartAt(scene, 1.0)}, max_triangles);
  return bodies.at(cartAt(scene, x));
}

/// The first point of the marker, or the centre of a marker without points, in the planning frame.
Eigen::Vector3d firstPoint(const Marker& marker)
{
  const Eigen::Isometry3d pose = isometryOf(marker.pose);
  if (marker.points.empty())
    return pose.translation();
  return pose * Eigen::Vector3d(marker.points[0].x, marker.points[0].y, marker.points[0].z);
}

TEST(AnimatedBodies, BodiesThatThePathMovesAreInTheGivenState)
{
  const PlanningScene scene = sceneWithTriangle();
  const std::vector<Marker> markers = animated(scene, 0.7, 100).markers;
  ASSERT_EQ(3u, markers.size()) << "cart, pole and triangle";
  EXPECT_NEAR(0.7, firstPoint(markers[0]).x(), 1e-9);
  EXPECT_NEAR(0.7, firstPoint(markers[1]).x(), 1e-9);
  EXPECT_NEAR(0.5, firstPoint(markers[1]).z() - firstPoint(markers[0]).z(), 1e-9);
  ASSERT_EQ(Marker::TRIANGLE_LIST, markers[2].type);
  EXPECT_NEAR(1.0, firstPoint(markers[2]).x(), 1e-9);
  std::set<int> ids;
  for (const Marker& marker : markers)
  {
    EXPECT_TRUE(ids.insert(marker.id).second);
    EXPECT_EQ(Marker::ADD, marker.action);
    EXPECT_EQ(scene.robot->planningFrame(), marker.header.frame_id);
    EXPECT_LT(marker.color.a, 1.0F) << "translucent";
  }
}

TEST(AnimatedBodies, OnlyPosesChangeBetweenStates)
{
  const PlanningScene scene = sceneWithTriangle();
  AnimatedBodies bodies(scene, scene.robot->group("drive"), {cartAt(scene, -1.0), cartAt(scene, 1.0)}, 100);
  MarkerArray before = bodies.at(cartAt(scene, -1.0));
  const MarkerArray after = bodies.at(cartAt(scene, 1.0));
  ASSERT_EQ(before.markers.size(), after.markers.size());
  for (std::size_t i = 0; i < before.markers.size(); ++i)
  {
    EXPECT_NE(before.markers[i], after.markers[i]);
    before.markers[i].pose = after.markers[i].pose;
    EXPECT_EQ(before.markers[i], after.markers[i]);
  }
}

TEST(AnimatedBodies, MeshesWithTooManyTrianglesAreBoxes)
{
  const std::vector<Marker> markers = animated(sceneWithTriangle(), 0.7, 0).markers;
  ASSERT_EQ(3u, markers.size());
  ASSERT_EQ(Marker::CUBE, markers[2].type);
  EXPECT_NEAR(1.1, firstPoint(markers[2]).x(), 1e-9) << "the centre of the box";
}

TEST(AnimatedBodies, BodiesThatThePathDoesNotMoveAreNotDrawn)
{
  const PlanningScene scene = sceneWithTriangle();
  std::vector<double> turned = cartAt(scene, 0.0);
  turned[static_cast<std::size_t>(scene.robot->variableIndex("turn"))] = 1.0;
  AnimatedBodies bodies(scene, scene.robot->group("drive"), {cartAt(scene, 0.0), turned}, 100);
  EXPECT_EQ(1u, bodies.at(turned).markers.size()) << "the pole";
  AnimatedBodies still(scene, scene.robot->group("drive"), {turned}, 100);
  EXPECT_TRUE(still.at(turned).markers.empty());
}
}  // namespace
}  // namespace gpu_planning_scene::core
