#include "node/sensors/sensed_object.h"

#include <algorithm>
#include <utility>

#include "node/endpoints/topic_warnings.h"

namespace gpu_planning_scene::core
{
namespace
{
bool isSameCube(const PlacedShape& a, const PlacedShape& b)
{
  return a.pose.matrix() == b.pose.matrix() && std::get<Box>(a.shape).size == std::get<Box>(b.shape).size;
}

/// Whether the object has these cubes, and no client has moved it.
bool isThere(const WorldObject& object, const std::vector<PlacedShape>& cubes)
{
  return object.pose.matrix() == Eigen::Isometry3d::Identity().matrix() &&
         std::equal(object.shapes.begin(), object.shapes.end(), cubes.begin(), cubes.end(), isSameCube);
}
}  // namespace

void replaceObject(SceneStore& store, const std::string& id, std::vector<PlacedShape> cubes)
{
  const std::shared_ptr<const PlanningScene> scene = store.snapshot().scene;
  const WorldObject* old = scene->findObject(id);
  if (old ? isThere(*old, cubes) : cubes.empty())
    return;
  ObjectChange change;
  change.id = id;
  change.pose = Eigen::Isometry3d::Identity();
  if (cubes.empty())
  {
    change.operation = Operation::Remove;
    change.keeps_allowed_collisions = true;  // for the next measurement, whose object has the same id
  }
  change.shapes = std::move(cubes);
  SceneChange diff;
  diff.is_diff = true;
  diff.objects.push_back(std::move(change));
  warnOfMessage(store.sense(diff).warnings);
}
}  // namespace gpu_planning_scene::core
