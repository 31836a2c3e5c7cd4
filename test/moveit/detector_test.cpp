#include <cmath>
#include <limits>
#include <map>
#include <thread>

#include <geometric_shapes/shapes.h>
#include <gtest/gtest.h>
#include <moveit/planning_scene/planning_scene.h>
#include <moveit/utils/robot_model_test_utils.h>
#include <octomap/OcTree.h>

#include "gpu_planning_scene/moveit/collision_detector_allocator.h"
#include "moveit/moveit_resources.h"
#include "moveit/shapes.h"
#include "moveit/shapes/collision_shape.h"

// The behaviour of the detector for MoveIt, where MoveIt's own suites do not look.
namespace gpu_planning_scene::detector
{
namespace
{
using collision_detection::AllowedCollisionMatrix;
using collision_detection::CollisionRequest;
using collision_detection::CollisionResult;
using collision_detection::Contact;
using collision_detection::DistanceRequest;
using collision_detection::DistanceRequestType;
using collision_detection::DistanceResult;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using moveit::core::RobotModelPtr;
using moveit::core::RobotState;

/// A closed cube as a mesh.
shapes::ShapeConstPtr meshCube(double size)
{
  auto mesh = std::make_shared<shapes::Mesh>(8, 12);
  const double h = 0.5 * size;
  for (std::size_t i = 0; i < 8; ++i)
  {
    mesh->vertices[3 * i] = (i & 1u) != 0 ? h : -h;
    mesh->vertices[3 * i + 1] = (i & 2u) != 0 ? h : -h;
    mesh->vertices[3 * i + 2] = (i & 4u) != 0 ? h : -h;
  }
  const unsigned faces[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                              2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  std::copy_n(faces, 36, mesh->triangles);
  return mesh;
}

/// One link, a cube of 0.2 m at the origin of the planning frame, and a second one that a joint moves along x.
RobotModelPtr sliderRobot()
{
  moveit::core::RobotModelBuilder builder("slider", "base");
  geometry_msgs::Pose pose;
  pose.orientation.w = 1.0;
  builder.addChain("base->cart", "prismatic", {pose}, urdf::Vector3(1, 0, 0));
  builder.addCollisionBox("cart", {0.2, 0.2, 0.2}, pose);
  builder.addVirtualJoint("world", "base", "fixed", "root");
  builder.addGroupChain("base", "cart", "arm");
  return builder.build();
}

class Detector : public testing::Test
{
 protected:
  Detector() : robot_(sliderRobot()), env_(CollisionDetectorAllocator().allocateEnv(robot_)), state_(stateAt(0.0)) {}

  RobotState stateAt(double x) const
  {
    RobotState state(robot_);
    state.setToDefaultValues();
    state.setVariablePosition(0, x);
    state.update();
    return state;
  }

  void add(const std::string& name, const shapes::ShapeConstPtr& shape, const Isometry3d& pose)
  {
    env_->getWorld()->addToObject(name, pose, shape, Isometry3d::Identity());
  }

  bool collides(const AllowedCollisionMatrix* matrix = nullptr) const
  {
    CollisionResult result;
    if (matrix)
      env_->checkRobotCollision(CollisionRequest(), result, state_, *matrix);
    else
      env_->checkRobotCollision(CollisionRequest(), result, state_);
    return result.collision;
  }

  bool motionCollides(double from, double to, CollisionResult& result) const
  {
    CollisionRequest request;
    request.contacts = true;
    request.max_contacts = 10;
    env_->checkRobotCollision(request, result, stateAt(from), stateAt(to));
    return result.collision;
  }

  RobotModelPtr robot_;
  collision_detection::CollisionEnvPtr env_;
  RobotState state_;
};

TEST_F(Detector, FindsALinkInsideAClosedMesh)
{
  add("shell", meshCube(1.0), Isometry3d::Identity());
  EXPECT_TRUE(collides());
}

TEST_F(Detector, CountsTouchingAsACollision)
{
  add("box", box(0.2), at(0.2, 0, 0));
  EXPECT_TRUE(collides());
  env_->getWorld()->setObjectPose("box", at(0.2 + 2e-9, 0, 0));
  EXPECT_FALSE(collides());
}

TEST_F(Detector, TakesPaddingAsADistance)
{
  // The corners of the cubes are 0.1 m apart along each axis, so the distance is 0.1 times the root of 3.
  add("box", box(0.2), at(0.3, 0.3, 0.3));
  env_->setLinkPadding("cart", 0.1 * std::sqrt(3.0) - 1e-6);
  EXPECT_FALSE(collides());
  env_->setLinkPadding("cart", 0.1 * std::sqrt(3.0) + 1e-6);
  EXPECT_TRUE(collides());
  env_->setPadding(0.0);
  EXPECT_FALSE(collides());
}

TEST_F(Detector, ScalesLinks)
{
  add("box", box(0.2), at(0.35, 0, 0));
  EXPECT_FALSE(collides());
  env_->setLinkScale("cart", 2.6);
  EXPECT_TRUE(collides());
  env_->setLinkScale("cart", 2.4);
  EXPECT_FALSE(collides());
}

TEST_F(Detector, TakesPlanesAsHalfSpaces)
{
  add("floor", std::make_shared<shapes::Plane>(0, 0, 1, 1), Isometry3d::Identity());  // z <= -1
  EXPECT_FALSE(collides());
  add("above", std::make_shared<shapes::Plane>(0, 0, 1, -1), Isometry3d::Identity());  // z <= 1
  EXPECT_TRUE(collides());
}

TEST_F(Detector, FollowsTheWorld)
{
  add("box", box(0.2), at(1, 0, 0));
  EXPECT_FALSE(collides());
  env_->getWorld()->moveObject("box", at(-0.9, 0, 0));
  EXPECT_TRUE(collides());
  env_->getWorld()->setObjectPose("box", at(5, 0, 0));
  EXPECT_FALSE(collides());
  env_->getWorld()->addToObject("box", box(0.2), at(-5, 0, 0));
  EXPECT_TRUE(collides());
  env_->getWorld()->removeObject("box");
  EXPECT_FALSE(collides());
}

TEST_F(Detector, FindsEachObjectOfALargeWorldThatChanges)
{
  // Enough objects for a tree, which is built anew several times.
  for (int i = 0; i < 300; ++i)
  {
    add("box" + std::to_string(i), box(0.1), at(1.0 + 0.2 * i, 0, 0));
    ASSERT_FALSE(collides()) << i;
  }
  for (int i = 0; i < 300; ++i)
  {
    const std::string name = "box" + std::to_string(i);
    env_->getWorld()->setObjectPose(name, Isometry3d::Identity());
    ASSERT_TRUE(collides()) << i;
    if (i % 3 == 0)
      env_->getWorld()->removeObject(name);
    else
      env_->getWorld()->setObjectPose(name, at(1.0 + 0.2 * i, 0, 0));
    ASSERT_FALSE(collides()) << i;
  }
}

TEST_F(Detector, ReadsAnOctreeThatChangesInPlace)
{
  const auto octree = std::make_shared<octomap::OcTree>(0.05);
  octree->updateNode(octomap::point3d(1.0F, 0, 0), true);
  add("<octomap>", std::make_shared<shapes::OcTree>(octree), Isometry3d::Identity());
  EXPECT_FALSE(collides());
  octree->updateNode(octomap::point3d(0.11F, 0, 0), true);
  EXPECT_TRUE(collides());  // the cell from 0.1 to 0.15 touches the cart
  for (int i = 0; i < 10; ++i)
    octree->updateNode(octomap::point3d(0.11F, 0, 0), false);
  EXPECT_FALSE(collides());
}

TEST_F(Detector, ReadsAnOctreeWhoseResolutionChangesInPlace)
{
  const auto octree = std::make_shared<octomap::OcTree>(0.05);
  octree->updateNode(octomap::point3d(1.0F, 0, 0), true);
  add("<octomap>", std::make_shared<shapes::OcTree>(octree), Isometry3d::Identity());
  EXPECT_FALSE(collides());
  octree->clear();
  octree->setResolution(0.4);
  octree->updateNode(octomap::point3d(0.3F, 0.3F, 0.3F), true);  // a cube from 0 to 0.4
  EXPECT_TRUE(collides());
}

TEST_F(Detector, ChecksALeafOfAnOctreeAtItsSizeAndPlace)
{
  const auto octree = std::make_shared<octomap::OcTree>(0.1);
  for (const float x : {0.05F, 0.15F})
    for (const float y : {0.05F, 0.15F})
      for (const float z : {0.05F, 0.15F})
        octree->updateNode(octomap::point3d(x, y, z), true);
  octree->prune();
  ASSERT_EQ(octree->getNumLeafNodes(), 1U);  // the cube from 0 to 0.2
  add("<octomap>", std::make_shared<shapes::OcTree>(octree), at(-0.299, 0, 0));
  EXPECT_TRUE(collides());
  // After half a turn about z, the cube reaches from -0.2 to 0 along x.
  Isometry3d turned = at(0.3 - 0.001, 0, 0);
  turned.rotate(Eigen::AngleAxisd(M_PI, Vector3d::UnitZ()));
  env_->getWorld()->setObjectPose("<octomap>", turned);
  EXPECT_TRUE(collides());
  turned.translation().x() = 0.3 + 0.001;
  env_->getWorld()->setObjectPose("<octomap>", turned);
  EXPECT_FALSE(collides());
  env_->getWorld()->setObjectPose("<octomap>", at(-0.301, 0, 0));
  EXPECT_FALSE(collides());
  state_ = stateAt(2.0);
  EXPECT_FALSE(collides());
  turned.translation().x() = 2.3 - 0.001;
  env_->getWorld()->setObjectPose("<octomap>", turned);
  EXPECT_TRUE(collides());
}

TEST_F(Detector, GivesNoDistanceToAnOctreeWithoutOccupiedLeaves)
{
  add("<octomap>", std::make_shared<shapes::OcTree>(std::make_shared<octomap::OcTree>(0.05)), Isometry3d::Identity());
  collision_detection::DistanceRequest request;
  request.enable_nearest_points = true;
  request.type = collision_detection::DistanceRequestType::ALL;
  collision_detection::DistanceResult result;
  env_->distanceRobot(request, result, state_);
  EXPECT_TRUE(result.distances.empty());
  EXPECT_FALSE(result.collision);
}

TEST_F(Detector, NoticesAShapeThatIsScaledInPlace)
{
  auto shape = std::make_shared<shapes::Box>(0.05, 0.05, 0.05);
  add("box", shape, at(0.2, 0, 0));
  EXPECT_FALSE(collides());
  shape->scale(10.0);
  env_->getWorld()->removeObject("box");
  add("box", shape, at(0.2, 0, 0));
  EXPECT_TRUE(collides());
}

TEST_F(Detector, CountsANegativePaddingAsNone)
{
  add("cube", meshCube(0.2), at(0.15, 0.05, 0.05));
  EXPECT_TRUE(collides());
  env_->setLinkPadding("cart", -0.5);
  EXPECT_TRUE(collides());
  env_->getWorld()->setObjectPose("cube", at(0.3, 0.05, 0.05));
  EXPECT_FALSE(collides());
}

TEST_F(Detector, GivesTheDistanceToAnOctree)
{
  const auto octree = std::make_shared<octomap::OcTree>(0.05);
  octree->updateNode(octomap::point3d(1.01F, 0.01F, 0.01F), true);
  octree->updateNode(octomap::point3d(0.51F, 0.01F, 0.01F), true);
  add("<octomap>", std::make_shared<shapes::OcTree>(octree), Isometry3d::Identity());
  EXPECT_NEAR(env_->distanceRobot(state_), 0.4, 2e-6);
}

TEST_F(Detector, AsksTheDeciderOfAPair)
{
  add("box", box(0.2), at(0.19, 0, 0));
  AllowedCollisionMatrix matrix;
  int asked = 0;
  bool answer = true;
  matrix.setEntry("box", "cart",
                  [&](Contact& contact)
                  {
                    ++asked;
                    EXPECT_NEAR(contact.depth, 0.01, 1e-6);
                    EXPECT_EQ(contact.body_name_1, "box");
                    EXPECT_EQ(contact.body_name_2, "cart");
                    EXPECT_EQ(contact.body_type_1, collision_detection::BodyTypes::WORLD_OBJECT);
                    EXPECT_EQ(contact.body_type_2, collision_detection::BodyTypes::ROBOT_LINK);
                    EXPECT_NEAR(contact.normal.x(), -1.0, 1e-6);  // from the box to the cart
                    // The deepest points of both bodies: that of the box is inside the cart.
                    EXPECT_NEAR(contact.nearest_points[0].x(), 0.09, 1e-6);
                    EXPECT_NEAR(contact.nearest_points[1].x(), 0.1, 1e-6);
                    return answer;
                  });
  EXPECT_FALSE(collides(&matrix));
  EXPECT_GT(asked, 0);
  answer = false;
  EXPECT_TRUE(collides(&matrix));
}

TEST_F(Detector, AsksTheDeciderOfEachContactOfAPair)
{
  add("cube", meshCube(0.2), at(0.15, 0.05, 0.05));
  int asked = 0;
  int refused = 0;
  AllowedCollisionMatrix matrix;
  matrix.setEntry("cube", "cart", [&](Contact&) { return ++asked != refused; });
  EXPECT_FALSE(collides(&matrix));
  const int contacts = asked;
  ASSERT_GT(contacts, 1);
  for (refused = 1; refused <= contacts; ++refused)
  {
    asked = 0;
    EXPECT_TRUE(collides(&matrix)) << "contact " << refused << " is refused";
  }
}

TEST_F(Detector, APairWithContactsThatAreNotComputedCollidesWhateverTheDeciderSays)
{
  AllowedCollisionMatrix matrix;
  const collision_detection::DecideContactFn accept = [](Contact&) { return true; };
  matrix.setEntry("<octomap>", "cart", accept);
  const auto octree = std::make_shared<octomap::OcTree>(0.02);
  octree->updateNode(octomap::point3d(0.01F, 0.01F, 0.01F), true);
  add("<octomap>", std::make_shared<shapes::OcTree>(octree), Isometry3d::Identity());
  EXPECT_TRUE(collides());
  EXPECT_FALSE(collides(&matrix));
  env_->getWorld()->removeObject("<octomap>");
  // Every second leaf, so that the octree does not join them.
  for (int x = -4; x <= 4; ++x)
    for (int y = -4; y <= 4; ++y)
      for (int z = -4; z <= 4; ++z)
        if ((x + y + z) % 2 == 0)
          octree->updateNode(
              octomap::point3d(0.02F * static_cast<float>(x) + 0.01F, 0.02F * static_cast<float>(y) + 0.01F,
                               0.02F * static_cast<float>(z) + 0.01F),
              true);
  add("<octomap>", std::make_shared<shapes::OcTree>(octree), Isometry3d::Identity());
  EXPECT_TRUE(collides(&matrix)) << "it might refuse one of the contacts that it has not seen";
}

TEST_F(Detector, FollowsDefaultEntriesOfTheMatrix)
{
  add("box", box(0.2), Isometry3d::Identity());
  AllowedCollisionMatrix matrix;
  EXPECT_TRUE(collides(&matrix));
  matrix.setDefaultEntry("box", true);
  EXPECT_FALSE(collides(&matrix));
  matrix.setEntry("box", "cart", false);
  EXPECT_TRUE(collides(&matrix));
}

TEST_F(Detector, CountsAShapeThatCannotBeCheckedAsColliding)
{
  add("unknown", std::make_shared<shapes::Box>(0.1, 0.1, std::numeric_limits<double>::quiet_NaN()), at(5, 0, 0));
  EXPECT_TRUE(collides());
  env_->getWorld()->removeObject("unknown");
  auto mesh = std::make_shared<shapes::Mesh>(3, 1);
  std::fill_n(mesh->vertices, 9, std::numeric_limits<double>::quiet_NaN());
  std::fill_n(mesh->triangles, 3, 0U);
  add("mesh", mesh, at(5, 0, 0));
  EXPECT_TRUE(collides());
  AllowedCollisionMatrix matrix;
  matrix.setEntry("mesh", "cart", true);
  EXPECT_FALSE(collides(&matrix));
}

TEST_F(Detector, ConvertsAShapeThatCannotBeCheckedOnce)
{
  const auto ball = std::make_shared<const shapes::Sphere>(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(collisionShapeOf(ball, 1.0, "ball"), collisionShapeOf(ball, 1.0, "ball"));
}

TEST_F(Detector, CountsAStateThatIsNotFiniteAsColliding)
{
  add("box", box(0.1), at(5, 0, 0));
  state_ = stateAt(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(collides());
}

TEST_F(Detector, CountsAnObjectAtNoPlaceAsColliding)
{
  add("box", box(0.1), at(std::numeric_limits<double>::quiet_NaN(), 0, 0));
  EXPECT_TRUE(collides());
  env_->getWorld()->setObjectPose("box", at(5, 0, 0));
  EXPECT_FALSE(collides());
}

TEST_F(Detector, UpdatesAStateThatIsNotUpToDate)
{
  add("box", box(0.2), at(0.5, 0, 0));
  state_.setVariablePosition(0, 0.5);  // without update()
  EXPECT_TRUE(collides());
}

TEST_F(Detector, ChecksAttachedObjectsAgainstTheirOwnLink)
{
  AllowedCollisionMatrix matrix;
  CollisionResult result;
  const std::vector<shapes::ShapeConstPtr> cube = {box(0.2)};
  const EigenSTL::vector_Isometry3d poses = {Isometry3d::Identity()};
  state_.attachBody("tool", at(0.1, 0, 0), cube, poses, std::vector<std::string>(), "cart");
  state_.update();
  env_->checkSelfCollision(CollisionRequest(), result, state_, matrix);
  EXPECT_TRUE(result.collision);
  state_.clearAttachedBodies();
  state_.attachBody("tool", at(0.1, 0, 0), cube, poses, std::vector<std::string>{"cart"}, "cart");
  state_.update();
  result.clear();
  env_->checkSelfCollision(CollisionRequest(), result, state_, matrix);
  EXPECT_FALSE(result.collision);
  add("box", box(0.2), at(0.28, 0, 0));  // meets the tool, not the cart
  EXPECT_TRUE(collides());
}

TEST_F(Detector, PadsAndScalesWhatALinkCarries)
{
  state_.attachBody("tool", at(0, 0.5, 0), std::vector<shapes::ShapeConstPtr>{box(0.2)},
                    EigenSTL::vector_Isometry3d{Isometry3d::Identity()}, std::vector<std::string>{"cart"}, "cart");
  state_.update();
  add("box", box(0.2), at(0.25, 0.5, 0));  // 0.05 m from the tool
  EXPECT_FALSE(collides());
  env_->setLinkPadding("cart", 0.051);
  EXPECT_TRUE(collides());
  env_->setLinkPadding("cart", 0.0);
  env_->setLinkScale("cart", 1.51);
  EXPECT_TRUE(collides());
  env_->setLinkScale("cart", 1.49);
  EXPECT_FALSE(collides());
}

TEST_F(Detector, ChecksAllShapesOfWhatALinkCarries)
{
  state_.attachBody("tool", at(0, 0.5, 0), std::vector<shapes::ShapeConstPtr>{box(0.1), box(0.1)},
                    EigenSTL::vector_Isometry3d{Isometry3d::Identity(), at(0, 1.0, 0)},
                    std::vector<std::string>{"cart"}, "cart");
  state_.update();
  add("box", box(0.1), at(0, 1.5, 0));
  EXPECT_TRUE(collides());
  env_->getWorld()->setObjectPose("box", at(0, 1.0, 0));  // between the two
  EXPECT_FALSE(collides());
}

TEST_F(Detector, DoesNotCheckObjectsOnOneLinkAgainstEachOther)
{
  const AllowedCollisionMatrix matrix;
  const std::vector<shapes::ShapeConstPtr> cube = {box(0.2)};
  const EigenSTL::vector_Isometry3d poses = {Isometry3d::Identity()};
  const std::vector<std::string> touch_links = {"cart"};
  state_.attachBody("tool", at(0.3, 0, 0), cube, poses, touch_links, "cart");
  state_.attachBody("part", at(0.4, 0, 0), cube, poses, touch_links, "cart");
  state_.update();
  CollisionResult result;
  env_->checkSelfCollision(CollisionRequest(), result, state_, matrix);
  EXPECT_FALSE(result.collision);
  state_.clearAttachedBody("part");
  state_.attachBody("part", at(0.4, 0, 0), cube, poses, touch_links, "base");
  state_.update();
  env_->checkSelfCollision(CollisionRequest(), result, state_, matrix);
  EXPECT_TRUE(result.collision);
}

TEST_F(Detector, ReadsAnotherWorld)
{
  add("old", box(0.2), Isometry3d::Identity());
  const auto world = std::make_shared<collision_detection::World>();
  world->addToObject("new", at(1, 0, 0), box(0.2), Isometry3d::Identity());
  env_->setWorld(world);
  EXPECT_FALSE(collides()) << "with the old world";
  state_ = stateAt(1.0);
  EXPECT_TRUE(collides());
  world->removeObject("new");
  EXPECT_FALSE(collides());
}

TEST_F(Detector, ChecksTheRobotAgainstItselfForThePairsOfAGroupAlone)
{
  moveit::core::RobotModelBuilder builder("two_carts", "base");
  geometry_msgs::Pose pose;
  pose.orientation.w = 1.0;
  builder.addVirtualJoint("world", "base", "fixed", "root");
  for (const char* cart : {"left", "right"})
  {
    builder.addChain(std::string("base->") + cart, "prismatic", {pose}, urdf::Vector3(1, 0, 0));
    builder.addCollisionBox(cart, {0.2, 0.2, 0.2}, pose);
    builder.addGroupChain("base", cart, std::string(cart) + "_arm");
  }
  builder.addCollisionBox("base", {0.1, 0.1, 0.1}, pose);
  const RobotModelPtr robot = builder.build();
  const auto env = CollisionDetectorAllocator().allocateEnv(robot);
  RobotState state(robot);
  state.setToDefaultValues();
  state.setVariablePosition(robot->getJointModel("base-left-joint")->getFirstVariableIndex(), 1.0);
  state.update();
  const AllowedCollisionMatrix matrix;  // the right cart is in the base
  for (const auto& [group, expected] :
       std::map<std::string, bool>{{"", true}, {"right_arm", true}, {"left_arm", false}})
  {
    CollisionRequest request;
    request.group_name = group;
    CollisionResult result;
    env->checkSelfCollision(request, result, state, matrix);
    EXPECT_EQ(result.collision, expected) << "group '" << group << "'";
    DistanceRequest distance;
    distance.group_name = group;
    distance.acm = &matrix;
    distance.enableGroup(robot);
    DistanceResult measured;
    env->distanceSelf(distance, measured, state);
    EXPECT_EQ(measured.collision, expected) << "group '" << group << "'";
  }
}

TEST_F(Detector, RefusesAMotionDuringWhichTheRobotPicksSomethingUp)
{
  add("box", box(0.2), at(0.0, 1.0, 0));
  RobotState to = stateAt(1.0);
  CollisionResult result;
  env_->checkRobotCollision(CollisionRequest(), result, state_, to);
  EXPECT_FALSE(result.collision);
  to.attachBody("tool", at(0, -0.3, 0), std::vector<shapes::ShapeConstPtr>{box(0.1)},
                EigenSTL::vector_Isometry3d{Isometry3d::Identity()}, std::vector<std::string>{"cart"}, "cart");
  to.update();
  env_->checkRobotCollision(CollisionRequest(), result, state_, to);
  EXPECT_TRUE(result.collision);
}

TEST_F(Detector, ChecksTheObjectsOfBothStatesAlongAMotion)
{
  add("box", box(0.2), at(0.5, 0.5, 0));
  const auto carrying = [this](double x, double y)
  {
    RobotState state = stateAt(x);
    state.attachBody("tool", at(0, y, 0), std::vector<shapes::ShapeConstPtr>{box(0.1)},
                     EigenSTL::vector_Isometry3d{Isometry3d::Identity()}, std::vector<std::string>{"cart"}, "cart");
    state.update();
    return state;
  };
  const auto motion_collides = [this](const RobotState& from, const RobotState& to)
  {
    CollisionResult result;
    env_->checkRobotCollision(CollisionRequest(), result, from, to);
    return result.collision;
  };
  EXPECT_FALSE(motion_collides(carrying(0.0, -0.3), carrying(1.0, -0.3)));
  // The tool passes the box at the place that it has in one of the states.
  EXPECT_TRUE(motion_collides(carrying(0.0, 0.5), carrying(1.0, -0.3)));
  EXPECT_TRUE(motion_collides(carrying(0.0, -0.3), carrying(1.0, 0.5)));
}

TEST_F(Detector, GivesAtMostTheRequestedContactsOfAPair)
{
  for (const double x : {0.15, -0.15})
    add("cube" + std::to_string(x), meshCube(0.2), at(x, 0.05, 0.05));
  const auto contacts_with = [this](std::size_t in_all, std::size_t per_pair)
  {
    CollisionRequest request;
    request.contacts = true;
    request.max_contacts = in_all;
    request.max_contacts_per_pair = per_pair;
    CollisionResult result;
    env_->checkRobotCollision(request, result, state_);
    std::size_t most = 0;
    for (const auto& [pair, contacts] : result.contacts)
      most = std::max(most, contacts.size());
    return std::make_pair(result.contact_count, most);
  };
  EXPECT_GT(contacts_with(100, 100).second, 2u);
  EXPECT_EQ(contacts_with(100, 2).second, 2u);
  EXPECT_EQ(contacts_with(2, 100).first, 2u);
}

TEST_F(Detector, KeepsTheSmallestDistanceOfSeveralChecks)
{
  add("box", box(0.2), at(0.5, 0, 0));
  CollisionRequest request;
  request.distance = true;
  CollisionResult result;
  env_->checkRobotCollision(request, result, state_);
  EXPECT_NEAR(result.distance, 0.3, 2e-6);
  env_->checkRobotCollision(request, result, stateAt(-0.5));
  EXPECT_NEAR(result.distance, 0.3, 2e-6);
}

TEST_F(Detector, GivesTheDetailsOfADistanceOnRequest)
{
  add("box", box(0.2), at(0.5, 0, 0));
  CollisionRequest request;
  request.distance = request.detailed_distance = true;
  CollisionResult result;
  env_->checkRobotCollision(request, result, state_);
  EXPECT_EQ(result.distance_result.minimum_distance.link_names[1], "box");
  EXPECT_NEAR(result.distance_result.minimum_distance.distance, 0.3, 2e-6);
}

TEST_F(Detector, GivesNoDistanceOfAllowedPairs)
{
  add("near", box(0.2), at(0.5, 0, 0));
  add("far", box(0.2), at(-1.0, 0, 0));
  AllowedCollisionMatrix matrix;
  matrix.setEntry("near", "cart", true);
  DistanceRequest request;
  request.acm = &matrix;
  DistanceResult result;
  env_->distanceRobot(request, result, state_);
  EXPECT_NEAR(result.minimum_distance.distance, 0.8, 2e-6);
}

TEST_F(Detector, GivesNearestPointsOnThePaddedSurface)
{
  add("box", box(0.2), at(0.5, 0, 0));
  env_->setLinkPadding("cart", 0.05);
  DistanceRequest request;
  request.enable_nearest_points = true;
  DistanceResult result;
  env_->distanceRobot(request, result, state_);
  EXPECT_NEAR(result.minimum_distance.distance, 0.25, 2e-6);
  EXPECT_NEAR(result.minimum_distance.nearest_points[0].x(), 0.15, 1e-4);
  EXPECT_NEAR(result.minimum_distance.nearest_points[1].x(), 0.4, 1e-4);
}

TEST_F(Detector, GivesTheDepthOfTheDeepestLeafOfAnOctree)
{
  const auto octree = std::make_shared<octomap::OcTree>(0.1);
  octree->updateNode(octomap::point3d(0.15F, 0.05F, 0.05F), true);   // from 0.1 along x
  octree->updateNode(octomap::point3d(-0.15F, 0.05F, 0.05F), true);  // to -0.1
  add("<octomap>", std::make_shared<shapes::OcTree>(octree), at(-0.01, 0, 0));
  DistanceRequest request;
  request.enable_signed_distance = true;
  env_->setLinkPadding("cart", 0.05);
  for (const double x : {0.0, -0.03})
  {
    DistanceResult result;
    env_->distanceRobot(request, result, stateAt(x));
    // One leaf begins at 0.09, the other one ends at -0.11. The padded cart reaches from x - 0.15 to x + 0.15.
    EXPECT_NEAR(result.minimum_distance.distance, -std::max(x + 0.06, 0.04 - x), 1e-6) << x;
  }
}

TEST_F(Detector, GivesTheNormalOfACarriedOctree)
{
  const auto octree = std::make_shared<octomap::OcTree>(0.1);
  octree->updateNode(octomap::point3d(0.05F, 0.05F, 0.05F), true);
  state_.attachBody("octree", at(1.0, 0, 0),
                    std::vector<shapes::ShapeConstPtr>{std::make_shared<shapes::OcTree>(octree)},
                    EigenSTL::vector_Isometry3d{Isometry3d::Identity()}, std::vector<std::string>{"cart"}, "cart");
  state_.update();
  add("box", box(0.1), at(1.14, 0.05, 0.05));  // behind the leaf, which ends at 1.1
  CollisionRequest request;
  request.contacts = true;
  CollisionResult result;
  env_->checkRobotCollision(request, result, state_);
  ASSERT_EQ(result.contacts.count({"box", "octree"}), 1U);
  EXPECT_NEAR((result.contacts.at({"box", "octree"}).front().normal.x()), -1.0, 1e-6);
}

TEST_F(Detector, TakesTheWorldThatItIsMadeWith)
{
  const auto world = std::make_shared<collision_detection::World>();
  world->addToObject("box", Isometry3d::Identity(), box(0.2), Isometry3d::Identity());
  env_ = CollisionDetectorAllocator().allocateEnv(world, robot_);
  EXPECT_TRUE(collides());
}

TEST_F(Detector, GivesDistancesPerPairAndNearestPoints)
{
  add("near", box(0.2), at(0.5, 0, 0));
  add("far", box(0.2), at(-1.0, 0, 0));
  DistanceRequest request;
  request.type = DistanceRequestType::SINGLE;
  request.enable_nearest_points = true;
  DistanceResult result;
  env_->distanceRobot(request, result, state_);
  ASSERT_EQ(result.distances.size(), 2u);
  EXPECT_NEAR((result.distances.at({"cart", "near"}).front().distance), 0.3, 2e-6);
  EXPECT_NEAR((result.distances.at({"cart", "far"}).front().distance), 0.8, 2e-6);
  EXPECT_EQ(result.minimum_distance.link_names[0], "cart");
  EXPECT_NEAR(result.minimum_distance.nearest_points[0].x(), 0.1, 1e-4);
  EXPECT_NEAR(result.minimum_distance.nearest_points[1].x(), 0.4, 1e-4);
  EXPECT_NEAR(result.minimum_distance.normal.x(), 1.0, 1e-4);
  request.distance_threshold = 0.5;
  result.clear();
  env_->distanceRobot(request, result, state_);
  EXPECT_EQ(result.distances.size(), 1u);
}

TEST_F(Detector, LimitsTheDistancesOfAPair)
{
  for (int i = 0; i < 5; ++i)
    env_->getWorld()->addToObject("boxes", box(0.1), at(0.5 + 0.2 * i, 0, 0));
  DistanceRequest request;
  request.max_contacts_per_body = 2;
  for (const auto& [type, count] : {std::pair(DistanceRequestType::SINGLE, 1),
                                    std::pair(DistanceRequestType::LIMITED, 2), std::pair(DistanceRequestType::ALL, 5)})
  {
    request.type = type;
    DistanceResult result;
    env_->distanceRobot(request, result, state_);
    const auto& found = result.distances.at({"boxes", "cart"});
    EXPECT_EQ(found.size(), static_cast<std::size_t>(count));
    EXPECT_NEAR(found.front().distance, 0.35, 2e-6);
  }
}

TEST_F(Detector, SortsTheDistancesOfAPairAlsoIfTheBoxesOfItsShapesHaveAnotherOrder)
{
  // The box around the ball is nearer to the cart than the cube is, and the ball is farther.
  env_->getWorld()->addToObject("shapes", std::make_shared<shapes::Sphere>(0.3), at(0.5, 0.5, 0));
  env_->getWorld()->addToObject("shapes", box(0.1), at(0.35, 0, 0));
  const double to_ball = 0.4 * std::sqrt(2.0) - 0.3;
  DistanceRequest request;
  request.type = DistanceRequestType::ALL;
  DistanceResult result;
  env_->distanceRobot(request, result, state_);
  const std::pair<std::string, std::string> pair("cart", "shapes");
  ASSERT_EQ(result.distances.at(pair).size(), 2U);
  EXPECT_NEAR(result.distances.at(pair)[0].distance, 0.2, 2e-6);
  EXPECT_NEAR(result.distances.at(pair)[1].distance, to_ball, 2e-6);
  request.type = DistanceRequestType::SINGLE;
  result.clear();
  env_->distanceRobot(request, result, state_);
  ASSERT_EQ(result.distances.at(pair).size(), 1U);
  EXPECT_NEAR(result.distances.at(pair)[0].distance, 0.2, 2e-6);
}

TEST_F(Detector, GivesTheDepthAsANegativeDistance)
{
  add("box", box(0.2), at(0.17, 0, 0));
  DistanceRequest request;
  DistanceResult result;
  env_->distanceRobot(request, result, state_);
  EXPECT_TRUE(result.collision);
  EXPECT_EQ(result.minimum_distance.distance, 0.0);
  request.enable_signed_distance = true;
  result.clear();
  env_->distanceRobot(request, result, state_);
  EXPECT_NEAR(result.minimum_distance.distance, -0.03, 1e-6);
}

TEST_F(Detector, ReportsCostsAndStopsWhenAsked)
{
  for (int i = 0; i < 5; ++i)
    add("box" + std::to_string(i), box(0.2), at(0.15, 0.001 * i, 0));
  CollisionRequest request;
  request.cost = true;
  request.max_cost_sources = 3;
  CollisionResult result;
  env_->checkRobotCollision(request, result, state_);
  EXPECT_EQ(result.cost_sources.size(), 3u);
  EXPECT_NEAR(result.cost_sources.begin()->getVolume(), 0.05 * 0.2 * 0.2, 1e-6);
  request = CollisionRequest();
  request.contacts = true;
  request.max_contacts = 100;
  request.is_done = [](const CollisionResult& found) { return found.contacts.size() == 2; };
  result.clear();
  env_->checkRobotCollision(request, result, state_);
  EXPECT_EQ(result.contacts.size(), 2u);
}

TEST_F(Detector, FindsAMotionThroughAnObject)
{
  add("wall", std::make_shared<shapes::Box>(0.01, 1.0, 1.0), at(0.5, 0, 0));
  CollisionResult result;
  EXPECT_TRUE(motionCollides(0.0, 1.0, result));
  ASSERT_EQ(result.contacts.size(), 1u);
  const Contact& contact = result.contacts.begin()->second.front();
  EXPECT_GE(contact.percent_interpolation, 0.39);
  EXPECT_LE(contact.percent_interpolation, 0.61);
  result.clear();
  EXPECT_FALSE(motionCollides(0.0, 0.39, result));
}

TEST_F(Detector, FindsAMotionThroughAThinObjectAtEachPlace)
{
  for (int i = 1; i < 40; ++i)
  {
    const double x = 0.025 * i;
    add("wall", std::make_shared<shapes::Box>(1e-3, 1.0, 1.0), at(x, 0, 0));
    CollisionResult result;
    EXPECT_TRUE(motionCollides(0.0, 1.0, result)) << x;
    AllowedCollisionMatrix matrix;
    matrix.setEntry("wall", "cart", true);
    result.clear();
    env_->checkRobotCollision(CollisionRequest(), result, stateAt(0.0), stateAt(1.0), matrix);
    EXPECT_FALSE(result.collision) << "allowed, at " << x;
    env_->getWorld()->removeObject("wall");
  }
}

TEST_F(Detector, ProvesAMotionAlongAnObjectButNotOneThatPassesWithinMicrometres)
{
  add("wall", box(1.0), at(0.5, 0.6 + 1e-3, 0));
  CollisionResult result;
  EXPECT_FALSE(motionCollides(0.0, 1.0, result));
  env_->getWorld()->setObjectPose("wall", at(0.5, 0.6 + 1e-6, 0));
  EXPECT_TRUE(motionCollides(0.0, 1.0, result));
}

TEST_F(Detector, CopiesDoNotSeeLaterChangesOfEachOther)
{
  add("box", box(0.2), at(5, 0, 0));
  const auto world = std::make_shared<collision_detection::World>(*env_->getWorld());
  const auto copy = CollisionDetectorAllocator().allocateEnv(env_, world);
  env_->getWorld()->setObjectPose("box", Isometry3d::Identity());
  EXPECT_TRUE(collides());
  CollisionResult result;
  copy->checkRobotCollision(CollisionRequest(), result, state_);
  EXPECT_FALSE(result.collision);
  world->addToObject("other", Isometry3d::Identity(), box(0.1), Isometry3d::Identity());
  copy->checkRobotCollision(CollisionRequest(), result, state_);
  EXPECT_TRUE(result.collision);
}

TEST_F(Detector, AnswersSeveralThreadsAtOnce)
{
  for (int i = 0; i < 200; ++i)
    add("box" + std::to_string(i), i % 2 == 0 ? box(0.1) : meshCube(0.1), at(0.5 + 0.2 * i, 0, 0));
  std::vector<std::thread> threads;
  std::vector<int> hits(4);
  for (std::size_t t = 0; t < hits.size(); ++t)
    threads.emplace_back(
        [&, t]
        {
          for (int i = 0; i < 500; ++i)
          {
            CollisionResult result;
            env_->checkRobotCollision(CollisionRequest(), result, stateAt(i % 2 == 0 ? 0.0 : 0.5 + 0.2 * (i % 200)));
            hits[t] += result.collision ? 1 : 0;
          }
        });
  for (std::thread& thread : threads)
    thread.join();
  for (const int count : hits)
    EXPECT_EQ(count, 250);
}

TEST(DetectorScene, ReplacesTheDetectorOfAPlanningScene)
{
  ASSERT_TRUE(kUsesMoveItResources);
  const auto shared = std::make_shared<planning_scene::PlanningScene>(moveit::core::loadTestingRobotModel("panda"));
  planning_scene::PlanningScene& scene = *shared;
  scene.setActiveCollisionDetector(CollisionDetectorAllocator::create(), true);
  EXPECT_EQ(scene.getActiveCollisionDetectorName(), "gpu_planning_scene");
  RobotState& state = scene.getCurrentStateNonConst();
  state.setToDefaultValues(state.getJointModelGroup("panda_arm"), "ready");
  state.update();
  EXPECT_FALSE(scene.isStateColliding(state, "panda_arm"));
  scene.getWorldNonConst()->addToObject("box", at(0.3, 0, 0.6), box(0.1), Isometry3d::Identity());
  const planning_scene::PlanningScenePtr difference = scene.diff();
  EXPECT_TRUE(difference->isStateColliding(state, "panda_arm"));
}
}  // namespace
}  // namespace gpu_planning_scene::detector
