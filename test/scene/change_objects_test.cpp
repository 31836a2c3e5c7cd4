// Operations on objects of the world: ADD, APPEND, MOVE and REMOVE of MoveIt's CollisionObject.

#include "scene/change_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
class ChangeObjects : public SceneChanges
{
};

TEST_F(ChangeObjects, AddPutsTheObjectWhereItsPoseSays)
{
  defaults_.object_padding = 0.01;
  ObjectChange add = objectChange(Operation::Add, "a", {boxAt(0.1, poseAt(0, 0, 1)), boxAt(0.2)});
  add.pose = poseAt(1, 2, 3, M_PI_2);
  add.subframes["tip"] = poseAt(0, 0, 4);
  change(add);
  EXPECT_TRUE(object("a").pose.isApprox(poseAt(1, 2, 3, M_PI_2)));
  ASSERT_EQ(2u, object("a").shapes.size());
  EXPECT_EQ(1.0, object("a").shapes[0].pose.translation().z());
  EXPECT_EQ(4.0, object("a").subframes.at("tip").translation().z());
  EXPECT_EQ(0.01, object("a").padding);
}

TEST_F(ChangeObjects, AddReplacesTheObjectOfThatId)
{
  change(objectChange(Operation::Add, "a", {boxAt(0.1)}));
  change(objectChange(Operation::Add, "b", {boxAt(0.1)}));
  change(objectChange(Operation::Add, "a", {{Sphere{2.0}}}));
  ASSERT_EQ(2u, scene_.objects.size());
  ASSERT_EQ(1u, object("a").shapes.size());
  EXPECT_EQ(2.0, std::get<Sphere>(object("a").shapes[0].shape).radius);
}

TEST_F(ChangeObjects, ThePoseOfALoneShapeBecomesTheObjectsWhereThatWasNotSet)
{
  change(objectChange(Operation::Add, "one", {boxAt(0.1, poseAt(1, 2, 3))}));
  EXPECT_TRUE(object("one").pose.isApprox(poseAt(1, 2, 3)));
  EXPECT_TRUE(object("one").shapes[0].pose.isApprox(poseAt(0, 0, 0)));
  change(objectChange(Operation::Add, "two", {boxAt(0.1, poseAt(1, 2, 3)), boxAt(0.1)}));
  EXPECT_TRUE(object("two").pose.isApprox(poseAt(0, 0, 0)));
  EXPECT_TRUE(object("two").shapes[0].pose.isApprox(poseAt(1, 2, 3)));
  ObjectChange set = objectChange(Operation::Add, "set", {boxAt(0.1, poseAt(1, 2, 3))});
  set.pose = poseAt(0, 0, 0);
  change(set);
  EXPECT_TRUE(object("set").shapes[0].pose.isApprox(poseAt(1, 2, 3)));
}

TEST_F(ChangeObjects, AppendAddsShapesAndSubframesAndLeavesTheObjectWhereItIs)
{
  ObjectChange add = objectChange(Operation::Add, "a", {triangleAt()});
  add.pose = poseAt(1, 0, 0);
  add.subframes["tip"] = poseAt(0, 0, 4);
  change(add);
  ObjectChange append = objectChange(Operation::Append, "a", {boxAt(0.1, poseAt(0, 5, 0))});
  append.subframes["tail"] = poseAt(0, 0, -4);
  change(append);
  EXPECT_TRUE(object("a").pose.isApprox(poseAt(1, 0, 0)));
  ASSERT_EQ(2u, object("a").shapes.size());
  EXPECT_EQ(5.0, object("a").shapes[0].pose.translation().y())
      << "primitives come before meshes, as messages have them";
  EXPECT_EQ(2u, object("a").subframes.size());
  append.pose = poseAt(0, 0, 0);  // the identity pose of clients that fill in a quaternion
  append.frame.name = scene_.robot->planningFrame();
  change(append);
  EXPECT_TRUE(object("a").pose.isApprox(poseAt(1, 0, 0)));
  EXPECT_EQ(3u, object("a").shapes.size());
  append.pose = poseAt(1, 0, 0);  // the object's own pose
  change(append);
  EXPECT_EQ(4u, object("a").shapes.size());
  append.pose = poseAt(7, 0, 0);
  refused("leave the object's pose out", append);
  append.pose.reset();
  append.frame.name = "cart";
  refused("leave frame_id out", append);
}

