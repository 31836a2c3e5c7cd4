// The markers of a path for RViz. No ROS master is needed.

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "model/model_testing.h"
#include "node/markers/path_markers.h"
#include "render/drawing.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
using visualization_msgs::Marker;

constexpr std::size_t kManyTriangles = 1000;

/// The slider robot, whose cart carries a sheet of 100 triangles.
PlanningScene carryingScene()
{
  PlanningScene scene(sliderRobot());
  auto sheet = std::make_shared<Mesh>();
  for (int i = 0; i < 102; ++i)
    sheet->vertices.emplace_back(0.01 * i, i % 2, 0.5);
  for (std::uint32_t i = 0; i < 100; ++i)
    sheet->triangles.push_back({i, i + 1, i + 2});
  WorldObject object;
  object.id = "sheet";
  object.shapes.push_back({std::shared_ptr<const Mesh>(sheet), Eigen::Isometry3d::Identity()});
  scene.objects.push_back(object);
  scene.attach("sheet", "cart", {}, scene.robot->defaultState().data());
  return scene;
}

const Group& groupOf(const PlanningScene& scene, const std::string& name)
{
  return scene.robot->group(name);
}

/// The cart moves from x = -1 to 0 to 1 m.
std::vector<std::vector<double>> path(const PlanningScene& scene)
{
  std::vector<std::vector<double>> waypoints;
  for (const double x : {-1.0, 0.0, 1.0})
  {
    waypoints.push_back(scene.robot->defaultState());
    waypoints.back()[static_cast<std::size_t>(scene.robot->variableIndex("slide"))] = x;
  }
  return waypoints;
}

std::vector<Marker> ghostsOf(const PlanningScene& scene, const std::string& group, std::size_t max_triangles)
{
  std::vector<Marker> ghosts;
  for (const Marker& marker : pathMarkers(scene, path(scene), groupOf(scene, group), max_triangles).markers)
    if (marker.ns == "ghosts")
      ghosts.push_back(marker);
  return ghosts;
}

TEST(PathMarkers, GhostsOfTheRobotStandAlongThePath)
{
  const PlanningScene scene = carryingScene();
  const std::vector<Marker> ghosts = ghostsOf(scene, "drive", kManyTriangles);
  ASSERT_EQ(ghosts.size(), 12u) << "cart, pole and sheet, four times";
  std::set<int> ids;
  for (std::size_t i = 0; i < 4; ++i)
  {
    const Marker& cart = ghosts[3 * i];
    ASSERT_EQ(cart.type, Marker::CUBE_LIST);
    EXPECT_NEAR(cart.points.at(0).x, -1.0 + 2.0 / 3.0 * static_cast<double>(i), 0.06);
    EXPECT_EQ(cart.header.frame_id, scene.robot->planningFrame());
    for (std::size_t k = 0; k < 3; ++k)
    {
      EXPECT_TRUE(ids.insert(ghosts[3 * i + k].id).second);
      EXPECT_LT(ghosts[3 * i + k].color.a, 0.6F) << "translucent";
    }
  }
  EXPECT_DOUBLE_EQ(ghosts[0].points[0].x, -1.0);
  EXPECT_DOUBLE_EQ(ghosts[9].points[0].x, 1.0);
  EXPECT_LT(ghosts[3].color.a, ghosts[0].color.a) << "start and goal stand out";
  EXPECT_LT(ghosts[6].color.a, ghosts[9].color.a);
  EXPECT_GT(ghosts.front().color.b, ghosts.front().color.g);
  EXPECT_GT(ghosts.back().color.g, ghosts.back().color.b);
}

TEST(PathMarkers, GhostsShowOnlyWhatTheGroupMoves)
{
  EXPECT_EQ(ghostsOf(carryingScene(), "mast", kManyTriangles).size(), 4u) << "the pole, four times";
}

TEST(PathMarkers, BodiesThatStayWhereTheyAreHaveNoGhost)
{
  const PlanningScene scene = carryingScene();
  std::vector<std::vector<double>> turning(2, scene.robot->defaultState());
  turning[1][static_cast<std::size_t>(scene.robot->variableIndex("turn"))] = 1.0;
  const auto array = pathMarkers(scene, turning, groupOf(scene, "drive"), kManyTriangles);
  EXPECT_EQ(std::count_if(array.markers.begin(), array.markers.end(),
                          [](const Marker& marker) { return marker.ns == "ghosts"; }),
            4)
      << "the pole turns; the cart and its sheet stay";
}

