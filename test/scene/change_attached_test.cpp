// Changes of attached objects: MoveIt's AttachedCollisionObject.

#include "scene/change_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
class ChangeAttached : public SceneChanges
{
};

/// Converts a pose from the planning frame to the frame of the pole, which is at x = 0.5 and rotated by 90 degrees.
Eigen::Isometry3d inPole(const Eigen::Isometry3d& pose)
{
  return poseAt(0.5, 0, 0, M_PI_2).inverse() * pose;
}

TEST_F(ChangeAttached, TakesAnObjectOutOfTheWorldWhereItIs)
{
  defaults_.object_padding = 0.25;
  defaults_.attached_padding = 0.125;
  change(objectChange(Operation::Add, "a", {boxAt(0.1, poseAt(1, 0, 0))}));
  change(objectChange(Operation::Add, "b", {boxAt(0.1)}));
  AttachedChange attach = attachedChange(Operation::Add, "a", "pole");
  attach.touch_links = {"cart"};
  change(attach);
  ASSERT_EQ(1u, scene_.objects.size());
  EXPECT_EQ("b", scene_.objects[0].id);
  EXPECT_TRUE(carried("a").object.pose.isApprox(inPole(poseAt(1, 0, 0)), 1e-15));
  EXPECT_EQ(link("pole"), carried("a").link);
  EXPECT_EQ(std::vector<int>{link("cart")}, carried("a").touch_links);
  EXPECT_EQ(0.25, carried("a").object.padding) << "its own padding counts when it is put back";
  EXPECT_EQ(0.125, carried("a").padding);
}

TEST_F(ChangeAttached, PutsItBackIntoTheWorldWhereItIs)
{
  defaults_.object_padding = 0.25;
  change(attachedChange(Operation::Add, "a", "pole", {boxAt(0.1)}));
  SceneChange both;
  both.is_diff = true;
  both.state.variables = {{"slide", -1.0}};
  both.state.attached = {attachedChange(Operation::Remove, "a", "")};
  EXPECT_TRUE(carried("a").object.pose.isApprox(inPole(poseAt(0, 0, 0)), 1e-15));
  apply(both);
  EXPECT_TRUE(scene_.attached.empty());
  EXPECT_TRUE(object("a").pose.isApprox(poseAt(-1.5, 0, 0), 1e-15)) << "the cart went 1.5 m: the joints are set first";
  EXPECT_EQ(0.25, object("a").padding);
}

TEST_F(ChangeAttached, WithShapesItReplacesWhateverHasThatId)
{
  change(objectChange(Operation::Add, "a", {boxAt(0.1)}));
  AttachedChange attach = attachedChange(Operation::Add, "a", "pole", {boxAt(0.2, poseAt(1, 0, 0))});
  attach.object.frame.name = "pole";
  change(attach);
  EXPECT_TRUE(scene_.objects.empty());
  EXPECT_TRUE(carried("a").object.pose.isApprox(poseAt(1, 0, 0)));
  attach.link = "cart";
  attach.object.frame.name = "/cart";
  attach.object.shapes = {{Sphere{3.0}}};
  change(attach);
  ASSERT_EQ(1u, scene_.attached.size());
  EXPECT_EQ(link("cart"), carried("a").link);
  EXPECT_TRUE(carried("a").object.pose.isApprox(poseAt(0, 0, 0)));
  EXPECT_EQ(3.0, std::get<Sphere>(carried("a").object.shapes.at(0).shape).radius);
}

TEST_F(ChangeAttached, InItsLinksFrameItNeedsNoRobotState)
{
  state_.clear();
  AttachedChange attach = attachedChange(Operation::Add, "a", "pole", {boxAt(0.2, poseAt(1, 0, 0))});
  refused("state is not known yet", attach);
  attach.object.frame.name = "pole";
  change(attach);
  EXPECT_TRUE(carried("a").object.pose.isApprox(poseAt(1, 0, 0)));
  refused("state is not known yet", attachedChange(Operation::Remove, "a", ""));
}

