#include "collision/problem/collision_problem.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "collision/bounds/problem_maker.h"
#include "gpu_planning_scene/error.h"
#include "model/model_testing.h"
#include "support/obstacles.h"

namespace gpu_planning_scene::core
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

/// The names of the checked pairs of bodies.
std::set<NamePair> checkedPairs(const PlanningScene& scene, const std::string& group = "")
{
  const CollisionProblem problem = makeProblem(scene, group, nullptr);
  std::set<NamePair> pairs;
  for (const auto& [a, b] : problem.self_pairs)
    pairs.insert(sorted(scene.bodyName(problem.robot[a].body), scene.bodyName(problem.robot[b].body)));
  for (std::size_t i = 0; i < problem.robot.size(); ++i)
  {
    for (std::size_t k = 0; k < problem.world.size(); ++k)
      if (problem.world_pairs[i * problem.world.size() + k] != 0)
        pairs.insert(sorted(scene.bodyName(problem.robot[i].body), scene.bodyName(problem.world[k].body)));
    for (std::size_t k = 0; k < problem.half_spaces.size(); ++k)
      if (problem.half_space_pairs[i * problem.half_spaces.size() + k] != 0)
        pairs.insert(sorted(scene.bodyName(problem.robot[i].body), scene.bodyName(problem.half_spaces[k].body)));
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
  EXPECT_TRUE(matrix.allowed("a", "b"));  // one default: it decides
  EXPECT_TRUE(matrix.allowed("b", "a"));
  matrix.setDefault("b", false);
  EXPECT_FALSE(matrix.allowed("a", "b"));  // two defaults: allowed only if both allow it
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
  EXPECT_EQ(4u, problem.tessellations.size());
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
                                     [upper](const ShapeInstance& instance) { return instance.body == upper; });
  ASSERT_NE(problem.robot.end(), of_upper);
  EXPECT_TRUE(of_upper->pose.translation().isApprox(Eigen::Vector3d(0, 0, 0.3)));
  EXPECT_TRUE(problem.world[1].pose.translation().isApprox(Eigen::Vector3d(1.5, 0.0, 0.0)));
}

TEST(CollisionProblem, LeavesOutBodiesThatAreInNoCheckedPair)
{
  PlanningScene scene = sceneOf("");
  for (const char* link : {"base", "upper", "fore", "head"})
    scene.allowed_collisions.setEntry(link, "left", true);
  const CollisionProblem problem = makeProblem(scene, "", nullptr);
  const int right = static_cast<int>(scene.robot->links().size()) + 1;
  EXPECT_EQ(2u, problem.world.size());
  EXPECT_TRUE(std::all_of(problem.world.begin(), problem.world.end(),
                          [right](const ShapeInstance& instance) { return instance.body == right; }));
}

TEST(CollisionProblem, HasTheSameTreesAndGeometriesForEveryGroup)
{
  const auto scene = sceneOf(srdfWith(""));
  const CollisionProblem all = makeProblem(scene, "", nullptr);
  const CollisionProblem arm = makeProblem(scene, "arm", nullptr);
  ASSERT_EQ(all.tessellations.size(), arm.tessellations.size());
  ASSERT_EQ(all.robot.size(), arm.robot.size());
  ASSERT_EQ(all.world.size(), arm.world.size());
  for (std::size_t i = 0; i < all.tessellations.size(); ++i)
    EXPECT_EQ(all.tessellations[i].mesh->triangles, arm.tessellations[i].mesh->triangles);
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
  EXPECT_EQ(0u, report.pairs_outside_group);
  EXPECT_EQ(1u, report.links_without_shapes);
  EXPECT_EQ(4u, report.trees);
  EXPECT_GT(report.triangles, 2u * 12u + 1024u);

  makeProblem(scene, "neck", &report);
  EXPECT_EQ(3u, report.self_pairs);
  EXPECT_EQ(1u, report.world_pairs);
  EXPECT_EQ(2u + 6u, report.pairs_outside_group);
}

