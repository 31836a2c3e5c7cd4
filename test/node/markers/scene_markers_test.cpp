// The markers for RViz. No ROS master is needed.

#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "node/markers/scene_markers.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

/// The slider robot, a wall, a sheet of 200 triangles, a ball, a cone, a floor, and 50 equal cubes as one object.
PlanningScene fullScene()
{
  PlanningScene scene(sliderRobot());
  const auto add = [&](const std::string& id, const Shape& shape, double x)
  {
    WorldObject object;
    object.id = id;
    object.pose.translation().x() = x;
    object.shapes.push_back({shape, Eigen::Isometry3d::Identity()});
    scene.objects.push_back(object);
  };
  add("wall", Box{Eigen::Vector3d(0.2, 1.0, 0.2)}, 1.0);
  auto sheet = std::make_shared<Mesh>();
  for (int i = 0; i < 202; ++i)
    sheet->vertices.emplace_back(0.01 * i, i % 2, 0.0);
  for (std::uint32_t i = 0; i < 200; ++i)
    sheet->triangles.push_back({i, i + 1, i + 2});
  add("sheet", std::shared_ptr<const Mesh>(sheet), -3.0);
  add("ball", Sphere{0.1}, 2.0);
  add("cone", Cone{0.1, 0.3}, 2.5);
  add("floor", HalfSpace{Eigen::Vector3d::UnitZ(), -0.5}, 0.0);
  WorldObject cloud;
  cloud.id = "cloud";
  for (int i = 0; i < 50; ++i)
    cloud.shapes.push_back(
        {Box{Eigen::Vector3d::Constant(0.05)}, Eigen::Isometry3d(Eigen::Translation3d(0.05 * i, 2, 0))});
  scene.objects.push_back(cloud);
  return scene;
}

MarkerArray markers(const PlanningScene& scene, const std::vector<BodyPair>& colliding = {},
                    const std::vector<Eigen::Vector3d>& contacts = {}, const MarkerOptions& options = {})
{
  return markersOf(scene, scene.robot->defaultState().data(), colliding, contacts, options);
}

bool isRedMarker(const Marker& marker)
{
  return marker.color.r > 0.5F && marker.color.g < 0.3F && marker.color.b < 0.3F;
}

std::size_t countOf(const MarkerArray& array, const std::string& name, int type)
{
  return static_cast<std::size_t>(std::count_if(
      array.markers.begin(), array.markers.end(),
      [&](const Marker& marker) { return marker.ns == name && marker.type == type; }));
}

TEST(Markers, BodiesAreDrawnAsWhatTheyAre)
{
  const MarkerArray array = markers(fullScene());
  ASSERT_FALSE(array.markers.empty());
  EXPECT_EQ(array.markers[0].action, Marker::DELETEALL);
  EXPECT_EQ(countOf(array, "robot", Marker::CUBE_LIST), 2u) << "cart and pole";
  EXPECT_EQ(countOf(array, "objects", Marker::CUBE_LIST), 2u) << "the wall, and all cubes of the cloud in one";
  EXPECT_EQ(countOf(array, "objects", Marker::TRIANGLE_LIST), 2u) << "the sheet and the cone";
  EXPECT_EQ(countOf(array, "objects", Marker::SPHERE_LIST), 1u);
  EXPECT_EQ(countOf(array, "objects", Marker::CUBE), 1u) << "the floor";
  EXPECT_EQ(countOf(array, "attached", Marker::CUBE_LIST), 0u);
  std::set<std::pair<std::string, int>> ids;
  for (const Marker& marker : array.markers)
  {
    EXPECT_TRUE(ids.insert({marker.ns, marker.id}).second) << marker.ns << marker.id;
    EXPECT_EQ(marker.header.frame_id, sliderRobot()->planningFrame());
    if (marker.action == Marker::ADD)
    {
      EXPECT_GT(marker.scale.x * marker.scale.y * marker.scale.z, 0.0);
      EXPECT_GT(marker.color.a, 0.0F);
      EXPECT_FALSE(isRedMarker(marker));
    }
  }
}

