// A node that follows another one has the same numbers in its scene, to the last bit.

#include <random>

#include <gtest/gtest.h>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
#include "node/messages/exact_numbers.h"
#include "node/messages/from_messages.h"
#include "node/messages/to_messages.h"
#include "scene/random_changes.h"

namespace gpu_planning_scene::core
{
namespace
{
class ExactScenes : public RandomChanges
{
 protected:
  Eigen::Isometry3d turnedPose()
  {
    Eigen::Isometry3d turned = pose();
    turned.linear() = Eigen::Quaterniond(1.0 + number(), number(), number(), number()).normalized().toRotationMatrix();
    return turned;
  }

  ObjectChange turnedObject(const std::string& id)
  {
    ObjectChange object = objectChange(Operation::Add, id, shapes());
    for (PlacedShape& placed : object.shapes)
      placed.pose = turnedPose();
    object.pose = turnedPose();
    object.subframes["handle"] = turnedPose();
    return object;
  }

  ObjectChange turnedPlane()
  {
    HalfSpace half_space;
    half_space.normal = Eigen::Vector3d(number(), number(), 1.1).normalized();
    half_space.offset = number();
    return objectChange(Operation::Add, "floor", {{half_space, turnedPose()}});
  }

  /// The scene that the message makes of another one.
  PlanningScene sent(const PlanningScene& from, const SceneChange& way, bool exactly = true) const
  {
    PlanningSceneMessage message = messageOf(way, *scene_.robot);
    if (exactly)
      keepExactNumbers(way, *scene_.robot, message);
    SceneChange change = changeFrom(message, *scene_.robot, {}, nullptr);
    takeExactNumbers(message, change);
    return applyChange(from, from.current_state, change, defaults_, {}, {}).scene;
  }

  SceneChange whole() const
  {
    return componentsOf(scene_, 0, scene_.current_state, std::vector<bool>(scene_.current_state.size(), true));
  }

  void expectExactly(const PlanningScene& found) const
  {
    PlanningScene expected = scene_;
    expected.matrix_source = found.matrix_source;
    expectSameScene(expected, found);
  }
};

TEST_F(ExactScenes, AFollowerHasEachSceneToTheLastBit)
{
  const unsigned value = std::random_device()();
  seed(value);
  SCOPED_TRACE("seed " + std::to_string(value));
  has_solids_ = true;
  scene_ = PlanningScene(sliderRobotOfMeshes());
  PlanningScene follower(scene_.robot);
  follower = sent(follower, whole());
  for (int i = 0; i < 300 && !HasFailure(); ++i)
  {
    const PlanningScene before = scene_;
    SceneChange random = randomChange();
    if (i % 3 == 0)
      random.objects.push_back(turnedObject("turned " + id()));
    if (i % 7 == 0)
      random.objects.push_back(turnedPlane());
    if (i % 5 == 0)
    {
      AttachedChange attached;
      attached.object = turnedObject("carried " + id());
      attached.link = linkName();
      random.state.attached.push_back(attached);
    }
    if (i % 4 == 0)
      random.fixed_frames["turned"] = turnedPose();
    try
    {
      apply(random);
    }
    catch (const std::exception&)
    {
      continue;
    }
    SceneChange way = diffOf(before, scene_);
    if (!way.is_diff)
      way = whole();
    follower = sent(follower, way);
    expectExactly(follower);
    expectExactly(sent(PlanningScene(scene_.robot), whole()));
  }
}

TEST_F(ExactScenes, ThePlainFieldsOfAMessageAreNotExact)
{
  seed(1);
  std::size_t changed = 0;
  for (int i = 0; i < 20; ++i)
  {
    change(turnedObject("turned"));
    const PlanningScene found = sent(PlanningScene(scene_.robot), whole(), false);
    changed += found.objects[0].pose.matrix() == object("turned").pose.matrix() ? 0 : 1;
  }
  EXPECT_GT(changed, 0U) << "exact_values would be superfluous";
}

TEST_F(ExactScenes, AnOctomapIsExactToo)
{
  seed(2);
  ObjectChange octomap = objectChange(Operation::Add, kOctomapId);
  for (int i = 0; i < 5; ++i)
    octomap.shapes.push_back({Box{{0.1, 0.1, 0.1}}, poseAt(0.1 * (i + 0.5), 0.05, 0.15)});
  octomap.pose = turnedPose();
  change(octomap);
  change(turnedPlane());  // in the message, it comes before the octomap
  expectExactly(sent(PlanningScene(scene_.robot), whole()));
}

TEST_F(ExactScenes, APlaceThatAMessageDoesNotHaveIsRefused)
{
  seed(3);
  change(turnedObject("turned"));
  PlanningSceneMessage message = messageOf(whole(), *scene_.robot);
  SceneChange change = changeFrom(message, *scene_.robot, {}, nullptr);
  message.exact_places = {1000000};
  message.exact_values = {1.0};
  EXPECT_THROW(takeExactNumbers(message, change), Error);
  message.exact_values.clear();
  EXPECT_THROW(takeExactNumbers(message, change), Error);
}
}  // namespace
}  // namespace gpu_planning_scene::core