/// "left" is attached to `upper` and may touch `fore`; "hook" is attached to `upper` too; "lamp" is attached to `head`.
PlanningScene carryingScene(const std::string& srdf)
{
  PlanningScene scene = sceneOf(srdf);
  scene.objects.push_back({"hook", Eigen::Isometry3d::Identity(), {{Sphere{0.1}}}});
  scene.objects.push_back({"lamp", Eigen::Isometry3d::Identity(), {{Box{{1, 2, 3}}}}});
  const std::vector<double> state = scene.robot->defaultState();
  scene.attach("left", "upper", {"fore"}, state.data());
  scene.attach("hook", "upper", {}, state.data());
  scene.attach("lamp", "head", {}, state.data());
  return scene;
}

TEST(CheckedPairs, OfCarriedObjectsAreThoseThatTheirLinkDoesNotTouch)
{
  const auto scene = carryingScene("");
  std::set<NamePair> carried = {sorted("left", "base"), sorted("left", "head"), sorted("left", "lamp"),
                                sorted("hook", "base"), sorted("hook", "head"), sorted("hook", "fore"),
                                sorted("hook", "lamp"), sorted("lamp", "base"), sorted("lamp", "upper"),
                                sorted("lamp", "fore")};
  for (const char* body : {"base", "upper", "fore", "head", "left", "hook", "lamp"})
    carried.insert(sorted(body, "right"));
  EXPECT_EQ(united({sorted("base", "fore"), sorted("upper", "head"), sorted("fore", "head")}, carried),
            checkedPairs(scene));
  SceneReport report;
  makeProblem(scene, "", &report);
  EXPECT_EQ(3u + 10u, report.self_pairs);
  EXPECT_EQ(7u, report.world_pairs);
  EXPECT_EQ(3u + 1u + 1u, report.touch_pairs);  // with their own links, with a touch link, with each other on one link
  EXPECT_EQ(0u, report.pairs_outside_group);
}

TEST(CheckedPairs, OfCarriedObjectsFollowTheMatrix)
{
  auto scene = carryingScene("");
  for (const char* body : {"base", "lamp", "right"})
    scene.allowed_collisions.setEntry("left", body, true);
  const std::set<NamePair> pairs = checkedPairs(scene);
  EXPECT_EQ(0u, pairs.count(sorted("left", "base")));
  EXPECT_EQ(0u, pairs.count(sorted("left", "lamp")));
  EXPECT_EQ(0u, pairs.count(sorted("left", "right")));
  EXPECT_EQ(1u, pairs.count(sorted("left", "head")));
  SceneReport report;
  makeProblem(scene, "", &report);
  EXPECT_EQ(3u + 2u, report.allowed_self_pairs);  // three pairs of adjacent links
  EXPECT_EQ(1u, report.allowed_world_pairs);
}

TEST(CheckedPairs, OfAGroupHaveACarriedObjectWhoseLinkItMoves)
{
  const auto scene = carryingScene(srdfWith(""));
  const std::set<NamePair> pairs = checkedPairs(scene, "neck");
  EXPECT_EQ(1u, pairs.count(sorted("lamp", "right")));
  EXPECT_EQ(1u, pairs.count(sorted("lamp", "base")));
  EXPECT_EQ(1u, pairs.count(sorted("lamp", "hook")));
  EXPECT_EQ(1u, pairs.count(sorted("hook", "head")));
  EXPECT_EQ(0u, pairs.count(sorted("hook", "base")));
  EXPECT_EQ(0u, pairs.count(sorted("hook", "right")));
}

