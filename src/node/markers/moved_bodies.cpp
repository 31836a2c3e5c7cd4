#include "node/markers/moved_bodies.h"

#include <algorithm>

namespace gpu_planning_scene::core
{
std::vector<std::size_t> movedBodies(const PlanningScene& scene, const Group& group,
                                     const std::vector<std::vector<Eigen::Isometry3d>>& poses)
{
  std::vector<std::size_t> bodies(group.moved_links.begin(), group.moved_links.end());
  for (std::size_t i = 0; i < scene.attached.size(); ++i)
    if (std::count(group.moved_links.begin(), group.moved_links.end(), scene.attached[i].link) != 0)
      bodies.push_back(scene.robot->links().size() + scene.objects.size() + i);
  const auto stays = [&poses](std::size_t body)
  {
    return std::all_of(poses.begin(), poses.end(),
                       [&](const std::vector<Eigen::Isometry3d>& at)
                       { return (at[body].matrix() - poses[0][body].matrix()).cwiseAbs().maxCoeff() < kUnmoved; });
  };
  bodies.erase(std::remove_if(bodies.begin(), bodies.end(), stays), bodies.end());
  return bodies;
}
}  // namespace gpu_planning_scene::core