TEST(PathMarkers, ThereAreAsManyGhostsAsTheTrianglesAllow)
{
  const PlanningScene scene = carryingScene();
  const auto sheets = [&](std::size_t max_triangles)
  {
    const auto ghosts = ghostsOf(scene, "drive", max_triangles);
    return std::count_if(ghosts.begin(), ghosts.end(),
                         [](const Marker& marker) { return marker.type == Marker::TRIANGLE_LIST; });
  };
  EXPECT_EQ(sheets(kManyTriangles), 4);
  EXPECT_EQ(sheets(399), 2);
  EXPECT_EQ(sheets(99), 0) << "drawn as boxes";
  EXPECT_EQ(ghostsOf(scene, "drive", 99).size(), 6u);
}

TEST(PathMarkers, ThereIsOneLineForEachLastLinkAndAPointForEachWaypoint)
{
  const PlanningScene scene = carryingScene();
  const auto array = pathMarkers(scene, path(scene), groupOf(scene, "drive"), kManyTriangles);
  const auto count = [&](const std::string& name)
  {
    return std::count_if(array.markers.begin(), array.markers.end(),
                         [&](const Marker& marker) { return marker.ns == name; });
  };
  EXPECT_EQ(count("path"), 2) << "pennant and nut";
  EXPECT_EQ(count("waypoints"), 1);
  EXPECT_EQ(std::find_if(array.markers.begin(), array.markers.end(),
                         [](const Marker& marker) { return marker.ns == "waypoints"; })
                ->points.size(),
            6u);
  EXPECT_EQ(array.markers[array.markers.size() - 2].text, "start");
  EXPECT_EQ(array.markers.back().text, "goal");
}

TEST(PathMarkers, FingersOfAHandShareOneLine)
{
  const std::string limits = "<limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/>";
  const PlanningScene scene(robotOf(
      boxLink("base") + boxLink("hand") + boxLink("left") + boxLink("right") +
          jointXml("wrist", "revolute", "base", "hand", limits) + jointXml("l", "prismatic", "hand", "left", limits) +
          jointXml("r", "prismatic", "hand", "right", limits),
      R"(<group name="all"><joint name="wrist"/><joint name="l"/><joint name="r"/></group>)"));
  std::vector<std::vector<double>> waypoints(2, scene.robot->defaultState());
  waypoints[1][0] = 1.0;
  const auto array = pathMarkers(scene, waypoints, groupOf(scene, "all"), kManyTriangles);
  EXPECT_EQ(std::count_if(array.markers.begin(), array.markers.end(),
                          [](const Marker& marker) { return marker.ns == "path"; }),
            1);
}

TEST(PathMarkers, LabelsAreOutsideOfTheGhosts)
{
  const PlanningScene scene = carryingScene();
  std::vector<Marker> labels;
  for (const Marker& marker : pathMarkers(scene, path(scene), groupOf(scene, "drive"), kManyTriangles).markers)
    if (marker.ns == "labels")
      labels.push_back(marker);
  ASSERT_EQ(2u, labels.size());
  EXPECT_EQ("start", labels[0].text);
  EXPECT_EQ("goal", labels[1].text);
  for (std::size_t i = 0; i < 2; ++i)
  {
    const std::vector<double> state = path(scene)[2 * i];
    const auto poses = bodyPoses(scene, state.data());
    const auto& place = labels[i].pose.position;
    const Eigen::Vector3d point(place.x, place.y, place.z);
    for (const char* name : {"cart", "pole"})
    {
      const int link = scene.robot->linkIndex(name);
      EXPECT_FALSE(bodyBounds(scene, link, poses[static_cast<std::size_t>(link)]).contains(point)) << labels[i].text;
    }
    EXPECT_GT(labels[i].scale.z, 0.02);
    EXPECT_LT((point - poses[static_cast<std::size_t>(scene.robot->linkIndex("pole"))].translation()).norm(), 3.0)
        << "near the robot";
  }
}

TEST(PathMarkers, LabelsOfAMotionThatHardlyMovesTheRobotStandApart)
{
  const PlanningScene scene = carryingScene();
  std::vector<std::vector<double>> waypoints = path(scene);
  waypoints.resize(1);
  waypoints.push_back(waypoints[0]);
  waypoints[1][static_cast<std::size_t>(scene.robot->variableIndex("slide"))] += 0.01;
  std::vector<Marker> labels;
  for (const Marker& marker : pathMarkers(scene, waypoints, groupOf(scene, "drive"), kManyTriangles).markers)
    if (marker.ns == "labels")
      labels.push_back(marker);
  ASSERT_EQ(2u, labels.size());
  EXPECT_GT(std::abs(labels[1].pose.position.z - labels[0].pose.position.z), 1.5 * labels[0].scale.z);
}

TEST(PathMarkers, AnEmptyPathOnlyDeletesTheLastOne)
{
  const PlanningScene scene = carryingScene();
  const auto array = pathMarkers(scene, {}, groupOf(scene, "drive"), kManyTriangles);
  ASSERT_EQ(array.markers.size(), 1u);
  EXPECT_EQ(array.markers[0].action, Marker::DELETEALL);
}
}  // namespace
}  // namespace gpu_planning_scene::core