TEST(CollisionProblem, PlacesCarriedObjectsInTheirLink)
{
  PlanningScene scene = sceneOf("");
  scene.objects[0].pose.translation().y() = 0.5;
  scene.objects[0].shapes[1].pose.translation().z() = 0.25;
  scene.objects[0].padding = 0.5;
  const int upper = scene.robot->linkIndex("upper");
  scene.link_padding.assign(scene.robot->links().size(), 0.0);
  scene.link_padding[upper] = 0.01;
  std::vector<double> state = scene.robot->defaultState();
  state[scene.robot->variableIndex("shoulder")] = 1.0;
  scene.attach("left", "upper", {}, state.data());
  std::vector<Eigen::Isometry3d> poses(scene.robot->links().size());
  scene.robot->linkPoses(state.data(), poses.data());

  const CollisionProblem problem = makeProblem(scene, "", nullptr);
  const int body = static_cast<int>(scene.robot->links().size() + scene.objects.size());
  std::vector<ShapeInstance> carried;
  std::copy_if(problem.robot.begin(), problem.robot.end(), std::back_inserter(carried),
               [body](const ShapeInstance& instance) { return instance.body == body; });
  ASSERT_EQ(2u, carried.size());
  EXPECT_EQ(upper, carried[1].link);
  EXPECT_EQ(0.01, carried[1].padding);  // of its link: the object's own padding counts only in the world
  EXPECT_TRUE((poses[upper] * carried[1].pose).translation().isApprox(Eigen::Vector3d(2.0, 0.5, 0.25), 1e-15));
  EXPECT_EQ("left", scene.bodyName(body));
}

TEST(CollisionProblem, NumbersTheRobotsTreesFirst)
{
  PlanningScene scene = carryingScene("");
  scene.objects.push_back({"ball", Eigen::Isometry3d::Identity(), {{Sphere{0.7}}}});
  const CollisionProblem problem = makeProblem(scene, "", nullptr);
  std::uint32_t robot_trees = 0;
  for (const ShapeInstance& instance : problem.robot)
    robot_trees = std::max(robot_trees, instance.tree + 1);
  std::set<std::uint32_t> used;
  for (const ShapeInstance& instance : problem.robot)
    used.insert(instance.tree);
  EXPECT_EQ(robot_trees, used.size());
  EXPECT_EQ(robot_trees, problem.world.back().tree);
}

TEST(CollisionProblem, PadsLinksAndObjects)
{
  PlanningScene scene = sceneOf("");
  scene.link_padding = {0.01, 0.02, 0.03, 0.04, 0.05};
  ASSERT_EQ(scene.link_padding.size(), scene.robot->links().size());
  scene.objects[1].padding = 0.5;
  const CollisionProblem problem = makeProblem(scene, "", nullptr);
  for (const ShapeInstance& instance : problem.robot)
    EXPECT_EQ(scene.link_padding[instance.link], instance.padding);
  for (const ShapeInstance& instance : problem.world)
    EXPECT_EQ(scene.bodyName(instance.body) == "right" ? 0.5 : 0.0, instance.padding);
}

TEST(CollisionProblem, PlacesHalfSpacesInThePlanningFrame)
{
  PlanningScene scene = sceneOf("");
  WorldObject wedge;
  wedge.id = "wedge";
  wedge.padding = 0.125;
  wedge.pose.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // x to y, y to -x
  wedge.pose.translation() << 0, 3, 0;
  PlacedShape plane{HalfSpace{Eigen::Vector3d::UnitX(), 0.5}};
  plane.pose.translation().x() = 1.0;
  wedge.shapes = {{Sphere{0.3}}, plane};
  scene.objects.push_back(wedge);
  scene.allowed_collisions.setEntry("base", "wedge", true);
  const CollisionProblem problem = makeProblem(scene, "", nullptr);
  ASSERT_EQ(1u, problem.half_spaces.size());
  const WorldHalfSpace& half_space = problem.half_spaces[0];
  EXPECT_TRUE(half_space.normal.isApprox(Eigen::Vector3d::UnitY(), 1e-15));
  EXPECT_NEAR(0.5 + 1.0 + 3.0, half_space.offset, 1e-15);
  EXPECT_EQ("wedge", scene.bodyName(half_space.body));
  EXPECT_EQ(0.125, half_space.padding);
  ASSERT_EQ(problem.robot.size(), problem.half_space_pairs.size());
  for (std::size_t i = 0; i < problem.robot.size(); ++i)
  {
    const bool is_base = scene.bodyName(problem.robot[i].body) == "base";
    EXPECT_EQ(is_base ? 0 : 1, problem.half_space_pairs[i]);
  }
}

