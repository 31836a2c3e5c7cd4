#include "gpu_planning_scene/scene_change.h"

#include <algorithm>
#include <set>

#include "base/error_place.h"
#include "base/text/one_line.h"
#include "gpu_planning_scene/error.h"
#include "scene/changes/scene_changer.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Returns true if the change names only the planning frame and links. Most changes do, and trying a large one takes
/// long.
bool namesNoOtherFrames(const RobotModel& robot, const SceneChange& change)
{
  const auto is_robots = [&robot](const StampedFrame& frame)
  { return frame.name.empty() || frame.name == robot.planningFrame() || robot.linkIndex(frame.name) >= 0; };
  return std::all_of(change.objects.begin(), change.objects.end(),
                     [&](const ObjectChange& object) { return is_robots(object.frame); }) &&
         std::all_of(change.state.attached.begin(), change.state.attached.end(),
                     [&](const AttachedChange& attached) { return is_robots(attached.object.frame); });
}
}  // namespace

ChangedScene applyChange(const PlanningScene& scene, const std::vector<double>& state, const SceneChange& change,
                         const SceneDefaults& defaults, const SceneLimits& limits, const ExternalFrames& frames)
{
  const auto lookup = [&](const StampedFrame& frame)
  {
    const auto found = frames.find(frame);
    if (found == frames.end())
      throw Error("unknown frame '" + frame.name + "'; known are the planning frame '" + scene.robot->planningFrame() +
                  "', links, objects, OBJECT/SUBFRAME, fixed frames of the scene, and frames of tf");
    return found->second;
  };
  return withErrorText([](const std::string& message) { return shortLine(message); },
                       [&] { return SceneChanger(scene, state, defaults, limits, lookup).make(change); });
}

/// Tries the change with an arbitrary state of the robot, and an arbitrary pose for each unknown frame. They do not
/// affect which names are unknown. Errors are ignored here; applyChange reports them.
std::vector<StampedFrame> externalFrames(const PlanningScene& scene, const SceneChange& change)
{
  if (namesNoOtherFrames(*scene.robot, change))
    return {};
  std::set<StampedFrame> unknown;
  const auto lookup = [&unknown](const StampedFrame& frame)
  {
    unknown.insert(frame);
    return Eigen::Isometry3d::Identity();
  };
  try
  {
    SceneChanger(scene, scene.robot->defaultState(), {}, {}, lookup).make(change);
  }
  catch (const Error&)
  {
    return {unknown.begin(), unknown.end()};
  }
  return {unknown.begin(), unknown.end()};
}
}  // namespace gpu_planning_scene::core