TEST_F(ChangeAttached, AppendAddsShapesSubframesAndTouchLinks)
{
  AttachedChange attach = attachedChange(Operation::Append, "a", "pole", {boxAt(0.1, poseAt(1, 0, 0))});
  attach.touch_links = {"cart"};
  change(attach);
  const Eigen::Isometry3d where = carried("a").object.pose;
  attach.touch_links = {"nut", "cart"};
  attach.object.subframes["tip"] = poseAt(0, 0, 1);
  attach.link = "";
  change(attach);
  EXPECT_EQ(2u, carried("a").object.shapes.size());
  EXPECT_EQ((std::vector<int>{link("cart"), link("nut")}), carried("a").touch_links);
  EXPECT_EQ(1u, carried("a").object.subframes.count("tip"));
  EXPECT_TRUE(carried("a").object.pose.isApprox(where));
  attach.object.pose = poseAt(0, 0, 0);
  attach.object.frame.name = "pole";
  change(attach);
  EXPECT_TRUE(carried("a").object.pose.isApprox(poseAt(0, 0, 0)));
  attach.link = "cart";
  refused("attached to link 'pole'", attach);
}

TEST_F(ChangeAttached, RemoveWithoutAnIdPutsBackAllOfTheLinkOrOfAll)
{
  const auto fill = [&]
  {
    change(attachedChange(Operation::Add, "a", "pole", {boxAt(0.1)}));
    change(attachedChange(Operation::Add, "b", "cart", {boxAt(0.1)}));
    change(attachedChange(Operation::Add, "c", "pole", {boxAt(0.1)}));
  };
  fill();
  change(attachedChange(Operation::Remove, "", "pole"));
  EXPECT_EQ(1u, scene_.attached.size());
  EXPECT_EQ(2u, scene_.objects.size());
  fill();
  change(attachedChange(Operation::Remove, "", ""));
  EXPECT_TRUE(scene_.attached.empty());
  EXPECT_EQ(3u, scene_.objects.size());
}

TEST_F(ChangeAttached, TheSameChangeMayTakeItOutOfTheWorldAsMoveItsTutorialsDo)
{
  change(objectChange(Operation::Add, "a", {boxAt(0.1)}));
  SceneChange both;
  both.is_diff = true;
  both.state.attached = {attachedChange(Operation::Add, "a", "pole")};
  both.objects = {objectChange(Operation::Remove, "a")};
  apply(both);
  EXPECT_NO_THROW(carried("a"));
  EXPECT_TRUE(scene_.objects.empty());
}

TEST_F(ChangeAttached, KeepsItsColor)
{
  change(objectChange(Operation::Add, "a", {boxAt(0.1)}));
  SceneChange color;
  color.is_diff = true;
  color.colors["a"] = {1.0F, 0.0F, 0.0F, 1.0F};
  apply(color);
  change(attachedChange(Operation::Add, "a", "pole"));
  change(attachedChange(Operation::Remove, "a", "pole"));
  EXPECT_EQ(1u, scene_.colors.count("a"));
}

TEST_F(ChangeAttached, HasItsLinksScale)
{
  SceneChange scale;
  scale.is_diff = true;
  scale.link_scale["pole"] = 2.0;
  change(attachedChange(Operation::Add, "before", "pole", {boxAt(0.1)}));
  apply(scale);
  change(attachedChange(Operation::Add, "after", "pole", {boxAt(0.1)}));
  change(attachedChange(Operation::Append, "after", "pole", {boxAt(0.3)}));
  change(attachedChange(Operation::Add, "other", "cart", {boxAt(0.1)}));
  EXPECT_EQ(0.2, std::get<Box>(carried("before").shapes().at(0).shape).size.x());
  EXPECT_EQ(0.2, std::get<Box>(carried("after").shapes().at(0).shape).size.x());
  EXPECT_EQ(0.6, std::get<Box>(carried("after").shapes().at(1).shape).size.x());
  EXPECT_EQ(0.1, std::get<Box>(carried("other").shapes().at(0).shape).size.x());
  change(attachedChange(Operation::Remove, "before", ""));
  EXPECT_EQ(0.1, std::get<Box>(object("before").shapes.at(0).shape).size.x())
      << "back in the world it has its own size";
}

TEST_F(ChangeAttached, AnUnusedPoseIsReported)
{
  change(objectChange(Operation::Add, "a", {boxAt(0.1)}));
  AttachedChange attach = attachedChange(Operation::Add, "a", "pole");
  attach.object.pose = poseAt(9, 9, 9);
  change(attach);
  EXPECT_TRUE(warned("the pose in the request is not used"));
  EXPECT_TRUE(carried("a").object.pose.isApprox(inPole(poseAt(0, 0, 0)), 1e-15));
}

