// The computed difference of two random scenes leads from one to the other.

#include "scene/random_changes.h"

namespace gpu_planning_scene::core
{
namespace
{
TEST_F(RandomChanges, TheirDifferenceLeadsFromOneSceneToTheOther)
{
  const unsigned value = std::random_device()();
  seed(value);
  SCOPED_TRACE("seed " + std::to_string(value));
  has_solids_ = true;
  scene_ = PlanningScene(sliderRobotOfMeshes());
  defaults_.object_padding = 0.125;
  defaults_.attached_padding = 0.25;
  std::size_t made = 0;
  std::size_t differences = 0;
  std::vector<PlanningScene> scenes = {scene_};
  for (int i = 0; i < 2000 && !HasFailure(); ++i)
  {
    const SceneChange change = randomChange();
    try
    {
      apply(change);
    }
    catch (const std::exception&)
    {
      continue;
    }
    ++made;
    const PlanningScene reached = scene_;
    const PlanningScene& from = scenes[upTo(scenes.size() - 1)];
    const SceneChange way = diffOf(from, reached);
    differences += way.is_diff ? 1 : 0;
    const ChangedScene walked = applyChange(from, from.current_state, way, defaults_, limits_, {});
    PlanningScene expected = reached;
    expected.matrix_source = walked.scene.matrix_source;  // an equal matrix need not come from the SRDF
    if (reached.current_state.empty())
      expected.current_state = walked.scene.current_state;
    expectSameScene(expected, walked.scene);
    scenes.push_back(reached);
    state_ = reached.current_state;
  }
  EXPECT_GT(made, 200u);
  EXPECT_GT(differences, made / 10);
}

TEST_F(RandomChanges, NothingLeadsFromASceneToItself)
{
  change(objectChange(Operation::Add, "a", {boxAt(0.1), triangleAt()}));
  change(attachedChange(Operation::Add, "b", "pole", {boxAt(0.1)}));
  SceneChange rules;
  rules.is_diff = true;
  rules.solids = {{"a", SolidRule::Filled}};
  apply(rules);
  const SceneChange none = diffOf(scene_, scene_);
  EXPECT_TRUE(none.is_diff);
  EXPECT_TRUE(none.objects.empty() && none.state.attached.empty() && none.state.variables.empty());
  EXPECT_TRUE(!none.matrix && none.link_padding.empty() && none.link_scale.empty() && none.colors.empty() &&
              none.solids.empty());
}

TEST_F(RandomChanges, TouchLinksAloneAreADifference)
{
  change(attachedChange(Operation::Add, "a", "pole", {boxAt(0.1)}));
  const PlanningScene before = scene_;
  scene_.attached[0].touch_links = {link("cart")};
  const SceneChange way = diffOf(before, scene_);
  expectSameScene(scene_, applyChange(before, state_, way, defaults_, limits_, frames_).scene);
}

TEST_F(RandomChanges, AMoveIsNotAnAddition)
{
  change(objectChange(Operation::Add, "a", {triangleAt(), triangleAt()}));
  const PlanningScene before = scene_;
  ObjectChange move = objectChange(Operation::Move, "a");
  move.pose = poseAt(1, 0, 0);
  change(move);
  const SceneChange way = diffOf(before, scene_);
  ASSERT_EQ(1u, way.objects.size());
  EXPECT_EQ(Operation::Move, way.objects[0].operation);
  EXPECT_TRUE(way.objects[0].shapes.empty());
}
}  // namespace
}  // namespace gpu_planning_scene::core
