// A problem maker reuses the reach of one scene for the next scene as far as it still holds. After each relevant change
// its problem must equal the problem of a new maker.

#include <functional>

#include <gtest/gtest.h>

#include "collision/bounds/problem_maker.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr const char* kNarrow = R"(<axis xyz="0 0 1"/><limit lower="-0.7" upper="0.7" effort="1" velocity="1"/>)";

/// A base with an arm in front and a tail behind, `apart` metres from each other. Both turn by up to 0.7 rad.
std::shared_ptr<const RobotModel> armAndTail(double apart)
{
  const auto at = [](double x) { return "<origin xyz=\"" + std::to_string(x) + " 0 0\"/>" + kNarrow; };
  return robotOf(boxLink("base") + boxLink("arm") + boxLink("tail") +
                 jointXml("to_arm", "revolute", "base", "arm", at(0.5 * apart)) +
                 jointXml("to_tail", "revolute", "base", "tail", at(-0.5 * apart)));
}

AttachedObject rod(const std::string& id, int link, double from, double length)
{
  AttachedObject attached;
  attached.object.id = id;
  attached.object.pose.translation().x() = from + 0.5 * length;
  attached.object.shapes.push_back({Box{{length, 0.05, 0.05}}});
  attached.link = link;
  return attached;
}

/// Posts in a row in front of the robot and behind it, a metre apart.
PlanningScene sceneWithPosts()
{
  PlanningScene scene(armAndTail(4.0));
  for (int i = -9; i <= 9; ++i)
  {
    WorldObject post;
    post.id = "post_" + std::to_string(i);
    post.pose.translation() = Eigen::Vector3d(i, 1.0, 0.0);
    post.shapes.push_back({Box{{0.1, 0.1, 1.0}}});
    scene.objects.push_back(post);
  }
  return scene;
}

struct Step
{
  std::string what;
  std::function<void(PlanningScene&)> change;
};

/// Expects the problems of a new maker after each step. Every step must change the reachable pairs.
void expectProblemsOfANewMaker(PlanningScene scene, const std::vector<Step>& steps)
{
  ProblemMaker maker{CheckerOptions()};
  const auto bodies = [](const std::vector<ShapeInstance>& instances)
  {
    std::vector<std::int32_t> result;
    for (const ShapeInstance& instance : instances)
      result.push_back(instance.body);
    return result;
  };
  CollisionProblem before = maker.make(scene, "", nullptr);
  for (const Step& step : steps)
  {
    step.change(scene);
    const CollisionProblem now = maker.make(scene, "", nullptr);
    const CollisionProblem fresh = ProblemMaker(CheckerOptions()).make(scene, "", nullptr);
    EXPECT_EQ(now.self_pairs, fresh.self_pairs) << step.what;
    EXPECT_EQ(now.world_pairs, fresh.world_pairs) << step.what;
    EXPECT_EQ(bodies(now.robot), bodies(fresh.robot)) << step.what;
    EXPECT_EQ(bodies(now.world), bodies(fresh.world)) << step.what;
    EXPECT_FALSE(now.self_pairs == before.self_pairs && now.world_pairs == before.world_pairs &&
                 bodies(now.robot) == bodies(before.robot) && bodies(now.world) == bodies(before.world))
        << step.what << " changed nothing";
    before = now;
  }
}

TEST(ReachUpdates, OfAttachedObjectsAreNoticed)
{
  constexpr int kArm = 1;
  constexpr int kTail = 2;
  expectProblemsOfANewMaker(
      sceneWithPosts(),
      {{"a short one", [](PlanningScene& scene) { scene.attached = {rod("rod", kArm, 0.0, 1.5)}; }},
       {"a longer one",
        [](PlanningScene& scene) {
          scene.attached[0].object.shapes = {{Box{{8.0, 0.05, 0.05}}}};
        }},
       {"a short one again", [](PlanningScene& scene) { scene.attached = {rod("rod", kArm, 0.0, 1.5)}; }},
       {"a padded one", [](PlanningScene& scene) { scene.attached[0].padding = 2.0; }},
       {"one that is not padded", [](PlanningScene& scene) { scene.attached[0].padding = 0.0; }},
       {"a scaled one",
        [](PlanningScene& scene) {
          scene.setLinkScale({1.0, 3.0, 1.0});
        }},
       {"one that is not scaled", [](PlanningScene& scene) { scene.setLinkScale({}); }},
       {"held farther out", [](PlanningScene& scene) { scene.attached[0].object.pose.translation().x() += 4.0; }},
       {"at the tail", [](PlanningScene& scene) { scene.attached[0].link = kTail; }},
       {"up to the tail", [](PlanningScene& scene) { scene.attached = {rod("rod", kArm, -4.5, 1.0)}; }},
       {"two",
        [](PlanningScene& scene) {
          scene.attached = {rod("rod", kArm, 0.0, 1.5), rod("other", kTail, -9.0, 4.0)};
        }},
       {"the two in each other's place",
        [](PlanningScene& scene) { std::swap(scene.attached[0].link, scene.attached[1].link); }},
       {"the first is gone", [](PlanningScene& scene) { scene.attached.erase(scene.attached.begin()); }},
       {"another robot", [](PlanningScene& scene) { scene.robot = armAndTail(1.0); }}});
}

TEST(ReachUpdates, OfObjectsAndPaddingAreNoticed)
{
  const auto link_padding = [](double metres)
  { return [metres](PlanningScene& scene) { scene.link_padding.assign(3, metres); }; };
  expectProblemsOfANewMaker(sceneWithPosts(),
                            {{"padded links", link_padding(1.0)},
                             {"links that are not", link_padding(0.0)},
                             {"a padded object", [](PlanningScene& scene) { scene.objects[11].padding = 1.2; }},
                             {"a wider object",
                              [](PlanningScene& scene) {
                                scene.objects[7].shapes = {{Box{{3.0, 3.0, 1.0}}}};
                              }},
                             {"a shape that lies elsewhere in its object", [](PlanningScene& scene)
                              { scene.objects[12].shapes[0].pose.translation() = Eigen::Vector3d(-1.0, -1.0, 0.0); }},
                             {"a moved object", [](PlanningScene& scene)
                              { scene.objects[0].pose.translation() = Eigen::Vector3d(2.0, 0.5, 0.0); }},
                             {"one less", [](PlanningScene& scene) { scene.objects.erase(scene.objects.begin()); }},
                             {"another robot", [](PlanningScene& scene) { scene.robot = armAndTail(8.0); }}});
}

TEST(ReachUpdates, OfARefusedSceneLeaveNothingBehind)
{
  const PlanningScene scene = sceneWithPosts();
  PlanningScene refused = scene;
  for (WorldObject& object : refused.objects)
    object.pose.translation().x() += 0.5;
  refused.objects.back().padding = -1.0;
  ProblemMaker maker{CheckerOptions()};
  const CollisionProblem before = maker.make(scene, "", nullptr);
  EXPECT_NE(errorOf([&] { maker.make(refused, "", nullptr); }), "");
  const CollisionProblem after = maker.make(scene, "", nullptr);
  EXPECT_EQ(after.world_pairs, before.world_pairs);
  EXPECT_EQ(after.self_pairs, before.self_pairs);
}
}  // namespace
}  // namespace gpu_planning_scene::core
