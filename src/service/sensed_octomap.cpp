#include "service/sensed_octomap.h"

#include <algorithm>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"

namespace gpu_planning_scene::core
{
SceneChange keepingOctomap(SceneChange change, const PlanningScene& scene)
{
  const auto is_octomap = [](const auto& object) { return object.id == kOctomapId; };
  auto& objects = change.objects;
  if (std::any_of(objects.begin(), objects.end(),
                  [&](const ObjectChange& object)
                  { return is_octomap(object) && object.operation != Operation::Remove; }))
    throw Error(
        "the octomap comes from this node's sensors (~sensors), so no message can replace it; leave world.octomap "
        "empty, or run the node without sensors");
  objects.erase(std::remove_if(objects.begin(), objects.end(), is_octomap), objects.end());
  const auto kept = std::find_if(scene.objects.begin(), scene.objects.end(), is_octomap);
  if (!change.is_diff && kept != scene.objects.end())
  {
    ObjectChange& add = objects.emplace_back();
    add.id = kept->id;
    add.pose = kept->pose;
    add.shapes = kept->shapes;
  }
  return change;
}
}  // namespace gpu_planning_scene::core