TEST(Markers, PlacesAreThoseOfTheScene)
{
  PlanningScene scene(sliderRobot());
  WorldObject object;
  object.id = "box";
  object.pose = Eigen::Translation3d(1.0, 2.0, 3.0) * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX());
  object.shapes.push_back({Box{Eigen::Vector3d(1, 2, 3)}, Eigen::Isometry3d(Eigen::Translation3d(0.5, 0.0, 0.25))});
  scene.objects.push_back(object);
  const Marker marker = markers(scene).markers.back();
  ASSERT_EQ(marker.points.size(), 1u);
  const auto& q = marker.pose.orientation;
  const Eigen::Isometry3d pose =
      Eigen::Translation3d(marker.pose.position.x, marker.pose.position.y, marker.pose.position.z) *
      Eigen::Quaterniond(q.w, q.x, q.y, q.z);
  const auto& point = marker.points[0];
  const Eigen::Isometry3d expected = object.pose * object.shapes[0].pose;
  EXPECT_LT((pose * Eigen::Vector3d(point.x, point.y, point.z) - expected.translation()).norm(), 1e-12);
  EXPECT_LT((pose.linear() - expected.linear()).norm(), 1e-12);
  EXPECT_EQ(marker.scale.y, 2.0);
}

TEST(Markers, CollidingBodiesAreRedAndContactsShown)
{
  const PlanningScene scene = fullScene();
  const int cart = scene.robot->linkIndex("cart");
  const int ball = static_cast<int>(scene.robot->links().size()) + 2;
  const MarkerArray array = markers(scene, {{cart, ball}}, {{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}});
  EXPECT_EQ(std::count_if(array.markers.begin(), array.markers.end(), isRedMarker), 2);
  EXPECT_EQ(countOf(array, "contacts", Marker::SPHERE_LIST), 1u);
  EXPECT_EQ(array.markers.back().points.size(), 2u);
  // Links and contacts are seen inside of the objects that they hit.
  EXPECT_EQ(array.markers.back().color.a, 1.0F);
  for (const Marker& marker : array.markers)
    if (marker.action == Marker::ADD)
      EXPECT_EQ(isRedMarker(marker) && marker.ns == "objects", marker.color.a < 0.9F);
  const auto red_of = [&](const std::string& name)
  {
    for (const Marker& marker : array.markers)
      if (marker.ns == name && isRedMarker(marker))
        return marker.color.r;
    return 0.0F;
  };
  EXPECT_GT(red_of("robot"), red_of("objects") + 0.2F) << "the robot stands out";
}

TEST(Markers, TrianglesThatBoundNoSolidHaveAnotherColourUnlessTheirBodyCollides)
{
  PlanningScene scene(sliderRobotOfMeshes());
  const auto colors_of = [&](const std::vector<BodyPair>& colliding)
  {
    std::vector<std::vector<std_msgs::ColorRGBA>> colors;
    for (const Marker& marker : markers(scene, colliding).markers)
      if (marker.type == Marker::TRIANGLE_LIST)
        colors.push_back(marker.colors);
    return colors;
  };
  const int cart = scene.robot->linkIndex("cart");
  const int pole = scene.robot->linkIndex("pole");
  const auto free = colors_of({});
  ASSERT_EQ(2u, free.size());
  EXPECT_TRUE(free[0].empty()) << "the cart is closed";
  ASSERT_EQ(30u, free[1].size()) << "corners of the pole, which lacks a side";
  for (const std_msgs::ColorRGBA& color : free[1])
    EXPECT_TRUE(color.b > color.r && color.r > color.g + 0.05F) << "violet";
  EXPECT_TRUE(colors_of({{cart, pole}})[1].empty()) << "all of it is red";
  scene.robot = scene.robot->withSolids({{"pole", SolidRule::Filled}});
  EXPECT_TRUE(colors_of({})[1].empty());
}

TEST(Markers, ContactsAreSmallBesideASmallBody)
{
  PlanningScene scene = fullScene();
  const int cart = scene.robot->linkIndex("cart");
  const int ball = static_cast<int>(scene.robot->links().size()) + 2;
  const double usual = markers(scene, {{cart, ball}}, {{0.1, 0.2, 0.3}}).markers.back().scale.x;
  WorldObject finger;
  finger.id = "finger";
  finger.shapes.push_back({Sphere{0.005}, Eigen::Isometry3d::Identity()});
  scene.objects.push_back(finger);
  const int last = static_cast<int>(scene.robot->links().size() + scene.objects.size()) - 1;
  const double small = markers(scene, {{cart, last}}, {{0.1, 0.2, 0.3}}).markers.back().scale.x;
  EXPECT_LT(small, 0.8 * usual);
  EXPECT_LT(small, 0.6 * 2 * 0.005) << "the finger is visible behind it";
  scene.objects.back().shapes[0].shape = Sphere{1e-4};
  EXPECT_GT(markers(scene, {{cart, last}}, {{0.1, 0.2, 0.3}}).markers.back().scale.x, 0.2 * usual) << "visible";
}

