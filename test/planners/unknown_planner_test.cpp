// The message for a planner that nobody knows.

#include <gtest/gtest.h>

#include "planners/unknown_planner.h"

namespace gpu_planning_scene::core
{
namespace
{
const std::vector<std::string> kPlugins = {"geometric::RRTConnect", "geometric::PRM",
                                           "gpu_planning_scene/BatchRrtConnect"};

TEST(UnknownPlanner, WithoutAFileOnlyThePluginsAreNamed)
{
  EXPECT_EQ(
      "planner 'Best' is not a plugin; plugins: geometric::RRTConnect, geometric::PRM, "
      "gpu_planning_scene/BatchRrtConnect",
      unknownPlannerText("Best", {}, kPlugins));
}

TEST(UnknownPlanner, TheConfigurationsOfTheFileAreNamed)
{
  EXPECT_EQ(
      "planner 'Best' is neither in the planner_configs of ~planners nor a plugin; planner_configs: Fast, Short; "
      "plugins: geometric::PRM",
      unknownPlannerText("Best", {"Fast", "Short"}, {"geometric::PRM"}));
}

TEST(UnknownPlanner, ASimilarNameIsSuggested)
{
  const auto suggests = [](const std::string& name, const std::string& meant)
  {
    const std::string message = unknownPlannerText(name, {"Fast", "PRMstarkConfigDefault"}, kPlugins);
    EXPECT_NE(std::string::npos, message.find("BatchRrtConnect; did you mean '" + meant + "'?")) << message;
  };
  suggests("RRTConnect", "geometric::RRTConnect");
  suggests("rrtconnect", "geometric::RRTConnect");
  suggests("geometric::RRTConect", "geometric::RRTConnect");
  suggests("ompl::RRTConnect", "geometric::RRTConnect");
  suggests("BatchRRTConnect", "gpu_planning_scene/BatchRrtConnect");
  suggests("fast", "Fast");
  suggests("PRMstarkConfigDefaul", "PRMstarkConfigDefault");
}
}  // namespace
}  // namespace gpu_planning_scene::core
