// Rules for the solids of meshes, of links and of objects: in scene files, in changes of a scene, and of a robot.

#include <gtest/gtest.h>

#include "gpu_planning_scene/solids.h"
#include "scene/change_testing.h"
#include "scene/solid_rules.h"

namespace gpu_planning_scene::core
{
namespace
{
using MeshPointer = std::shared_ptr<const Mesh>;

MeshPointer meshOf(const std::vector<PlacedShape>& shapes)
{
  return std::get<MeshPointer>(shapes.at(0).shape);
}

/// Whether the mesh of a link bounds a solid.
bool isSolid(const RobotModel& robot, const std::string& link)
{
  return solidMeshOf(meshOf(robot.links()[static_cast<std::size_t>(robot.linkIndex(link))].shapes))->isAllSolid();
}

TEST(SolidsOfLinks, AreThoseOfTheirRules)
{
  const auto robot = sliderRobotOfMeshes();
  EXPECT_TRUE(isSolid(*robot, "cart"));
  EXPECT_FALSE(isSolid(*robot, "pole"));
  const auto other = robot->withSolids({{"cart", SolidRule::Surface}, {"pole", SolidRule::Filled}});
  EXPECT_FALSE(isSolid(*other, "cart"));
  EXPECT_TRUE(isSolid(*other, "pole"));
  EXPECT_TRUE(isSolid(*robot, "cart")) << "the robot itself stays as it is";
  // Links that are not named keep their rules.
  const auto third = other->withSolids({{"cart", SolidRule::Auto}});
  EXPECT_TRUE(isSolid(*third, "cart"));
  EXPECT_TRUE(isSolid(*third, "pole"));
  EXPECT_EQ(third, third->withSolids({{"pole", SolidRule::Filled}})) << "the same rules are the same robot";
  const auto error_for = [](const RobotModel& of, const std::string& link) {
    return errorOf([&] { of.withSolids({{link, SolidRule::Filled}}); });
  };
  EXPECT_EQ("solid of link 'tail': the robot has no such link; it has rail, cart, nut, pole, pennant",
            error_for(*robot, "tail"));
  const auto primitives = RobotModel::fromXml(
      "<robot name='ball'><link name='ball'><collision><geometry><sphere radius='0.1'/></geometry></collision></link>"
      "</robot>",
      "<robot name='ball'/>", {});
  EXPECT_EQ("solid of link 'ball': the link has no mesh; only meshes have a rule for their solid",
            error_for(*primitives, "ball"));
}

TEST(SolidsOfLinks, KeepTheirScaleAndAreKeptWhenScaled)
{
  const auto robot = sliderRobotOfMeshes();
  std::vector<double> factors(robot->links().size(), 1.0);
  factors[static_cast<std::size_t>(robot->linkIndex("cart"))] = 2.0;
  for (const auto& scaled : {robot->withSolids({{"cart", SolidRule::Surface}})->scaled(factors),
                             robot->scaled(factors)->withSolids({{"cart", SolidRule::Surface}})})
  {
    EXPECT_EQ(factors, scaled->linkScale());
    const MeshPointer mesh = meshOf(scaled->links()[static_cast<std::size_t>(scaled->linkIndex("cart"))].shapes);
    EXPECT_EQ(SolidRule::Surface, mesh->solid);
    EXPECT_DOUBLE_EQ(0.2, mesh->vertices[0].cwiseAbs().maxCoeff());
    const auto plain = scaled->scaled({});
    EXPECT_FALSE(isSolid(*plain, "cart"));
    EXPECT_TRUE(isSolid(*plain->withSolids({{"cart", SolidRule::Auto}}), "cart"));
  }
}

class SolidsOfAFile : public testing::Test
{
 protected:
  SolidsOfAFile() { folder_.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n"); }

  PlanningScene load(const std::string& yaml) const
  {
    return loadSceneText(yaml, "scene.yaml", folder_.path(""), robot_, {});
  }

  std::string fault(const std::string& yaml) const
  {
    return errorOf([&] { load(yaml); });
  }

  static std::string object(const std::string& rest)
  {
    return "world:\n  collision_objects:\n  - {id: bin, " + rest + "}\n";
  }

  TemporaryFolder folder_;
  std::shared_ptr<const RobotModel> robot_ = sliderRobotOfMeshes();
};

TEST_F(SolidsOfAFile, AreThoseOfItsRules)
{
  const PlanningScene scene = load(
      "link_solid: [{link_name: cart, solid: surface}, {link_name: pole, solid: filled}]\n"
      "robot_state:\n  attached_collision_objects:\n"
      "  - {link_name: pole, object: {id: tool, solid: filled, meshes: [{resource: open.obj}]}}\n" +
      object("solid: filled, meshes: [{resource: open.obj}]") +
      "  - {id: tray, solid: surface, meshes: [{resource: open.obj}]}\n"
      "  - {id: pot, solid: auto, meshes: [{resource: open.obj}]}\n"
      "  - {id: cup, meshes: [{resource: open.obj}]}\n");
  EXPECT_FALSE(isSolid(*scene.robot, "cart"));
  EXPECT_TRUE(isSolid(*scene.robot, "pole"));
  for (const WorldObject& read : scene.objects)
    EXPECT_EQ(read.id == "bin", solidMeshOf(meshOf(read.shapes))->isAllSolid()) << read.id;
  EXPECT_TRUE(solidMeshOf(meshOf(scene.attached.at(0).shapes()))->isAllSolid());
}

TEST_F(SolidsOfAFile, WithAWrongRuleNameTheirLine)
{
  const std::string mesh = "meshes: [{resource: open.obj}]";
  const std::string unknown = "is unknown; known are auto, surface and filled";
  EXPECT_EQ("scene.yaml:3: solid: 'full' " + unknown, fault(object("solid: full, " + mesh)));
  EXPECT_EQ("scene.yaml:3: object 'bin' has no mesh; only meshes have a rule for their solid",
            fault(object("solid: filled, primitives: [{type: sphere, dimensions: [1]}]")));
  EXPECT_EQ("scene.yaml:2: solid: 'Filled' " + unknown,
            fault("world: {}\nlink_solid: [{link_name: cart, solid: Filled}]"));
  EXPECT_EQ("scene.yaml:2: link 'nut' has no mesh; only meshes have a rule for their solid",
            fault("world: {}\nlink_solid: [{link_name: nut, solid: filled}]"));
  EXPECT_EQ("scene.yaml:3: the solid of link 'cart' is given twice",
            fault("link_solid:\n- {link_name: cart, solid: auto}\n- {link_name: cart, solid: filled}\nworld: {}"));
  EXPECT_EQ(0u, fault("world: {}\nlink_solid: [{link_name: card, solid: filled}]")
                    .find("scene.yaml:2: the robot has no link 'card'"))
      << fault("world: {}\nlink_solid: [{link_name: card, solid: filled}]");
  EXPECT_EQ("scene.yaml:2: unknown key 'rule' in 'link_solid'; it has 'link_name' and 'solid'",
            fault("world: {}\nlink_solid: [{link_name: cart, rule: filled}]"));
}

class ChangeSolids : public SceneChanges
{
 protected:
  ChangeSolids()
  {
    scene_ = PlanningScene(sliderRobotOfMeshes());
    change(objectChange(Operation::Add, "bin", {triangleAt()}));
    change(attachedChange(Operation::Add, "tool", "pole", {boxAt(0.1), triangleAt()}));
  }