TEST(Markers, BodiesHaveTheColoursOfTheScene)
{
  PlanningScene scene = fullScene();
  scene.colors["ball"] = Color{0.0F, 1.0F, 0.2F, 0.4F};
  for (const Marker& marker : markers(scene).markers)
  {
    const bool is_green = marker.color.g == 1.0F && marker.color.r == 0.0F;
    EXPECT_EQ(is_green, marker.type == Marker::SPHERE_LIST);
    EXPECT_TRUE(!is_green || std::abs(marker.color.a - 0.4F) < 0.01F);
  }
}

TEST(Markers, AttachedObjectsMoveWithTheirLink)
{
  PlanningScene scene = fullScene();
  std::vector<double> state = scene.robot->defaultState();
  scene.attach("ball", "cart", {}, state.data());
  const auto place = [&]
  {
    for (const Marker& marker : markersOf(scene, state.data(), {}, {}, MarkerOptions()).markers)
      if (marker.ns == "attached")
        return marker.points.at(0).x;
    return -1.0;
  };
  EXPECT_NEAR(place(), 2.0, 1e-12);
  state[static_cast<std::size_t>(scene.robot->variableIndex("slide"))] += 0.25;
  EXPECT_NEAR(place(), 2.25, 1e-12);
}

TEST(Markers, TooManyTrianglesBecomeBoxes)
{
  MarkerOptions options;
  options.max_triangles = 199;
  const MarkerArray array = markers(fullScene(), {}, {}, options);
  EXPECT_EQ(countOf(array, "objects", Marker::TRIANGLE_LIST), 1u) << "the cone alone";
  EXPECT_EQ(countOf(array, "objects", Marker::CUBE), 2u) << "the floor and the sheet's box";
}

TEST(Markers, NoMoreTrianglesAreDrawnThanTheLimitWhereMeshesAreEqual)
{
  PlanningScene scene = fullScene();
  const auto sheet = std::find_if(scene.objects.begin(), scene.objects.end(),
                                  [](const WorldObject& object) { return object.id == "sheet"; });
  ASSERT_NE(sheet, scene.objects.end());
  const WorldObject first = *sheet;
  for (int i = 0; i < 10; ++i)
  {
    scene.objects.push_back(first);
    scene.objects.back().id += std::to_string(i);
  }
  MarkerOptions options;
  options.max_triangles = 1000;
  options.tree_level = 1000;
  std::size_t points = 0;
  for (const Marker& marker : markers(scene, {}, {}, options).markers)
    points += marker.type == Marker::TRIANGLE_LIST || marker.type == Marker::LINE_LIST ? marker.points.size() : 0;
  // The boxes of the roots are always drawn.
  EXPECT_LE(points, 3 * options.max_triangles + std::size_t{24} * 80);
  EXPECT_GT(points, 2 * options.max_triangles);
}

TEST(Markers, ATreeLevelHasItsBoxes)
{
  constexpr std::size_t kPointsOfBox = 24;
  MarkerOptions options;
  options.tree_body = "sheet";
  for (const auto& [level, boxes] : std::map<int, std::size_t>{{0, 1}, {1, 2}, {2, 4}})
  {
    options.tree_level = level;
    const MarkerArray array = markers(fullScene(), {}, {}, options);
    ASSERT_EQ(countOf(array, "tree", Marker::LINE_LIST), 1u);
    EXPECT_EQ(array.markers.back().points.size(), boxes * kPointsOfBox) << level;
  }
  options.tree_level = 1000;
  EXPECT_GE(markers(fullScene(), {}, {}, options).markers.back().points.size(), 50u * kPointsOfBox) << "the leaves";
  options.tree_body = "nothing";
  EXPECT_EQ(countOf(markers(fullScene(), {}, {}, options), "tree", Marker::LINE_LIST), 0u);
  options.tree_body.clear();
  EXPECT_GT(countOf(markers(fullScene(), {}, {}, options), "tree", Marker::LINE_LIST), 5u);
}
}  // namespace
}  // namespace gpu_planning_scene::core
