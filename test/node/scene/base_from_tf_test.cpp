// The robot's pose by tf, while no state has set the virtual joint. No ROS master is needed.

#include <map>

#include <gtest/gtest.h>

#include "gpu_planning_scene/error.h"
#include "model/virtual_joint.h"
#include "node/scene/base_from_tf.h"
#include "node/scene/scene_services.h"
#include "scene/change_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::int64_t kSecond = 1000000000;

/// A robot on a virtual joint, and poses of its root link by time.
class BaseByTf : public testing::Test
{
 protected:
  void start(const std::string& joint_type)
  {
    robot_ = sliderRobotOnFloor(joint_type);
    base_ = std::make_unique<BaseFromTf>([this](const StampedFrame& frame) { return find(frame); },
                                         [this] { return now_; }, robot_);
    store_ = std::make_unique<SceneStore>(PlanningScene(robot_), SceneDefaults(), SceneLimits(),
                                          [this](std::int64_t stamp) { return base_->at(stamp); });
  }

  FrameLookup::Found find(const StampedFrame& frame) const
  {
    EXPECT_EQ("rail", frame.name) << "the root link";
    const auto found = frame.stamp == 0 ? poses_.rbegin() == poses_.rend() ? poses_.end() : std::prev(poses_.end())
                                        : poses_.find(frame.stamp);
    if (found == poses_.end())
      throw tf2::LookupException("no such frame");
    return {found->second, found->first};
  }

  /// The pose of the root link in a state.
  Eigen::Isometry3d rootPose(const std::vector<double>& state) const
  {
    std::vector<Eigen::Isometry3d> poses(robot_->links().size());
    robot_->linkPoses(state.data(), poses.data());
    return poses[static_cast<std::size_t>(robot_->linkIndex("rail"))];
  }

  void expectRootAt(const Eigen::Isometry3d& pose) const
  {
    EXPECT_TRUE(rootPose(store_->snapshot().state).isApprox(pose, 1e-12));
  }

  std::map<std::int64_t, Eigen::Isometry3d> poses_;  // by nanoseconds
  std::int64_t now_ = 10 * kSecond;
  std::shared_ptr<const RobotModel> robot_;
  std::unique_ptr<BaseFromTf> base_;
  std::unique_ptr<SceneStore> store_;
};

TEST_F(BaseByTf, SetsAPlanarOrFloatingVirtualJointAndFollowsTheRobot)
{
  for (const char* type : {"planar", "floating"})
  {
    poses_.clear();
    start(type);
    expectRootAt(Eigen::Isometry3d::Identity());
    const std::string assumed = store_->snapshot().assumedBase({});
    EXPECT_NE(assumed.find("is assumed at the origin"), std::string::npos);
    EXPECT_NE(assumed.find("tf has no transform from 'hall' to 'rail'"), std::string::npos) << assumed;
    poses_[now_] = poseAt(3.0, -1.0, 0.0, 0.5);
    expectRootAt(poseAt(3.0, -1.0, 0.0, 0.5));
    EXPECT_EQ("", store_->snapshot().assumedBase({}));
    poses_[now_ + 1] = poseAt(4.0, -1.0, 0.0, 1.5);
    expectRootAt(poseAt(4.0, -1.0, 0.0, 1.5));
    EXPECT_FALSE(store_->snapshot().known[static_cast<std::size_t>(virtualVariables(*robot_).front())])
        << "get_planning_scene reports only values that somebody supplied";
  }
}

TEST_F(BaseByTf, IsNotUsedOnceAStateHasSetTheVirtualJoint)
{
  start("planar");
  poses_[now_] = poseAt(3.0, 0.0, 0.0);
  store_->updateState({{"floor/x", 7.0}, {"floor/y", 0.0}, {"floor/theta", 0.0}});
  expectRootAt(poseAt(7.0, 0.0, 0.0));
  EXPECT_EQ("", store_->snapshot().assumedBase({}));
}

TEST_F(BaseByTf, MakesTheStateKnownForPointClouds)
{
  start("planar");
  store_->updateState({{"slide", 0.0}, {"turn", 0.0}});
  EXPECT_FALSE(store_->snapshot().allKnown()) << "at the origin, points on the robot cannot be removed";
  poses_[now_] = poseAt(3.0, 0.0, 0.0);
  EXPECT_TRUE(store_->snapshot().allKnown());
}

TEST_F(BaseByTf, IsThatOfTheTimeOfAStampIfTfHasIt)
{
  start("planar");
  poses_[now_ - kSecond] = poseAt(1.0, 0.0, 0.0);
  poses_[now_] = poseAt(2.0, 0.0, 0.0);
  EXPECT_NEAR(1.0, rootPose(store_->stateAt(now_ - kSecond)).translation().x(), 1e-12);
  EXPECT_THROW(store_->stateAt(now_ + 1), NotKnownYet) << "it may come: the robot may have moved since the newest pose";
  EXPECT_THROW(store_->stateAt(now_ - kSecond / 2), Error) << "tf has no pose of that time";
}