TEST_F(ChangeAttached, InvalidChangesAreRefused)
{
  change(objectChange(Operation::Add, "a", {boxAt(0.1)}));
  change(objectChange(Operation::Add, "floor", {{HalfSpace{Eigen::Vector3d::UnitZ(), 0.0}}}));
  change(attachedChange(Operation::Add, "held", "pole", {boxAt(0.1)}));
  refused("no link 'crane'; its links: rail, cart, nut, pole, pennant", attachedChange(Operation::Add, "a", "crane"));
  refused("no link 'pennat'; did you mean 'pennant'?", attachedChange(Operation::Add, "a", "pennat"));
  refused("no link ''", attachedChange(Operation::Add, "a", ""));
  refused("no such object", attachedChange(Operation::Add, "b", "pole"));
  refused("attached to link 'pole' already", attachedChange(Operation::Add, "held", "cart"));
  refused("name of a link", attachedChange(Operation::Add, "cart", "pole", {boxAt(0.1)}));
  refused("half-space", attachedChange(Operation::Add, "floor", "pole"));
  refused("half-space",
          attachedChange(Operation::Append, "held", "pole", {{HalfSpace{Eigen::Vector3d::UnitZ(), 0.0}}}));
  refused("cannot be moved", attachedChange(Operation::Move, "held", "pole"));
  refused("no such object is attached", attachedChange(Operation::Remove, "a", "pole"));
  refused("attached to link 'pole', not to 'cart'", attachedChange(Operation::Remove, "held", "cart"));
  refused("no link 'crane'", attachedChange(Operation::Remove, "", "crane"));
  refused("radius", attachedChange(Operation::Add, "a", "pole", {{Sphere{-1.0}}}));
}

/// As in MoveIt, which accepts any name.
TEST_F(ChangeAttached, AnUnknownTouchLinkIsLeftOutWithAWarning)
{
  change(objectChange(Operation::Add, "a", {boxAt(0.1)}));
  AttachedChange touching = attachedChange(Operation::Add, "a", "pole");
  touching.touch_links = {"card", "rail"};
  change(touching);
  EXPECT_EQ((std::vector<int>{link("rail")}), carried("a").touch_links);
  EXPECT_TRUE(warned("touch link of object 'a' ignored: the robot has no link 'card'; did you mean 'cart'?"));
}

class MatrixAndCarrier : public ChangeAttached
{
 protected:
  MatrixAndCarrier() { change(objectChange(Operation::Add, "a", {boxAt(0.1)})); }

  /// Sets an entry of the scene's matrix.
  void setEntry(const std::string& body_1, const std::string& body_2, bool allowed)
  {
    SceneChange matrix;
    matrix.is_diff = true;
    matrix.matrix = scene_.allowed_collisions;
    matrix.matrix->setEntry(body_1, body_2, allowed);
    apply(matrix);
  }
};

TEST_F(MatrixAndCarrier, AMatrixThatOnlyAllowsOtherPairsGivesNoWarning)
{
  setEntry("a", "table", true);
  setEntry("pole", "rail", true);
  change(attachedChange(Operation::Add, "a", "pole"));
  EXPECT_FALSE(warned("forbids"));
}

TEST_F(MatrixAndCarrier, AMatrixThatForbidsTheCarryingLinkIsAWarning)
{
  setEntry("a", "pole", false);
  EXPECT_FALSE(warned("forbids"));
  change(attachedChange(Operation::Add, "a", "pole"));
  EXPECT_TRUE(
      warned("the allowed-collision matrix forbids object 'a' to touch link 'pole', but this pair is not checked"));
  setEntry("a", "pole", false);
  EXPECT_FALSE(warned("forbids object 'a'")) << "it forbade this before";
  setEntry("a", "pole", true);
  setEntry("a", "pole", false);
  EXPECT_TRUE(warned("forbids object 'a'"));
  AttachedChange touching = attachedChange(Operation::Append, "a", "pole");
  touching.touch_links = {"pole"};
  change(touching);
  EXPECT_FALSE(warned("forbids"));
}
}  // namespace
}  // namespace gpu_planning_scene::core
