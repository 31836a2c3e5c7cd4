#include "service/sensed_octomap.h"

#include <algorithm>

#include "gpu_planning_scene/octomap.h"

namespace gpu_planning_scene::core
{
SceneChange keepingOctomap(SceneChange change, const PlanningScene& scene, std::vector<std::string>& warnings)
{
  const auto is_octomap = [](const ObjectChange& object) { return object.id == kOctomapId; };
  auto& objects = change.objects;
  const auto octomaps = std::remove_if(objects.begin(), objects.end(), is_octomap);
  if (octomaps != objects.end())
    warnings.push_back(
        "the octomap stays as it is, because it comes from this node's sensors (~sensors); ~clear_octomap forgets it");
  objects.erase(octomaps, objects.end());
  const WorldObject* kept = scene.findObject(kOctomapId);
  if (!change.is_diff && kept)
  {
    ObjectChange& add = objects.emplace_back();
    add.id = kept->id;
    add.pose = kept->pose;
    add.shapes = kept->shapes;
  }
  return change;
}
}  // namespace gpu_planning_scene::core