TEST_F(BaseByTf, IsNotThatOfATransformThatTfHasLost)
{
  start("planar");
  poses_[now_] = poseAt(2.0, 0.0, 0.0);
  expectRootAt(poseAt(2.0, 0.0, 0.0));
  poses_.clear();
  EXPECT_THROW(store_->stateAt(now_ + 1), NotKnownYet);
}

TEST_F(BaseByTf, IsRefusedForATimeThatTfHasForgotten)
{
  start("planar");
  poses_[now_] = poseAt(2.0, 0.0, 0.0);
  try
  {
    store_->stateAt(now_ - 5 * kSecond);
    ADD_FAILURE() << "the robot was elsewhere 5 s before";
  }
  catch (const Error& error)
  {
    EXPECT_STREQ("the robot's pose of 5 s before the newest transform from 'hall' to 'rail' is not available on tf",
                 error.what());
  }
}

TEST_F(BaseByTf, ThatIsOldOrLostIsUsedWithAWarning)
{
  start("floating");
  poses_[now_] = poseAt(1.0, 0.0, 0.0);
  now_ += kSecond / 2;
  EXPECT_EQ("", store_->snapshot().assumedBase({}));
  now_ += 2 * kSecond;
  EXPECT_NE(store_->snapshot().assumedBase({}).find("is 2.500000 s old"), std::string::npos)
      << store_->snapshot().assumedBase({});
  EXPECT_EQ("", store_->snapshot().endedVariable());
  now_ += kSecond;
  EXPECT_EQ("tf has brought no pose of the robot's base for 3.5 s, so the robot may be anywhere",
            store_->snapshot().endedVariable());
  EXPECT_EQ("", store_->snapshot().endedVariable(virtualVariables(*robot_))) << "a trajectory moves it";
  EXPECT_EQ("", store_->snapshot().assumedBase(virtualVariables(*robot_))) << "the request has its own value";
  expectRootAt(poseAt(1.0, 0.0, 0.0));
  poses_.clear();
  expectRootAt(poseAt(1.0, 0.0, 0.0));
  EXPECT_NE(store_->snapshot().assumedBase({}).find("has lost the transform"), std::string::npos);
  EXPECT_NE("", store_->snapshot().endedVariable());
  poses_[0] = poseAt(2.0, 0.0, 0.0);  // a static transform has no time
  EXPECT_EQ("", store_->snapshot().assumedBase({}));
  EXPECT_EQ("", store_->snapshot().endedVariable());
  expectRootAt(poseAt(2.0, 0.0, 0.0));
}

TEST_F(BaseByTf, OutsideOfThePlaneOfAPlanarJointIsProjectedWithAWarning)
{
  start("planar");
  poses_[now_] = poseAt(1.0, 2.0, 0.3, 0.7);
  expectRootAt(poseAt(1.0, 2.0, 0.0, 0.7));
  EXPECT_NE(store_->snapshot().assumedBase({}).find("leaves the plane"), std::string::npos);
}

TEST_F(BaseByTf, IsNoPartOfAPublishedChange)
{
  start("planar");
  poses_[now_] = poseAt(3.0, 0.0, 0.0);
  store_->updateState({{"slide", 0.5}, {"turn", 0.0}});
  SceneChange change;
  change.is_diff = true;
  change.state.variables = {{"slide", 0.25}, {"floor/x", 3.0}, {"floor/y", 0.0}, {"floor/theta", 0.0}};
  dropUnknown(store_->snapshot(), change);
  EXPECT_EQ((std::map<std::string, double>{{"slide", 0.25}}), change.state.variables);
}

TEST_F(BaseByTf, PlacesObjectsInLinkFrames)
{
  start("floating");
  poses_[now_] = poseAt(5.0, 0.0, 0.0);
  const MemoryGuard memory(0);
  SceneServices scenes(*store_, nullptr, memory);
  ApplyPlanningScene::Request add;
  add.scene.is_diff = add.scene.robot_state.is_diff = 1;
  add.scene.robot_state.joint_state.name = {"slide", "turn"};
  add.scene.robot_state.joint_state.position = {0.5, 0.0};
  CollisionObject ball;
  ball.id = "ball";
  ball.header.frame_id = "cart";
  ball.primitives.resize(1);
  ball.primitives[0].type = shape_msgs::SolidPrimitive::SPHERE;
  ball.primitives[0].dimensions = {0.1};
  add.scene.world.collision_objects = {ball};
  const auto response = scenes.apply(add);
  EXPECT_TRUE(response.success);
  EXPECT_EQ("", response.message);
  EXPECT_NEAR(5.5, store_->snapshot().scene->objects.at(0).pose.translation().x(), 1e-12);
}
}  // namespace
}  // namespace gpu_planning_scene::core
