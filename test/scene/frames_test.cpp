// The frames that a scene knows, their precedence, and the frames that it looks up elsewhere.

#include "scene/change_testing.h"
#include "scene/link_frame.h"

namespace gpu_planning_scene::core
{
namespace
{
class Frames : public SceneChanges
{
 protected:
  Frames()
  {
    ObjectChange table = objectChange(Operation::Add, "table", {boxAt(0.1)});
    table.pose = poseAt(1, 0, 0, M_PI_2);
    table.subframes["corner"] = poseAt(1, 0, 0);
    AttachedChange tool = attachedChange(Operation::Add, "tool", "cart", {boxAt(0.1)});
    tool.object.frame.name = "cart";
    tool.object.subframes["a/tip"] = poseAt(0, 0, 1);
    SceneChange change;
    change.is_diff = true;
    change.fixed_frames["camera"] = poseAt(0, 0, 5);
    change.state.attached = {tool};
    change.objects = {table};
    apply(change);
  }

  Eigen::Isometry3d find(const std::string& name) const
  {
    const auto pose = scene_.frame(name, state_.data());
    return pose ? *pose : throw std::runtime_error("no frame " + name);
  }
};

TEST_F(Frames, AreThePlanningFrameLinksObjectsSubframesAndFixedFrames)
{
  for (const char* slash : {"", "/"})
  {
    const std::string start = slash;
    EXPECT_TRUE(find(start + "rail").isApprox(poseAt(0, 0, 0)));
    EXPECT_TRUE(find(start + "pole").isApprox(poseAt(0.5, 0, 0, M_PI_2), 1e-15));
    EXPECT_TRUE(find(start + "table").isApprox(poseAt(1, 0, 0, M_PI_2), 1e-15));
    EXPECT_TRUE(find(start + "table/corner").isApprox(poseAt(1, 1, 0, M_PI_2), 1e-15));
    EXPECT_TRUE(find(start + "tool").isApprox(poseAt(0.5, 0, 0), 1e-15));
    EXPECT_TRUE(find(start + "tool/a/tip").isApprox(poseAt(0.5, 0, 1), 1e-15));
    EXPECT_TRUE(find(start + "camera").isApprox(poseAt(0, 0, 5), 1e-15));
    EXPECT_FALSE(scene_.frame(start + "lamp", state_.data()));
    EXPECT_FALSE(scene_.frame(start + "table/lamp", state_.data()));
  }
  EXPECT_TRUE(find("").isApprox(poseAt(0, 0, 0)));
}

TEST_F(Frames, AnObjectComesBeforeASubframeAndAFixedFrameLast)
{
  ObjectChange object = objectChange(Operation::Add, "table/corner", {boxAt(0.1)});
  object.pose = poseAt(9, 0, 0);
  change(object);
  EXPECT_EQ(9.0, find("table/corner").translation().x());
  object.id = "camera";
  change(object);
  EXPECT_EQ(9.0, find("camera").translation().x());
}

TEST_F(Frames, OfLinksNeedTheRobotsState)
{
  for (const char* name : {"pole", "tool", "tool/a/tip"})
    EXPECT_NE(std::string::npos, errorOf([&] { scene_.frame(name, nullptr); }).find("state is not known yet")) << name;
  EXPECT_TRUE(scene_.frame("table", nullptr));
  state_[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(std::string::npos, errorOf([&] { find("pole"); }).find("not finite"));
}

TEST_F(Frames, OfLinksCarriedObjectsAndTheirSubframesMoveWithALink)
{
  for (const char* name : {"cart", "pole", "tool", "tool/a/tip", "/tool"})
  {
    const LinkFrame frame = linkFrame(scene_, name);
    const Eigen::Isometry3d of_link = find(scene_.robot->links().at(static_cast<std::size_t>(frame.link)).name);
    EXPECT_TRUE((of_link * frame.pose).isApprox(find(name), 1e-15)) << name;
  }
  EXPECT_EQ(scene_.robot->linkIndex("cart"), linkFrame(scene_, "tool/a/tip").link);
  for (const std::string name : {"table", "table/corner", "camera"})
    EXPECT_EQ("frame '" + name +
                  "' does not move with the robot; name a link, an object that a link carries, or OBJECT/SUBFRAME",
              errorOf([&] { linkFrame(scene_, name); }));
  EXPECT_EQ("the scene has no frame 'tool/a/tipp'; did you mean 'tool/a/tip'?",
            errorOf([&] { linkFrame(scene_, "tool/a/tipp"); }));
}

TEST_F(Frames, UnknownFramesAreLookedUpOnceEach)
{
  SceneChange change;
  change.is_diff = true;
  const auto add = [&](const std::string& id, const std::string& frame, std::int64_t stamp = 0)
  {
    change.objects.push_back(objectChange(Operation::Add, id, {boxAt(0.1)}));
    change.objects.back().frame = {frame, stamp};
  };
  change.fixed_frames["lamp"] = poseAt(1, 0, 0);
  AttachedChange held = attachedChange(Operation::Add, "held", "pole", {boxAt(0.1)});
  held.object.frame.name = "hand";
  change.state.attached = {held};
  for (const char* known : {"", "rail", "pole", "table", "table/corner", "tool", "lamp", "held"})
    add(std::string("in ") + known, known);
  add("a", "sensor");
  add("b", "sensor");
  add("c", "sensor", 7);
  add("d", "a");
  add("e", "camera");  // the change replaces the fixed frames, and "camera" is no longer one of them
  std::vector<std::string> names;
  for (const StampedFrame& frame : externalFrames(scene_, change))
    names.push_back(frame.name + " " + std::to_string(frame.stamp));
  EXPECT_EQ((std::vector<std::string>{"camera 0", "hand 0", "sensor 0", "sensor 7"}), names);

  refused("unknown frame 'hand'", change);
  frames_ = {{{"camera", 0}, poseAt(1, 0, 0)},
             {{"hand", 0}, poseAt(2, 0, 0)},
             {{"sensor", 0}, poseAt(3, 0, 0)},
             {{"sensor", 7}, poseAt(4, 0, 0)}};
  apply(change);
  EXPECT_EQ(3.0, object("b").pose.translation().x());
  EXPECT_EQ(4.0, object("c").pose.translation().x());
  EXPECT_EQ(3.0, object("d").pose.translation().x());
  EXPECT_TRUE(find("held").isApprox(poseAt(2, 0, 0), 1e-15));
}

TEST_F(Frames, LookupsDoNotDependOnTheState)
{
  scene_.current_state.clear();
  SceneChange change;
  change.is_diff = true;
  change.objects = {objectChange(Operation::Add, "a", {boxAt(0.1)}), objectChange(Operation::Add, "b", {boxAt(0.1)})};
  change.objects[0].frame.name = "pole";
  change.objects[1].frame.name = "sensor";
  EXPECT_EQ(1u, externalFrames(scene_, change).size());
}

TEST_F(Frames, InvalidPosesAreRefused)
{
  ObjectChange object = objectChange(Operation::Add, "a", {boxAt(0.1)});
  object.frame.name = "sensor";
  frames_[{"sensor", 0}] = poseAt(std::numeric_limits<double>::quiet_NaN(), 0, 0);
  refused("frame 'sensor'", object);
}
}  // namespace
}  // namespace gpu_planning_scene::core
