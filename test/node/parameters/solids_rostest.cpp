// The parameter ~solids of a node gives links rules for the solids of their meshes.

#include "gpu_planning_scene/error.h"
#include "model/model_testing.h"
#include "node/parameters/node_parameters.h"
#include "scene/solid_rules.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Parameters in the namespace /solids, with a robot of one mesh.
class SolidParameters : public testing::Test
{
 public:
  SolidParameters()
  {
    const std::string mesh = folder.write("part.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    node.setParam("robot_description",
                  "<robot name='r'><link name='part'><collision><geometry><mesh filename='file://" + mesh +
                      "'/></geometry></collision></link></robot>");
    node.setParam("robot_description_semantic", "");
    own.setParam("mesh/roots", std::vector<std::string>{folder.path("")});
  }
  ~SolidParameters() override { ros::NodeHandle().deleteParam("/solids"); }

  PlanningScene load()
  {
    SceneDefaults defaults;
    return sceneFromParameters(node, own, defaults, nullptr);
  }

  std::string fault()
  {
    return errorOf([this] { load(); });
  }

  TemporaryFolder folder;
  ros::NodeHandle node{"/solids"};
  ros::NodeHandle own{"/solids/node"};
};

TEST_F(SolidParameters, GiveRulesToLinks)
{
  EXPECT_EQ(SolidRule::Auto, solidRulesOf(load()).at("part"));
  own.setParam("solids", std::map<std::string, std::string>{{"part", "filled"}});
  EXPECT_EQ(SolidRule::Filled, solidRulesOf(load()).at("part"));
}

TEST_F(SolidParameters, OfTheWrongKindAreNamed)
{
  own.setParam("solids", "filled");
  EXPECT_EQ("parameter /solids/node/solids: it must be a map {LINK: RULE}", fault());
  own.setParam("solids", std::map<std::string, int>{{"part", 2}});
  EXPECT_EQ("parameter /solids/node/solids: the rule of link 'part' must be auto, surface or filled", fault());
  own.setParam("solids", std::map<std::string, std::string>{{"part", "full"}});
  EXPECT_EQ("parameter /solids/node/solids: link 'part': solid: 'full' is unknown; known are auto, surface and filled",
            fault());
  own.setParam("solids", std::map<std::string, std::string>{{"parts", "filled"}});
  EXPECT_EQ("solid of link 'parts': the robot has no such link; it has part", fault());
}
}  // namespace
}  // namespace gpu_planning_scene::core