TEST(CheckedPairs, WithHalfSpacesFollowTheGroup)
{
  PlanningScene scene = sceneOf(srdfWith(""));
  scene.objects = {{"floor", Eigen::Isometry3d::Identity(), {{HalfSpace{Eigen::Vector3d::UnitZ(), -1.0}}}}};
  EXPECT_EQ(1u, makeProblem(scene, "neck", nullptr).half_spaces.size());
  const std::set<NamePair> pairs = checkedPairs(scene, "neck");
  EXPECT_EQ(1u, pairs.count(sorted("head", "floor")));
  EXPECT_EQ(0u, pairs.count(sorted("fore", "floor")));
}

TEST(CollisionProblem, HasItsOriginAtTheRobotWhereverThatStands)
{
  const auto far = robotOf("<link name='world'/>" + boxLink("base") + boxLink("tip") +
                           jointXml("place", "fixed", "world", "base", "<origin xyz='100000 -20000 5'/>") +
                           jointXml("bend", "revolute", "base", "tip", kLimits));
  PlanningScene scene(far);
  scene.objects = {{"ball", Eigen::Isometry3d::Identity(), {{Sphere{0.1}}}}};
  EXPECT_EQ(Eigen::Vector3d(100000, -20000, 5), makeProblem(scene, "", nullptr).origin);
  EXPECT_EQ(Eigen::Vector3d(0, 0, 0), makeProblem(sceneOf(""), "", nullptr).origin);
}

TEST(CollisionProblem, RefusesPaddingAndHalfSpacesThatMeanNothing)
{
  const auto refused = [](const std::string& what, const std::function<void(PlanningScene&)>& spoil)
  {
    PlanningScene scene = carryingScene("");
    spoil(scene);
    const std::string message = errorOf([&] { makeProblem(scene, "", nullptr); });
    EXPECT_NE(std::string::npos, message.find(what)) << message;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused(
      "2 values for 5 links",
      [](PlanningScene& scene) {
        scene.link_padding = {0.0, 0.0};
      });
  refused(
      "link 'base': the padding",
      [](PlanningScene& scene) {
        scene.link_padding = {-0.1, 0, 0, 0, 0};
      });
  refused(
      "padding",
      [nan](PlanningScene& scene) {
        scene.link_padding = {0, 0, 0, 0, nan};
      });
  refused(
      "object 'right': the padding", [](PlanningScene& scene) { scene.objects[0].padding = -0.1; });
  refused(
      "not finite", [](PlanningScene& scene)
      { scene.attached[0].object.pose.translation().x() = std::numeric_limits<double>::infinity(); });
  refused(
      "half-space",
      [](PlanningScene& scene) {
        scene.attached[0].object.shapes.push_back({HalfSpace{Eigen::Vector3d::UnitZ(), 0.0}});
      });
  refused(
      "unit length",
      [](PlanningScene& scene) {
        scene.objects[0].shapes.push_back({HalfSpace{{0.0, 0.0, 2.0}, 0.0}});
      });
  refused(
      "another object has the same name", [](PlanningScene& scene) { scene.attached[0].object.id = "right"; });
  refused(
      "a link or another object", [](PlanningScene& scene) { scene.objects[0].id = "base"; });
  refused(
      "its link has index 5, but the robot has 5 links", [](PlanningScene& scene) { scene.attached[0].link = 5; });
  refused("touch link has index -1", [](PlanningScene& scene) { scene.attached[0].touch_links = {-1}; });
}

TEST(CollisionProblem, TakesTheNearestRotationOfAPoseThatIsAlmostOne)
{
  PlanningScene scene = sceneOf("");
  const Eigen::Matrix3d exact = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  scene.objects[0].pose.linear() = (1.0 + 4e-7) * exact;
  scene.objects[0].shapes[0].pose.linear() = Eigen::Matrix3d::Identity();
  const CollisionProblem problem = makeProblem(scene, "", nullptr);
  ASSERT_FALSE(problem.world.empty());
  const Eigen::Matrix3d& found = problem.world[0].pose.linear();
  EXPECT_TRUE((found * found.transpose()).isIdentity(1e-14)) << found;
  EXPECT_TRUE(found.isApprox(exact, 1e-14)) << found;
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
}  // namespace gpu_planning_scene::core
