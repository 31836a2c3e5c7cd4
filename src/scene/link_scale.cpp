#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/planning_scene.h"
#include "model/scaled_shapes.h"

// The scale of links, which also applies to their attached objects.
namespace gpu_planning_scene::core
{
namespace
{
void scaleAttachedBy(const RobotModel& robot, AttachedObject& object, ShapeScaler& scaler)
{
  const std::vector<double>& scale = robot.linkScale();
  const double factor = scale.empty() ? 1.0 : scale.at(static_cast<std::size_t>(object.link));
  try
  {
    object.scaled_shapes =
        factor == 1.0 ? nullptr
                      : std::make_shared<const std::vector<PlacedShape>>(scaler.scaled(object.object.shapes, factor));
  }
  catch (const Error& error)
  {
    throw Error("attached object '" + object.object.id + "': " + error.what());
  }
}
}  // namespace

void PlanningScene::setLinkScale(const std::vector<double>& factors)
{
  const std::shared_ptr<const RobotModel> scaled = robot->scaled(factors);
  if (scaled == robot)
    return;
  std::vector<AttachedObject> scaled_objects = attached;
  ShapeScaler scaler;
  for (AttachedObject& object : scaled_objects)
    scaleAttachedBy(*scaled, object, scaler);
  robot = scaled;
  attached = std::move(scaled_objects);
}

void PlanningScene::scaleAttached(AttachedObject& object) const
{
  ShapeScaler scaler;
  scaleAttachedBy(*robot, object, scaler);
}
}  // namespace gpu_planning_scene::core