TEST_F(ChangeObjects, AppendToNothingAdds)
{
  change(objectChange(Operation::Append, "a", {boxAt(0.1, poseAt(1, 0, 0))}));
  EXPECT_TRUE(object("a").pose.isApprox(poseAt(1, 0, 0)));
  refused("has no shapes", objectChange(Operation::Append, "b"));
}

TEST_F(ChangeObjects, MoveSetsThePoseAndKeepsTheShapes)
{
  ObjectChange add = objectChange(Operation::Add, "a", {boxAt(0.1), triangleAt(poseAt(0, 0, 1))});
  change(add);
  const auto mesh = object("a").shapes[1].shape;
  ObjectChange move = objectChange(Operation::Move, "a");
  move.pose = poseAt(1, 2, 3, 0.5);
  change(move);
  EXPECT_TRUE(object("a").pose.isApprox(poseAt(1, 2, 3, 0.5)));
  EXPECT_EQ(std::get<5 - 1>(mesh), std::get<5 - 1>(object("a").shapes[1].shape)) << "the mesh is not copied";
  EXPECT_EQ(1.0, object("a").shapes[1].pose.translation().z());

  move.shape_poses = {poseAt(0, 0, 7), poseAt(0, 0, 8)};
  move.frame.name = "a";  // the object's current pose
  change(move);
  EXPECT_TRUE(object("a").pose.isApprox(poseAt(1, 2, 3, 0.5) * poseAt(1, 2, 3, 0.5)));
  EXPECT_EQ(7.0, object("a").shapes[0].pose.translation().z());
  EXPECT_EQ(8.0, object("a").shapes[1].pose.translation().z());
}

TEST_F(ChangeObjects, MoveOfALoneShapeWithoutAPoseMovesTheObject)
{
  change(objectChange(Operation::Add, "a", {boxAt(0.1)}));
  ObjectChange move = objectChange(Operation::Move, "a");
  move.shape_poses = {poseAt(0, 0, 7)};
  change(move);
  EXPECT_TRUE(object("a").pose.isApprox(poseAt(0, 0, 7)));
  EXPECT_TRUE(object("a").shapes[0].pose.isApprox(poseAt(0, 0, 0)));
}

TEST_F(ChangeObjects, RemoveTakesOneAndWithoutAnIdAll)
{
  for (const char* id : {"a", "b", "c"})
    change(objectChange(Operation::Add, id, {boxAt(0.1)}));
  SceneChange color;
  color.is_diff = true;
  color.colors["b"] = {1.0F, 0.0F, 0.0F, 1.0F};
  apply(color);
  change(objectChange(Operation::Remove, "b"));
  ASSERT_EQ(2u, scene_.objects.size());
  EXPECT_EQ("a", scene_.objects[0].id);
  EXPECT_EQ("c", scene_.objects[1].id);
  EXPECT_TRUE(scene_.colors.empty()) << "its colour goes with it";
  change(objectChange(Operation::Remove, ""));
  EXPECT_TRUE(scene_.objects.empty());
  change(objectChange(Operation::Remove, ""));
}

/// Clients often leave is_diff unset by mistake.
TEST_F(ChangeObjects, AFullSceneNamesTheObjectsThatItRemoves)
{
  for (const char* id : {"a", "b", "c"})
    change(objectChange(Operation::Add, id, {boxAt(0.1)}));
  SceneChange full;
  full.objects = {objectChange(Operation::Add, "b", {boxAt(0.2)})};
  apply(full);
  EXPECT_EQ(1u, scene_.objects.size());
  EXPECT_TRUE(warned("removed because the scene's is_diff is false, which replaces the world: 'a', 'c'"));
  apply(full);
  EXPECT_FALSE(warned("removed"));
}

