// Attached objects, over apply_planning_scene.

#include "node/node_client.h"

namespace gpu_planning_scene::core
{
namespace
{
class AttachedObjects : public RunningNode
{
 public:
  static AttachedCollisionObject attach(const CollisionObject& object, const std::vector<std::string>& touch_links = {})
  {
    AttachedCollisionObject attached;
    attached.link_name = tip;
    attached.object = object;
    attached.touch_links = touch_links;
    return attached;
  }

  static std::vector<std::string> allLinks()
  {
    std::vector<std::string> names;
    for (const Link& link : robot->links())
      names.push_back(link.name);
    return names;
  }

  /// A state in which the tip is elsewhere.
  static std::vector<double> otherState()
  {
    std::vector<double> state = free_state;
    state[0] += state[0] > 0.0 ? -0.7 : 0.7;
    return state;
  }
};

TEST_F(AttachedObjects, AnObjectOfTheWorldIsAttachedMovesWithItsLinkAndIsPutBack)
{
  apply(diffWith(boxObject("box", tipPoint(), 0.02)));
  EXPECT_FALSE(isFree());
  apply(diffWith(attach(objectOperation("box", CollisionObject::ADD), allLinks())));
  EXPECT_TRUE(isFree()) << "all links may touch it";
  EXPECT_TRUE(scene().world.collision_objects.empty()) << "attaching takes it out of the world";
  ASSERT_EQ(1u, scene().robot_state.attached_collision_objects.size());
  EXPECT_EQ(tip, scene().robot_state.attached_collision_objects[0].link_name);

  PlanningSceneMessage change = diffScene();
  change.robot_state = stateMessage(otherState());
  change.robot_state.is_diff = true;
  apply(change);
  apply(diffWith(attach(objectOperation("box", CollisionObject::REMOVE))));
  EXPECT_TRUE(scene().robot_state.attached_collision_objects.empty());
  ASSERT_EQ(1u, scene().world.collision_objects.size()) << "detaching puts it back";
  const Eigen::Vector3d expected = linkPose(tip, otherState()) * linkPose(tip, free_state).inverse() * tipPoint();
  const geometry_msgs::Point there = scene().world.collision_objects[0].pose.position;
  EXPECT_NEAR(0.0, (expected - Eigen::Vector3d(there.x, there.y, there.z)).norm(), 1e-9);
  EXPECT_FALSE(check(otherState()).valid.at(0));
  EXPECT_GT((expected - tipPoint()).norm(), 0.05) << "the test moves it";
}

TEST_F(AttachedObjects, ACarriedObjectCollidesWithTheWorld)
{
  CollisionObject stick = boxObject("stick", tipPoint(), 0.02);
  stick.primitive_poses[0] = poseAt(Eigen::Vector3d(0.0, 0.0, 20.0));
  stick.header.frame_id = "";
  apply(diffWith(attach(stick)));
  EXPECT_TRUE(isFree());
  apply(diffWith(boxObject("lamp", tipPoint() + Eigen::Vector3d(0.0, 0.0, 20.0), 0.02)));
  EXPECT_EQ("lamp stick", collision());
}

TEST_F(AttachedObjects, ACarriedObjectCollidesWithLinksThatMayNotTouchIt)
{
  const PlacedShape& placed = robot->links()[static_cast<std::size_t>(robot->linkIndex(base))].shapes.front();
  CollisionObject box = boxObject("box", linkPose(base, free_state) * placed.pose.translation(), 0.5);
  apply(diffWith(attach(box)));
  EXPECT_FALSE(isFree());
  apply(diffWith(attach(box, allLinks())));
  EXPECT_TRUE(isFree()) << "touch links may touch it";
}

TEST_F(AttachedObjects, ACarriedObjectHasItsLinksPadding)
{
  CollisionObject stick = boxObject("stick", tipPoint(), 0.02);
  stick.primitive_poses[0] = poseAt(Eigen::Vector3d(0.0, 0.0, 20.0));
  apply(diffWith(attach(stick)));
  apply(diffWith(boxObject("lamp", tipPoint() + Eigen::Vector3d(0.0, 0.0, 20.05), 0.02)));
  EXPECT_TRUE(isFree());
  PlanningSceneMessage change = diffScene();
  change.link_padding.resize(1);
  change.link_padding[0].link_name = tip;
  change.link_padding[0].padding = 0.04;
  apply(change);
  EXPECT_EQ("lamp stick", collision());
}

TEST_F(AttachedObjects, ARobotStateThatIsNoDifferenceDropsThemAsInMoveIt)
{
  apply(diffWith(attach(boxObject("box", tipPoint(), 0.02), allLinks())));
  PlanningSceneMessage change = diffScene();
  change.robot_state = stateMessage(free_state);
  change.robot_state.is_diff = false;
  ApplyPlanningScene::Request request;
  request.scene = change;
  const auto response = call<ApplyPlanningScene>("apply_planning_scene", request);
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_NE(std::string::npos, response.message.find("box")) << "the message warns: " << response.message;
  EXPECT_TRUE(scene().robot_state.attached_collision_objects.empty());
}

TEST_F(AttachedObjects, ARemoveWithoutANamePutsAllBack)
{
  apply(diffWith(attach(boxObject("a", tipPoint(), 0.02))));
  apply(diffWith(attach(boxObject("b", tipPoint(), 0.02))));
  apply(diffWith(attach(objectOperation("", CollisionObject::REMOVE))));
  EXPECT_TRUE(scene().robot_state.attached_collision_objects.empty());
  EXPECT_EQ(2u, scene().world.collision_objects.size());
}

TEST_F(AttachedObjects, WrongChangesAreRefusedAndChangeNothing)
{
  AttachedCollisionObject wrong = attach(boxObject("box", tipPoint(), 0.02));
  wrong.link_name = "no such link";
  expectRefusal(diffWith(wrong), "no such link");
  expectRefusal(diffWith(attach(objectOperation("no such object", CollisionObject::ADD))), "no such object");
  expectRefusal(diffWith(attach(objectOperation("no such object", CollisionObject::REMOVE))), "no such object");
}
}  // namespace
}  // namespace gpu_planning_scene::core
