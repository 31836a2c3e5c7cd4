// Names, fixed frames, matrix, padding, scale and colours in full scenes and in differences.

#include "scene/change_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
class ChangeSettings : public SceneChanges
{
 protected:
  static SceneChange diff()
  {
    SceneChange change;
    change.is_diff = true;
    return change;
  }

  double padding(const std::string& name) const
  {
    return scene_.link_padding.empty() ? 0.0 : scene_.link_padding.at(static_cast<std::size_t>(link(name)));
  }
  double scale(const std::string& name) const
  {
    const std::vector<double>& factors = scene_.robot->linkScale();
    return factors.empty() ? 1.0 : factors.at(static_cast<std::size_t>(link(name)));
  }
};

TEST_F(ChangeSettings, DiffsKeepUnnamedSettings)
{
  SceneChange first = diff();
  first.name = "hall";
  first.fixed_frames["camera"] = poseAt(1, 0, 0);
  first.matrix = AllowedCollisionMatrix();
  first.matrix->setEntry("cart", "table", true);
  first.link_padding["cart"] = 0.1;
  first.link_scale["pole"] = 2.0;
  first.colors["table"] = {1.0F, 0.0F, 0.0F, 0.5F};
  first.objects = {objectChange(Operation::Add, "table", {boxAt(0.1)})};
  apply(first);
  const PlanningScene before = scene_;
  apply(diff());
  expectSameScene(before, scene_);
  SceneChange second = diff();
  second.link_padding["pole"] = 0.2;
  second.link_scale["cart"] = 3.0;
  second.colors["lamp"] = {};
  apply(second);
  EXPECT_EQ("hall", scene_.name);
  EXPECT_EQ(0.1, padding("cart"));
  EXPECT_EQ(0.2, padding("pole"));
  EXPECT_EQ(2.0, scale("pole"));
  EXPECT_EQ(3.0, scale("cart"));
  EXPECT_EQ(2u, scene_.colors.size());
  EXPECT_TRUE(scene_.allowed_collisions.allowed("cart", "table"));
  EXPECT_FALSE(scene_.allowed_collisions.allowed("cart", "pole")) << "a matrix replaces all of the SRDF's";
}

TEST_F(ChangeSettings, FullScenesResetUnnamedSettings)
{
  SceneChange first = diff();
  first.name = "hall";
  first.fixed_frames["camera"] = poseAt(1, 0, 0);
  first.matrix = AllowedCollisionMatrix();
  first.link_padding["cart"] = 0.1;
  first.link_scale["pole"] = 2.0;
  first.colors["table"] = {};
  first.objects = {objectChange(Operation::Add, "table", {boxAt(0.1)})};
  apply(first);
  defaults_.link_padding.assign(scene_.robot->links().size(), 0.01);
  defaults_.link_scale.assign(scene_.robot->links().size(), 1.5);
  SceneChange full;
  full.link_padding["pole"] = 0.5;
  full.link_scale["cart"] = 1.0;
  apply(full);
  EXPECT_EQ("", scene_.name);
  EXPECT_TRUE(scene_.fixed_frames.empty());
  EXPECT_TRUE(scene_.colors.empty());
  EXPECT_TRUE(scene_.objects.empty());
  EXPECT_TRUE(scene_.allowed_collisions == AllowedCollisionMatrix::fromRobot(*scene_.robot));
  EXPECT_EQ(MatrixSource::Srdf, scene_.matrix_source);
  EXPECT_EQ(0.01, padding("cart"));
  EXPECT_EQ(0.5, padding("pole"));
  // A link that becomes smaller is checked less far.
  const auto warned = [this](const std::string& text)
  {
    return std::count_if(warnings_.begin(), warnings_.end(),
                         [&text](const std::string& warning) { return warning.find(text) == 0; });
  };
  EXPECT_EQ(1, warned("the padding of link 'cart' is 0.01"));
  EXPECT_EQ(1, warned("the scale of link 'pole' is 1.5"));
  EXPECT_EQ(1, warned("'cart' and 'pole' are no longer checked against each other: the scene is not a diff"));
  EXPECT_EQ(1, warned("removed because the scene's is_diff is false"));
  EXPECT_EQ(4u, warnings_.size());
  EXPECT_EQ(1.5, scale("pole"));
  EXPECT_EQ(1.0, scale("cart"));
}