TEST_F(ChangeObjects, ChangesOfOneMessageFollowEachOther)
{
  SceneChange many;
  many.is_diff = true;
  ObjectChange move = objectChange(Operation::Move, "a");
  move.pose = poseAt(1, 0, 0);
  ObjectChange beside = objectChange(Operation::Add, "c", {boxAt(0.1)});
  beside.frame.name = "a";
  many.objects = {objectChange(Operation::Add, "a", {boxAt(0.1)}),
                  objectChange(Operation::Add, "b", {boxAt(0.1)}),
                  move,
                  beside,
                  objectChange(Operation::Append, "b", {boxAt(0.2)}),
                  objectChange(Operation::Remove, "a"),
                  objectChange(Operation::Add, "a", {boxAt(0.3)})};
  apply(many);
  ASSERT_EQ(3u, scene_.objects.size());
  EXPECT_TRUE(object("c").pose.isApprox(poseAt(1, 0, 0)));
  EXPECT_EQ(2u, object("b").shapes.size());
  EXPECT_EQ(0.3, std::get<Box>(object("a").shapes[0].shape).size.x());
}

TEST_F(ChangeObjects, InvalidChangesAreRefused)
{
  change(objectChange(Operation::Add, "a", {boxAt(0.1)}));
  change(attachedChange(Operation::Add, "held", "pole", {boxAt(0.1)}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused("has no shapes", objectChange(Operation::Add, "b"));
  refused("has no name", objectChange(Operation::Add, "", {boxAt(0.1)}));
  refused("name of a link", objectChange(Operation::Add, "pole", {boxAt(0.1)}));
  refused("line break", objectChange(Operation::Add, "a\nb", {boxAt(0.1)}));
  for (const Operation operation : {Operation::Add, Operation::Append, Operation::Move, Operation::Remove})
    refused("link 'pole'", objectChange(operation, "held", {boxAt(0.1)}));
  refused("no such object", objectChange(Operation::Remove, "b"));
  refused("no such object", objectChange(Operation::Move, "b"));
  refused("leave the shapes out", objectChange(Operation::Move, "a", {boxAt(0.1)}));
  refused("size along x", objectChange(Operation::Add, "a", {boxAt(-0.1)}));
  refused("at most 1000 km", objectChange(Operation::Add, "a", {boxAt(1e307)}));
  refused("farther than 1000 km", objectChange(Operation::Add, "a", {boxAt(0.1, poseAt(1e307, 0, 0))}));
  refused("not finite", objectChange(Operation::Add, "a", {boxAt(0.1, poseAt(nan, 0, 0))}));
  ObjectChange beyond = objectChange(Operation::Add, "b", {boxAt(0.1, poseAt(9e5, 0, 0))});
  beyond.frame.name = "far";
  change(objectChange(Operation::Add, "far", {boxAt(0.1, poseAt(9e5, 0, 0))}));
  refused("a place in frame 'far'", beyond);
  ObjectChange move = objectChange(Operation::Move, "a");
  move.shape_poses = {poseAt(0, 0, 0), poseAt(0, 0, 0)};
  refused("2 poses for its 1 shapes", move);
  ObjectChange posed = objectChange(Operation::Add, "a", {boxAt(0.1)});
  posed.pose = poseAt(0, nan, 0);
  refused("not finite", posed);
  posed.pose = poseAt(0, 0, 0);
  posed.pose->linear() *= 2.0;
  refused("not a rotation", posed);
  posed.pose = poseAt(0, 0, 0);
  posed.subframes["tip"] = poseAt(0, nan, 0);
  refused("subframe 'tip'", posed);
}
}  // namespace
}  // namespace gpu_planning_scene::core
