#include "collision/collision_problem.h"

#include <algorithm>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "gpu_planning_scene/error.h"
#include "model/model_testing.h"
#include "support/obstacles.h"

namespace gpu_planning_scene
{
namespace
{
using NamePair = std::pair<std::string, std::string>;

/// base (box) -shoulder-> upper (two equal boxes) -elbow-> fore (sphere) -wrist-> tip (no shapes)
///  \-neck-> head (the sphere of fore)
std::shared_ptr<const RobotModel> robot(const std::string& srdf)
{
  const std::string sphere = "<collision><geometry><sphere radius='0.1'/></geometry></collision>";
  const std::string box =
      "<collision><origin xyz='0 0 0.3'/><geometry><box size='0.1 0.2 0.3'/></geometry></collision>";
  return robotOf(
      "<link name='base'><collision><geometry><box size='1 1 1'/></geometry></collision></link>"
      "<link name='upper'>" +
          box + box +
          "</link>"
          "<link name='fore'>" +
          sphere + "</link><link name='tip'/><link name='head'>" + sphere + "</link>" +
          jointXml("shoulder", "revolute", "base", "upper", kLimits) +
          jointXml("elbow", "revolute", "upper", "fore", kLimits) +
          jointXml("wrist", "revolute", "fore", "tip", kLimits) + jointXml("neck", "revolute", "base", "head", kLimits),
      srdf);
}

std::string srdfWith(const std::string& content)
{
  return "<group name='arm'><joint name='elbow'/></group>"
         "<group name='neck'><joint name='neck'/></group>" +
         content;
}

PlanningScene sceneOf(const std::string& srdf)
{
  PlanningScene scene(robot(srdf));
  const Shape torus = torusMesh(0.3, 0.1);
  for (const char* id : {"left", "right"})
  {
    WorldObject object;
    object.id = id;
    object.pose.translation().x() = 2.0;
    object.shapes = {{torus}, {Sphere{0.1}}};
    scene.objects.push_back(object);
  }
  return scene;
}

NamePair sorted(const std::string& a, const std::string& b)
{
  return a < b ? NamePair(a, b) : NamePair(b, a);
}

/// The pairs of bodies that are checked, by name.
std::set<NamePair> checkedPairs(const PlanningScene& scene, const std::string& group = "")
{
  const CollisionProblem problem = makeProblem(scene, group, nullptr);
  std::set<NamePair> pairs;
  for (const auto& [a, b] : problem.self_pairs)
  {
    pairs.insert(sorted(scene.bodyName(problem.robot[a].body), scene.bodyName(problem.robot[b].body)));
  }
  for (std::size_t i = 0; i < problem.robot.size(); ++i)
  {
    for (std::size_t k = 0; k < problem.world.size(); ++k)
    {
      if (problem.world_pairs[i * problem.world.size() + k] != 0)
      {
        pairs.insert(sorted(scene.bodyName(problem.robot[i].body), scene.bodyName(problem.world[k].body)));
      }
    }
  }
  return pairs;
}

std::set<NamePair> worldPairs(const std::vector<std::string>& links)
{
  std::set<NamePair> pairs;
  for (const std::string& link : links)
  {
    pairs.insert(sorted(link, "left"));
    pairs.insert(sorted(link, "right"));
  }
  return pairs;
}

std::set<NamePair> united(std::set<NamePair> a, const std::set<NamePair>& b)
{
  a.insert(b.begin(), b.end());
  return a;
}

TEST(CheckedPairs, AreAllButAdjacentLinksWithoutAnSrdf)
{
  EXPECT_EQ(united({sorted("base", "fore"), sorted("upper", "head"), sorted("fore", "head")},
                   worldPairs({"base", "upper", "fore", "head"})),
            checkedPairs(sceneOf("")));
}

TEST(CheckedPairs, AreAllButTheDisabledOnesWithAnSrdf)
{
  const auto scene = sceneOf(srdfWith("<disable_collisions link1='fore' link2='base' reason='Never'/>"));
  EXPECT_EQ(united({sorted("base", "upper"), sorted("base", "head"), sorted("upper", "fore"), sorted("upper", "head"),
                    sorted("fore", "head")},
                   worldPairs({"base", "upper", "fore", "head"})),
            checkedPairs(scene));
}

TEST(CheckedPairs, LeaveOutLinksThatAreDisabledByDefaultButForEnabledPairs)
{
  const auto scene =
      sceneOf(srdfWith("<disable_default_collisions link='head'/>"
                       "<enable_collisions link1='head' link2='fore'/>"));
  EXPECT_EQ(united({sorted("base", "upper"), sorted("base", "fore"), sorted("upper", "fore"), sorted("fore", "head")},
                   worldPairs({"base", "upper", "fore"})),
            checkedPairs(scene));
}

TEST(CheckedPairs, FollowDefaultsOfTheMatrixAsMoveItDoes)
{
  AllowedCollisionMatrix matrix;
  EXPECT_FALSE(matrix.allowed("a", "b"));
  matrix.setDefault("a", true);
  EXPECT_TRUE(matrix.allowed("a", "b"));  // one default: that one
  EXPECT_TRUE(matrix.allowed("b", "a"));
  matrix.setDefault("b", false);
  EXPECT_FALSE(matrix.allowed("a", "b"));  // two: only if both allow
  matrix.setDefault("b", true);
  EXPECT_TRUE(matrix.allowed("a", "b"));
  matrix.setEntry("b", "a", false);
  EXPECT_FALSE(matrix.allowed("a", "b"));  // the entry decides
}

TEST(CheckedPairs, OfAGroupHaveALinkThatItMoves)
{
  const auto scene = sceneOf(srdfWith(""));
  EXPECT_EQ(united({sorted("base", "head"), sorted("upper", "head"), sorted("fore", "head")}, worldPairs({"head"})),
            checkedPairs(scene, "neck"));
  EXPECT_EQ(united({sorted("base", "fore"), sorted("upper", "fore"), sorted("fore", "head")}, worldPairs({"fore"})),
            checkedPairs(scene, "arm"));
}

TEST(CheckedPairs, OfAnUnknownGroupAreAnError)
{
  const auto scene = sceneOf(srdfWith(""));
  EXPECT_THROW(makeProblem(scene, "leg", nullptr), Error);
}

TEST(CollisionProblem, SharesTheTreesOfEqualShapes)
{
  const CollisionProblem problem = makeProblem(sceneOf(""), "", nullptr);
  // box of base, box of upper, sphere, torus
  EXPECT_EQ(4u, problem.trees.size());
  EXPECT_EQ(4u, problem.shapes.size());
  EXPECT_EQ(5u, problem.robot.size());
  EXPECT_EQ(4u, problem.world.size());
}

TEST(CollisionProblem, PlacesLinkShapesInTheLinkAndObjectsInThePlanningFrame)
{
  PlanningScene scene = sceneOf("");
  scene.objects[0].pose.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // x to y, y to -x
  scene.objects[0].shapes[1].pose.translation().y() = 0.5;
  const CollisionProblem problem = makeProblem(scene, "", nullptr);
  const int upper = scene.robot->linkIndex("upper");
  const auto of_upper = std::find_if(problem.robot.begin(), problem.robot.end(),
                                     [upper](const Geometry& geometry) { return geometry.body == upper; });
  ASSERT_NE(problem.robot.end(), of_upper);
  EXPECT_TRUE(of_upper->pose.translation().isApprox(Eigen::Vector3d(0, 0, 0.3)));
  EXPECT_TRUE(problem.world[1].pose.translation().isApprox(Eigen::Vector3d(1.5, 0.0, 0.0)));
}

TEST(CollisionProblem, LeavesOutBodiesThatAreInNoCheckedPair)
{
  PlanningScene scene = sceneOf("");
  for (const char* link : {"base", "upper", "fore", "head"})
  {
    scene.allowed_collisions.setEntry(link, "left", true);
  }
  const CollisionProblem problem = makeProblem(scene, "", nullptr);
  const int right = static_cast<int>(scene.robot->links().size()) + 1;
  EXPECT_EQ(2u, problem.world.size());
  EXPECT_TRUE(std::all_of(problem.world.begin(), problem.world.end(),
                          [right](const Geometry& geometry) { return geometry.body == right; }));
}

TEST(CollisionProblem, HasTheSameTreesAndGeometriesForEveryGroup)
{
  const auto scene = sceneOf(srdfWith(""));
  const CollisionProblem all = makeProblem(scene, "", nullptr);
  const CollisionProblem arm = makeProblem(scene, "arm", nullptr);
  ASSERT_EQ(all.trees.size(), arm.trees.size());
  ASSERT_EQ(all.robot.size(), arm.robot.size());
  ASSERT_EQ(all.world.size(), arm.world.size());
  for (std::size_t i = 0; i < all.trees.size(); ++i)
  {
    EXPECT_EQ(all.trees[i].mesh->triangles, arm.trees[i].mesh->triangles);
  }
  for (std::size_t i = 0; i < all.robot.size(); ++i)
  {
    EXPECT_EQ(all.robot[i].tree, arm.robot[i].tree);
    EXPECT_EQ(all.robot[i].body, arm.robot[i].body);
  }
}

TEST(SceneReport, CountsWhatIsCheckedAndWhatIsLeftOut)
{
  auto scene = sceneOf(srdfWith("<disable_collisions link1='fore' link2='base' reason='Never'/>"));
  scene.allowed_collisions.setEntry("head", "left", true);
  scene.objects.push_back({"empty", Eigen::Isometry3d::Identity(), {}});
  SceneReport report;
  makeProblem(scene, "", &report);
  EXPECT_EQ(5u, report.self_pairs);
  EXPECT_EQ(1u, report.allowed_self_pairs);
  EXPECT_EQ(7u, report.world_pairs);
  EXPECT_EQ(1u, report.allowed_world_pairs);
  EXPECT_EQ(0u, report.unmoved_pairs);
  EXPECT_EQ(1u, report.links_without_shapes);
  EXPECT_EQ(4u, report.trees);
  EXPECT_GT(report.triangles, 2u * 12u + 1024u);

  makeProblem(scene, "neck", &report);
  EXPECT_EQ(3u, report.self_pairs);
  EXPECT_EQ(1u, report.world_pairs);
  EXPECT_EQ(2u + 6u, report.unmoved_pairs);
}

TEST(CollisionProblem, RefusesObjectsThatAreNotValid)
{
  const auto error_of = [](const std::function<void(PlanningScene&)>& spoil)
  {
    PlanningScene scene = sceneOf("");
    spoil(scene);
    return errorOf([&] { makeProblem(scene, "", nullptr); });
  };
  EXPECT_EQ("", error_of([](PlanningScene&) {}));
  EXPECT_NE("", error_of([](PlanningScene& scene) { scene.objects[1].id = "left"; }));
  EXPECT_NE("", error_of([](PlanningScene& scene) { scene.objects[1].shapes.push_back({Sphere{-1.0}}); }));
  EXPECT_NE("", error_of([](PlanningScene& scene) { scene.objects[1].shapes.push_back({std::make_shared<Mesh>()}); }));
  EXPECT_NE("", error_of([](PlanningScene& scene) { scene.objects[1].pose.linear() *= 2.0; }));
  EXPECT_NE("", error_of([](PlanningScene& scene)
                         { scene.objects[1].pose.translation().x() = std::numeric_limits<double>::quiet_NaN(); }));
}
}  // namespace
}  // namespace gpu_planning_scene
