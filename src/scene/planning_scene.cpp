#include "gpu_planning_scene/planning_scene.h"

#include <algorithm>

namespace gpu_planning_scene::core
{
PlanningScene::PlanningScene(std::shared_ptr<const RobotModel> robot_model, const SceneDefaults& defaults)
  : robot(std::move(robot_model)),
    link_padding(defaults.link_padding),
    allowed_collisions(AllowedCollisionMatrix::fromRobot(*robot)),
    matrix_source(robot->srdfCollisions().has_srdf ? MatrixSource::Srdf : MatrixSource::AdjacentLinks)
{
  if (!defaults.link_scale.empty())
    setLinkScale(defaults.link_scale);
}

bool operator==(const JointTrajectory& a, const JointTrajectory& b)
{
  const auto same_point = [](const JointTrajectory::Point& x, const JointTrajectory::Point& y)
  {
    return x.positions == y.positions && x.velocities == y.velocities && x.accelerations == y.accelerations &&
           x.effort == y.effort && x.time_from_start == y.time_from_start;
  };
  return a.frame_id == b.frame_id && a.stamp == b.stamp && a.joint_names == b.joint_names &&
         std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(), same_point);
}

const WorldObject* PlanningScene::findObject(const std::string& id) const
{
  const auto found =
      std::find_if(objects.begin(), objects.end(), [&id](const WorldObject& object) { return object.id == id; });
  return found == objects.end() ? nullptr : &*found;
}

const AttachedObject* PlanningScene::findAttached(const std::string& id) const
{
  const auto found = std::find_if(attached.begin(), attached.end(),
                                  [&id](const AttachedObject& each) { return each.object.id == id; });
  return found == attached.end() ? nullptr : &*found;
}

const std::string& PlanningScene::bodyName(int body) const
{
  const std::size_t links = robot->links().size();
  const std::size_t index = static_cast<std::size_t>(body);
  if (index < links)
    return robot->links()[index].name;
  if (index - links < objects.size())
    return objects[index - links].id;
  return attached.at(index - links - objects.size()).object.id;
}
}  // namespace gpu_planning_scene::core
