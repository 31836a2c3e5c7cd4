// The computed difference of two random scenes leads from one to the other.

#include <random>

#include "scene/change_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
class RandomChanges : public SceneChanges
{
 protected:
  std::size_t upTo(std::size_t max) { return random_() % (max + 1); }
  bool chance() { return random_() % 2 == 0; }
  double number() { return static_cast<double>(random_() % 2001) / 1000.0 - 1.0; }
  Eigen::Isometry3d pose() { return poseAt(number(), number(), number(), number()); }
  std::string id() { return std::string(1, static_cast<char>('a' + upTo(4))); }
  std::string linkName() { return scene_.robot->links()[upTo(scene_.robot->links().size() - 1)].name; }

  std::vector<PlacedShape> shapes()
  {
    std::vector<PlacedShape> result;
    for (std::size_t i = 0; i <= upTo(2); ++i)
      switch (upTo(3))
      {
        case 0:
          result.push_back(boxAt(1.5 + number(), pose()));
          break;
        case 1:
          result.push_back({Sphere{1.5 + number()}, pose()});
          break;
        case 2:
          result.push_back({Cylinder{1.5 + number(), 2.0}, pose()});
          break;
        default:
          result.push_back(triangleAt(pose()));
      }
    return result;
  }

  void fill(ObjectChange& object)
  {
    if (object.operation == Operation::Add || object.operation == Operation::Append)
      object.shapes = shapes();
    if (chance())
      object.pose = pose();
    if (chance())
      object.type = {id(), id()};
    if (chance() && object.operation != Operation::Remove)
      object.subframes[id()] = pose();
  }

  SceneChange randomChange()
  {
    SceneChange change;
    change.is_diff = upTo(9) != 0;
    change.name = chance() ? id() : "";
    if (chance())
      change.fixed_frames["frame " + id()] = pose();
    if (chance())
      change.state.variables["slide"] = number();
    if (chance())
    {
      change.matrix = AllowedCollisionMatrix();
      change.matrix->setEntry(id(), linkName(), chance());
      change.matrix->setDefault(id(), chance());
    }
    if (chance())
      change.link_padding[linkName()] = 1.0 + number();
    if (chance())
      change.link_scale[linkName()] = 2.0 + number();
    if (chance())
      change.colors[id()] = {0.25F * static_cast<float>(upTo(4)), 0.0F, 0.0F, 1.0F};
    for (std::size_t i = upTo(2); i > 0; --i)
    {
      AttachedChange attached = attachedChange(static_cast<Operation>(upTo(2)), id(), linkName());
      fill(attached.object);
      if (chance())
        attached.touch_links = {linkName()};
      change.state.attached.push_back(attached);
    }
    for (std::size_t i = upTo(2); i > 0; --i)
    {
      ObjectChange object = objectChange(static_cast<Operation>(upTo(3)), id());
      fill(object);
      change.objects.push_back(object);
    }
    return change;
  }

  void seed(unsigned value) { random_.seed(value); }

 private:
  std::mt19937 random_;
};

TEST_F(RandomChanges, TheirDifferenceLeadsFromOneSceneToTheOther)
{
  const unsigned value = std::random_device()();
  seed(value);
  SCOPED_TRACE("seed " + std::to_string(value));
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
  const SceneChange none = diffOf(scene_, scene_);
  EXPECT_TRUE(none.is_diff);
  EXPECT_TRUE(none.objects.empty() && none.state.attached.empty() && none.state.variables.empty());
  EXPECT_TRUE(!none.matrix && none.link_padding.empty() && none.link_scale.empty() && none.colors.empty());
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
