// A change with one wrong part changes nothing. This holds for a wrong part at any place.

#include "scene/change_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
class StrongGuarantee : public SceneChanges
{
 protected:
  StrongGuarantee()
  {
    change(objectChange(Operation::Add, "table", {boxAt(0.1)}));
    change(attachedChange(Operation::Add, "tool", "cart", {boxAt(0.1)}));
  }

  /// A valid change that touches every part of a scene.
  static SceneChange right(bool is_diff)
  {
    SceneChange change;
    change.is_diff = is_diff;
    change.name = "other";
    change.fixed_frames["lamp"] = poseAt(1, 0, 0);
    change.state.is_diff = false;
    change.state.variables = {{"slide", -1.0}};
    change.state.attached = {attachedChange(Operation::Add, "tool", "pole", {boxAt(0.2)})};
    change.matrix = AllowedCollisionMatrix();
    change.link_padding["cart"] = 0.1;
    change.link_scale["cart"] = 2.0;
    change.colors["table"] = {1.0F, 0.0F, 0.0F, 1.0F};
    change.objects = {objectChange(Operation::Add, "bin", {boxAt(0.1)}),
                      objectChange(Operation::Add, "table", {boxAt(0.3)})};
    return change;
  }
};

TEST_F(StrongGuarantee, OneWrongPartLeavesTheWholeSceneAsItWas)
{
  const std::vector<std::pair<const char*, std::function<void(SceneChange&)>>> faults = {
      {"robot", [](SceneChange& change) { change.robot_model_name = "other"; }},
      {"name", [](SceneChange& change) { change.name.assign(2000, 'a'); }},
      {"fixed frame", [](SceneChange& change) { change.fixed_frames["pole"] = poseAt(0, 0, 0); }},
      {"variable", [](SceneChange& change) { change.state.variables["gripper"] = 1.0; }},
      {"attached",
       [](SceneChange& change) { change.state.attached.push_back(attachedChange(Operation::Add, "b", "x")); }},
      {"matrix", [](SceneChange& change) { change.matrix->setEntry("a\n", "b", true); }},
      {"padding", [](SceneChange& change) { change.link_padding["pole"] = -1.0; }},
      {"scale", [](SceneChange& change) { change.link_scale["pole"] = -1.0; }},
      {"color", [](SceneChange& change) { change.colors["bin"].r = 2.0F; }},
      {"object", [](SceneChange& change) { change.objects.push_back(objectChange(Operation::Move, "b")); }},
      {"frame", [](SceneChange& change) { change.objects.back().frame.name = "sensor"; }},
  };
  for (const bool is_diff : {false, true})
  {
    for (const auto& [what, fault] : faults)
    {
      SCOPED_TRACE(what);
      SceneChange change = right(is_diff);
      fault(change);
      refused("", change);
    }
    const PlanningScene before = scene_;
    apply(right(is_diff));
    EXPECT_EQ("other", scene_.name);
    scene_ = before;
    state_ = before.current_state;
  }
}

TEST_F(StrongGuarantee, ScenesThatShareMeshesWithTheNewOneStayAsTheyWere)
{
  change(objectChange(Operation::Add, "mesh", {triangleAt()}));
  const PlanningScene before = scene_;
  ObjectChange move = objectChange(Operation::Move, "mesh");
  move.pose = poseAt(1, 0, 0);
  change(move);
  change(attachedChange(Operation::Add, "mesh", "cart"));
  EXPECT_EQ(2u, before.objects.size());
  EXPECT_TRUE(before.objects[1].pose.isApprox(poseAt(0, 0, 0)));
  EXPECT_EQ(std::get<std::shared_ptr<const Mesh>>(before.objects[1].shapes[0].shape),
            std::get<std::shared_ptr<const Mesh>>(carried("mesh").object.shapes[0].shape));
}

TEST_F(StrongGuarantee, MessagesAreShortLines)
{
  ObjectChange object = objectChange(Operation::Remove, "a\nb" + std::string(100000, 'x'));
  const std::string message = errorOf([&] { change(object); });
  EXPECT_EQ(std::string::npos, message.find('\n'));
  EXPECT_LT(message.size(), 3000u);
}
}  // namespace
}  // namespace gpu_planning_scene::core
