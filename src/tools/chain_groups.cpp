#include "tools/chain_groups.h"

#include <set>

// Own method. A pass from the root to the leaves collects the variables that move each link. A pass back counts the
// moving branches below each link. Of the links that end a chain, the first one for each set of variables is a tip.
namespace gpu_planning_scene::core
{
std::vector<std::string> chainTips(const RobotModel& robot)
{
  const std::size_t count = robot.links().size();
  std::vector<std::set<int>> variables(count);  // of the joints from the root to each link
  std::vector<bool> moves(count, false);        // whether a joint below each link moves
  std::vector<int> moving_branches(count, 0);
  std::vector<bool> is_end(count, true);
  // Parents come before children.
  for (std::size_t link = 0; link < count; ++link)
  {
    const int parent_joint = robot.links()[link].parent_joint;
    if (parent_joint < 0 || robot.joints()[static_cast<std::size_t>(parent_joint)].parent_link < 0)
      continue;  // a virtual joint is no part of a chain
    const Joint& joint = robot.joints()[static_cast<std::size_t>(parent_joint)];
    variables[link] = variables[static_cast<std::size_t>(joint.parent_link)];
    is_end[static_cast<std::size_t>(joint.parent_link)] = false;
    for (int i = 0; i < variableCount(joint.type); ++i)
      variables[link].insert(joint.first_variable + i);
  }
  for (std::size_t link = count; link-- > 1;)
  {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(robot.links()[link].parent_joint)];
    if (moves[link] || joint.type != JointType::Fixed)
    {
      moves[static_cast<std::size_t>(joint.parent_link)] = true;
      ++moving_branches[static_cast<std::size_t>(joint.parent_link)];
    }
  }
  std::vector<std::string> tips;
  std::set<std::set<int>> used;
  for (std::size_t link = 0; link < count; ++link)
    if ((is_end[link] || moving_branches[link] > 1) && !variables[link].empty() && used.insert(variables[link]).second)
      tips.push_back(robot.links()[link].name);
  return tips;
}
}  // namespace gpu_planning_scene::core