  void set(const std::map<std::string, SolidRule>& rules) { apply(withRules(rules)); }

  static SceneChange withRules(const std::map<std::string, SolidRule>& rules)
  {
    SceneChange change;
    change.is_diff = true;
    change.solids = rules;
    return change;
  }

  /// The rules of the scene that are not SolidRule::Auto.
  std::map<std::string, SolidRule> rules() const
  {
    std::map<std::string, SolidRule> found = solidRulesOf(scene_);
    for (auto rule = found.begin(); rule != found.end();)
      rule = rule->second == SolidRule::Auto ? found.erase(rule) : std::next(rule);
    return found;
  }

  using Rules = std::map<std::string, SolidRule>;
};

TEST_F(ChangeSolids, GivesRulesToLinksObjectsAndWhatLinksCarry)
{
  const Rules wanted = {{"bin", SolidRule::Surface}, {"cart", SolidRule::Surface}, {"tool", SolidRule::Filled}};
  set(wanted);
  EXPECT_EQ(wanted, rules());
  EXPECT_EQ(SolidRule::Filled, std::get<MeshPointer>(carried("tool").shapes().at(1).shape)->solid)
      << "the checked shapes of an attached object";
  set({{"bin", SolidRule::Auto}});
  EXPECT_EQ((Rules{{"cart", SolidRule::Surface}, {"tool", SolidRule::Filled}}), rules()) << "others keep theirs";
}

TEST_F(ChangeSolids, AnObjectKeepsItsRuleUntilItIsReplaced)
{
  const Rules filled = {{"bin", SolidRule::Filled}};
  set(filled);
  ObjectChange move = objectChange(Operation::Move, "bin");
  move.pose = poseAt(1, 0, 0);
  change(move);
  change(objectChange(Operation::Append, "bin", {triangleAt(poseAt(0, 0, 1))}));
  EXPECT_EQ(SolidRule::Filled, std::get<MeshPointer>(object("bin").shapes.at(1).shape)->solid);
  change(attachedChange(Operation::Add, "bin", "cart"));
  EXPECT_EQ(filled, rules());
  change(attachedChange(Operation::Append, "bin", "cart", {triangleAt(poseAt(0, 0, 2))}));
  EXPECT_EQ(SolidRule::Filled, std::get<MeshPointer>(carried("bin").object.shapes.at(2).shape)->solid);
  change(attachedChange(Operation::Remove, "bin", ""));
  EXPECT_EQ(filled, rules());
  change(objectChange(Operation::Add, "bin", {triangleAt()}));
  EXPECT_EQ(Rules(), rules());
}

TEST_F(ChangeSolids, AFullSceneKeepsTheRulesOfLinksAlone)
{
  set({{"cart", SolidRule::Surface}, {"bin", SolidRule::Filled}});
  SceneChange full;
  full.objects = {objectChange(Operation::Add, "bin", {triangleAt()})};
  full.link_scale["cart"] = 2.0;
  apply(full);
  EXPECT_EQ((Rules{{"cart", SolidRule::Surface}}), rules());
}

TEST_F(ChangeSolids, CanComeWithTheObjectThatItNames)
{
  SceneChange both = withRules({{"pot", SolidRule::Filled}});
  both.objects = {objectChange(Operation::Add, "pot", {triangleAt()})};
  apply(both);
  EXPECT_EQ((Rules{{"pot", SolidRule::Filled}}), rules());
}

TEST_F(ChangeSolids, OfWhatHasNoMeshIsRefused)
{
  change(objectChange(Operation::Add, "box", {boxAt(0.1)}));
  refused("solids: there is no link or object 'pot'",
          withRules({{"cart", SolidRule::Surface}, {"pot", SolidRule::Auto}}));
  refused("solids: 'box' has no mesh", withRules({{"box", SolidRule::Filled}}));
  refused("solids: 'nut' has no mesh", withRules({{"nut", SolidRule::Filled}}));
  SceneChange removed = withRules({{"bin", SolidRule::Filled}});
  removed.objects = {objectChange(Operation::Remove, "bin")};
  refused("solids: there is no link or object 'bin'", removed);
}
}  // namespace
}  // namespace gpu_planning_scene::core