TEST_F(ChangeSettings, FixedFramesReplaceAllOthers)
{
  SceneChange frames_change = diff();
  frames_change.fixed_frames = {{"camera", poseAt(1, 0, 0)}, {"rail", poseAt(0, 0, 0)}};
  apply(frames_change);
  EXPECT_EQ(1u, scene_.fixed_frames.size()) << "MoveIt lists the planning frame, rail, too";
  frames_change.fixed_frames = {{"lamp", poseAt(2, 0, 0)}};
  apply(frames_change);
  ASSERT_EQ(1u, scene_.fixed_frames.size());
  EXPECT_EQ(1u, scene_.fixed_frames.count("lamp"));
  frames_change.fixed_frames = {{"rail", poseAt(2, 0, 0)}};
  refused("must be the identity", frames_change);
  frames_change.fixed_frames = {{"pole", poseAt(0, 0, 0)}};
  refused("name of a link", frames_change);
  frames_change.fixed_frames = {{"", poseAt(0, 0, 0)}};
  refused("has no name", frames_change);
  frames_change.fixed_frames = {{"a", poseAt(std::numeric_limits<double>::quiet_NaN(), 0, 0)}};
  refused("not finite", frames_change);
}

TEST_F(ChangeSettings, ObjectsComeAfterEverythingElse)
{
  SceneChange change = diff();
  change.fixed_frames["camera"] = poseAt(1, 0, 0);
  change.state.variables["slide"] = 2.0;
  ObjectChange in_camera = objectChange(Operation::Add, "a", {boxAt(0.1)});
  in_camera.frame.name = "camera";
  ObjectChange in_link = objectChange(Operation::Add, "b", {boxAt(0.1)});
  in_link.frame.name = "cart";
  change.objects = {in_camera, in_link};
  apply(change);
  EXPECT_EQ(1.0, object("a").pose.translation().x());
  EXPECT_EQ(2.0, object("b").pose.translation().x());
}

TEST_F(ChangeSettings, InvalidChangesAreRefused)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused_where = [&](const std::string& fragment, const std::function<void(SceneChange&)>& edit)
  {
    SceneChange change = diff();
    edit(change);
    refused(fragment, change);
  };
  refused_where(
      "for robot 'panda'", [](SceneChange& change) { change.robot_model_name = "panda"; });
  refused_where(
      "no link 'crane'", [](SceneChange& change) { change.link_padding["crane"] = 0.1; });
  refused_where(
      "link 'cart': the padding", [](SceneChange& change) { change.link_padding["cart"] = -0.1; });
  refused_where(
      "link 'cart': the padding", [nan](SceneChange& change) { change.link_padding["cart"] = nan; });
  refused_where(
      "no link 'crane'", [](SceneChange& change) { change.link_scale["crane"] = 2.0; });
  refused_where(
      "link 'cart': the scale", [](SceneChange& change) { change.link_scale["cart"] = 0.0; });
  refused_where(
      "link 'cart': the scale", [nan](SceneChange& change) { change.link_scale["cart"] = nan; });
  refused_where(
      "link 'cart': scaled by", [](SceneChange& change) { change.link_scale["cart"] = 1e-323; });
  refused_where(
      "color of 'a'",
      [](SceneChange& change) {
        change.colors["a"] = {1.5F, 0.0F, 0.0F, 1.0F};
      });
  refused_where(
      "color of 'a'",
      [nan](SceneChange& change) {
        change.colors["a"] = {static_cast<float>(nan), 0.0F, 0.0F, 1.0F};
      });
  refused_where(
      "an object color has no name", [](SceneChange& change) { change.colors[""] = {}; });
  refused_where("line break", [](SceneChange& change) { change.name = "a\nb"; });
}
}  // namespace
}  // namespace gpu_planning_scene::core
