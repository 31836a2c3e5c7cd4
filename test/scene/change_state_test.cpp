// The robot's state in a change: when it replaces the attached objects and when it keeps them.

#include "scene/change_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
class ChangeState : public SceneChanges
{
 protected:
  ChangeState()
  {
    change(attachedChange(Operation::Add, "a", "pole", {boxAt(0.1)}));
    change(attachedChange(Operation::Add, "b", "cart", {boxAt(0.1)}));
  }

  static SceneChange stateChange(bool is_diff, std::map<std::string, double> variables)
  {
    SceneChange change;
    change.is_diff = true;
    change.state.is_diff = is_diff;
    change.state.variables = std::move(variables);
    return change;
  }
};

TEST_F(ChangeState, JointsThatAreNotNamedStayWhereTheyAre)
{
  apply(stateChange(true, {{"slide", -1.0}}));
  EXPECT_EQ((std::vector<double>{-1.0, M_PI_2}), state_);
  EXPECT_EQ(2u, scene_.attached.size());
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(ChangeState, JointValuesOutsideTheLimitsGiveAWarning)
{
  apply(stateChange(true, {{"turn", 90.0}}));
  ASSERT_EQ(1u, warnings_.size());
  EXPECT_EQ(0u, warnings_[0].find("robot_state: joint 'turn' is 90, outside its limits -3 to 3 rad")) << warnings_[0];
}

TEST_F(ChangeState, ValuesOfSomeJointsAloneAreNoState)
{
  change(objectChange(Operation::Add, "c", {boxAt(0.1)}));
  state_.clear();
  SceneChange some = stateChange(true, {{"slide", -1.0}});
  apply(some);
  EXPECT_TRUE(state_.empty()) << "nothing is made up for the other joint";
  some.state.attached = {attachedChange(Operation::Add, "c", "pole")};
  refused("state is not known yet", some);
  some.state.variables["turn"] = 0.5;
  apply(some);
  EXPECT_EQ((std::vector<double>{-1.0, 0.5}), state_);
  EXPECT_EQ(link("pole"), carried("c").link);
}

TEST_F(ChangeState, WithJointsAndNoDifferenceItReplacesWhatIsAttached)
{
  SceneChange replace = stateChange(false, {{"slide", 0.0}});
  replace.state.attached = {attachedChange(Operation::Add, "a", "cart", {boxAt(0.2)}),
                            attachedChange(Operation::Add, "c", "cart", {boxAt(0.2)})};
  apply(replace);
  ASSERT_EQ(2u, scene_.attached.size());
  EXPECT_EQ(link("cart"), carried("a").link);
  EXPECT_NO_THROW(carried("c"));
  EXPECT_TRUE(scene_.objects.empty()) << "what is dropped does not go back into the world";
  ASSERT_EQ(1u, warnings_.size());
  EXPECT_TRUE(warned("object 'b' was removed"));
}

TEST_F(ChangeState, WithoutJointsAndNoDifferenceItOnlyAdds)
{
  SceneChange add = stateChange(false, {});
  add.state.attached = {attachedChange(Operation::Add, "c", "cart", {boxAt(0.2)})};
  apply(add);
  EXPECT_EQ(3u, scene_.attached.size());
  add.state.attached = {attachedChange(Operation::Remove, "c", "")};
  refused("can only add", add);
  add.state.attached = {attachedChange(Operation::Append, "c", "", {boxAt(0.2)})};
  refused("can only add", add);
}

TEST_F(ChangeState, AFullSceneReplacesWhatIsAttachedWithAWarning)
{
  SceneChange full;
  full.state.is_diff = false;
  full.state.attached = {attachedChange(Operation::Add, "a", "cart", {boxAt(0.2)}),
                         attachedChange(Operation::Add, "c", "cart", {boxAt(0.2)})};
  apply(full);
  ASSERT_EQ(2u, scene_.attached.size());
  EXPECT_NO_THROW(carried("c"));
  ASSERT_EQ(1u, warnings_.size());
  EXPECT_TRUE(warned("object 'b' was removed"));
  EXPECT_EQ((std::vector<double>{0.5, M_PI_2}), state_) << "joints that it does not name stay";
}

TEST_F(ChangeState, AFullSceneWhoseRobotStateIsADifferenceKeepsWhatIsAttached)
{
  SceneChange full;
  full.state.is_diff = true;
  full.state.variables["slide"] = -1.0;
  full.state.attached = {attachedChange(Operation::Add, "c", "cart", {boxAt(0.2)})};
  apply(full);
  EXPECT_EQ(3u, scene_.attached.size());
  EXPECT_EQ(link("pole"), carried("a").link);
  EXPECT_TRUE(warnings_.empty());
  full.state.attached = {attachedChange(Operation::Remove, "c", "")};
  apply(full);
  EXPECT_EQ(2u, scene_.attached.size());
}

TEST_F(ChangeState, AFullSceneDoesNotAttachObjectsOfTheSceneBefore)
{
  change(objectChange(Operation::Add, "c", {boxAt(0.1)}));
  SceneChange full;
  full.state.attached = {attachedChange(Operation::Add, "c", "cart")};
  refused("no such object", full);
}

TEST_F(ChangeState, InvalidChangesAreRefused)
{
  refused("no joint variable 'gripper'", stateChange(true, {{"gripper", 0.0}}));
  refused("not finite", stateChange(true, {{"slide", std::numeric_limits<double>::infinity()}}));
  state_.pop_back();
  refused("1 values for 2", stateChange(true, {}));
}
}  // namespace
}  // namespace gpu_planning_scene::core
