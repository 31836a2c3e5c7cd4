// Padding, scale, colours and matrices over ROS; get_planning_scene and clear.

#include <mutex>

#include <rosgraph_msgs/Log.h>

#include "gpu_planning_scene/planning_scene.h"
#include "node/node_client.h"

namespace gpu_planning_scene::core
{
namespace
{
class Settings : public RunningNode
{
 public:
  static PlanningSceneMessage padding(const std::string& link, double metres)
  {
    PlanningSceneMessage change = diffScene();
    change.link_padding.resize(1);
    change.link_padding[0].link_name = link;
    change.link_padding[0].padding = metres;
    return change;
  }

  static PlanningSceneMessage scale(const std::string& link, double factor)
  {
    PlanningSceneMessage change = diffScene();
    change.link_scale.resize(1);
    change.link_scale[0].link_name = link;
    change.link_scale[0].scale = factor;
    return change;
  }

  /// A matrix in which every link may touch the box.
  static AllowedCollisionMatrixMessage boxIsAllowed()
  {
    AllowedCollisionMatrixMessage matrix;
    matrix.default_entry_names.emplace_back("box");
    matrix.default_entry_values.push_back(1);
    for (const Link& link : robot->links())
      matrix.entry_names.push_back(link.name);
    matrix.entry_values.resize(matrix.entry_names.size());
    for (auto& row : matrix.entry_values)
      row.enabled.assign(matrix.entry_names.size(), 1);
    return matrix;
  }
};

TEST_F(Settings, PaddingKeepsObjectsAway)
{
  apply(diffWith(boxObject("box", tipPoint() + Eigen::Vector3d(0.0, 0.0, 10.0), 0.02)));
  EXPECT_TRUE(isFree());
  apply(padding(tip, 10.0));
  EXPECT_NE(std::string::npos, collision().find("box"));
  apply(padding(tip, 0.0));
  EXPECT_TRUE(isFree());
  expectRefusal(padding(tip, -0.1), tip);
  expectRefusal(padding("no such link", 0.1), "no such link");
}

TEST_F(Settings, ScaleMakesALinkLarger)
{
  CollisionObject ceiling = objectOperation("ceiling", CollisionObject::ADD);
  ceiling.planes.resize(1);
  ceiling.planes[0].coef = {{0.0, 0.0, -1.0, tipPoint().z() + 5.0}};
  apply(diffWith(ceiling));
  EXPECT_TRUE(isFree());
  apply(scale(tip, 1000.0));
  EXPECT_FALSE(isFree());
  apply(scale(tip, 1.0));
  EXPECT_TRUE(isFree());
  expectRefusal(scale(tip, 0.0), tip);
}

TEST_F(Settings, ColoursComeBackAndChangeNoAnswer)
{
  PlanningSceneMessage change = diffWith(boxObject("box", farAway(), 0.02));
  change.object_colors.resize(1);
  change.object_colors[0].id = "box";
  change.object_colors[0].color.g = 0.5F;
  change.object_colors[0].color.a = 1.0F;
  apply(change);
  const PlanningSceneMessage now = scene(PlanningSceneComponents::OBJECT_COLORS);
  ASSERT_EQ(1u, now.object_colors.size());
  EXPECT_EQ("box", now.object_colors[0].id);
  EXPECT_EQ(0.5F, now.object_colors[0].color.g);
  EXPECT_TRUE(isFree());
}

TEST_F(Settings, AMatrixOfTheSceneAllowsPairsUntilAFullSceneComes)
{
  apply(diffWith(boxObject("box", tipPoint(), 0.02)));
  EXPECT_FALSE(isFree());
  PlanningSceneMessage change = diffScene();
  change.allowed_collision_matrix = boxIsAllowed();
  apply(change);
  EXPECT_TRUE(isFree());
  SetUp();
  apply(diffWith(boxObject("box", tipPoint(), 0.02)));
  EXPECT_FALSE(isFree());
}

TEST_F(Settings, AChangeAfterWhichBodiesAlwaysCollideIsAWarningInTheLog)
{
  std::mutex mutex;
  std::string found;
  const ros::Subscriber log = ros::NodeHandle().subscribe<rosgraph_msgs::Log>(
      "/rosout", 1000,
      [&](const rosgraph_msgs::Log::ConstPtr& line)
      {
        const std::lock_guard<std::mutex> lock(mutex);
        if (line->level == rosgraph_msgs::Log::WARN && line->msg.find(" - block") != std::string::npos)
          found = line->msg;
      });
  for (int i = 0; i < 100 && log.getNumPublishers() == 0; ++i)
    ros::WallDuration(0.1).sleep();
  apply(diffWith(boxObject("block", Eigen::Vector3d::Zero(), 20.0)));
  const auto text = [&]
  {
    const std::lock_guard<std::mutex> lock(mutex);
    return found;
  };
  for (int i = 0; i < 300 && text().empty(); ++i)
    ros::WallDuration(0.1).sleep();
  EXPECT_NE(std::string::npos, text().find("in collision in each of 64 random states, so probably no state is valid"))
      << text();
  EXPECT_NE(std::string::npos, text().find("move these bodies apart")) << text();
}

TEST_F(Settings, AMatrixOfARequestHoldsForItAlone)
{
  apply(diffWith(boxObject("box", tipPoint(), 0.02)));
  CheckStates::Request request = stateRequest(free_state);
  request.allowed_collision_matrix = boxIsAllowed();
  const auto response = call<CheckStates>("check_states", request);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(1, response.valid.at(0));
  EXPECT_FALSE(isFree());
}

TEST_F(Settings, OnlyTheRequestedComponentsAreReported)
{
  PlanningSceneMessage change = diffWith(boxObject("box", farAway(), 0.02));
  change.name = "kitchen";
  apply(change);
  PlanningSceneMessage now = scene(PlanningSceneComponents::SCENE_SETTINGS);
  EXPECT_EQ("kitchen", now.name);
  EXPECT_EQ(robot->name(), now.robot_model_name);
  EXPECT_TRUE(now.world.collision_objects.empty());
  EXPECT_TRUE(now.robot_state.joint_state.name.empty());
  now = scene(PlanningSceneComponents::WORLD_OBJECT_NAMES);
  EXPECT_EQ("", now.name);
  ASSERT_EQ(1u, now.world.collision_objects.size());
  EXPECT_EQ("box", now.world.collision_objects[0].id);
  EXPECT_TRUE(now.world.collision_objects[0].primitives.empty());
  now = scene(PlanningSceneComponents::WORLD_OBJECT_GEOMETRY);
  ASSERT_EQ(1u, now.world.collision_objects.size());
  EXPECT_EQ(1u, now.world.collision_objects[0].primitives.size());
  now = scene(PlanningSceneComponents::ROBOT_STATE);
  EXPECT_FALSE(now.robot_state.joint_state.name.empty());
  now = scene(PlanningSceneComponents::LINK_PADDING_AND_SCALING);
  EXPECT_FALSE(now.link_padding.empty());
  EXPECT_EQ(now.link_padding.size(), now.link_scale.size());
  now = scene(PlanningSceneComponents::ALLOWED_COLLISION_MATRIX);
  EXPECT_EQ(now.allowed_collision_matrix.entry_names.size(), now.allowed_collision_matrix.entry_values.size());
  now = scene();
  EXPECT_EQ("kitchen", now.name);
  EXPECT_EQ(1u, now.world.collision_objects.size());
  EXPECT_FALSE(now.is_diff);
}

TEST_F(Settings, ASceneThatIsReadAndAppliedIsTheSame)
{
  apply(diffWith(boxObject("box", farAway(), 0.02)));
  PlanningSceneMessage change = diffScene();
  change.robot_state.attached_collision_objects.resize(1);
  change.robot_state.attached_collision_objects[0].link_name = tip;
  change.robot_state.attached_collision_objects[0].object = boxObject("cup", tipPoint(), 0.02);
  apply(change);
  apply(padding(base, 0.01));
  PlanningSceneMessage before = scene();
  const std::uint64_t revision = apply(before);
  PlanningSceneMessage after = scene();
  EXPECT_EQ(revision, after.scene_revision);
  EXPECT_EQ(before.world.collision_objects, after.world.collision_objects);
  EXPECT_EQ(before.link_padding, after.link_padding);
  EXPECT_EQ(before.allowed_collision_matrix, after.allowed_collision_matrix);
  EXPECT_EQ(before.robot_state.attached_collision_objects.size(), after.robot_state.attached_collision_objects.size());
}

TEST_F(Settings, AClearTakesObjectsAndKeepsSettings)
{
  apply(padding(tip, 0.02));
  apply(diffWith(boxObject("box", tipPoint(), 0.02)));
  const auto response = call<Clear>("clear", Clear::Request());
  EXPECT_TRUE(response.success) << response.message;
  const PlanningSceneMessage now = scene();
  EXPECT_TRUE(now.world.collision_objects.empty());
  EXPECT_EQ(response.scene_revision, now.scene_revision);
  bool kept = false;
  for (const LinkPadding& entry : now.link_padding)
    kept = kept || (entry.link_name == tip && entry.padding == 0.02);
  EXPECT_TRUE(kept);
  EXPECT_TRUE(isFree());
}

TEST_F(Settings, AnotherRobotsSceneIsRefused)
{
  PlanningSceneMessage change = diffScene();
  change.robot_model_name = "another robot";
  expectRefusal(change, "another robot");
}
}  // namespace
}  // namespace gpu_planning_scene::core
