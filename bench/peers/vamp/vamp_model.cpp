#include "peers/vamp/vamp_model.h"

#include <algorithm>
#include <filesystem>

#include "gpu_planning_scene/error.h"
#include "model/real_robots.h"

namespace gpu_planning_scene::core::benchmark
{
VampModel loadVampModel(const RobotModel& robot)
{
  const RealRobot spheres = ur5Spheres();
  if (!spheres.available())
    throw Error("there is no sphere model " + spheres.urdf +
                "; CONTRIBUTING.md (Data that is not in the repository) names its source");
  VampModel model;
  model.robot = spheres.load();
  const auto& variables = robot.variables();
  const auto& others = model.robot->variables();
  if (!std::equal(variables.begin(), variables.end(), others.begin(), others.end(),
                  [](const Variable& a, const Variable& b) { return a.name == b.name; }))
    throw Error(spheres.urdf + ": its joints are not those of " + robot.name());
  model.pairs =
      readVampPairs((std::filesystem::path(spheres.urdf).parent_path() / "include/vamp/robots/ur5.hh").string());
  return model;
}

PlanningScene withSpheres(const PlanningScene& scene, const VampModel& model)
{
  PlanningScene made(model.robot);
  made.objects = scene.objects;
  made.allowed_collisions = AllowedCollisionMatrix();
  const std::vector<Link>& links = model.robot->links();
  for (std::size_t i = 0; i < links.size(); ++i)
    for (std::size_t k = i + 1; k < links.size(); ++k)
      made.allowed_collisions.setEntry(links[i].name, links[k].name,
                                       model.pairs.count(linkPair(links[i].name, links[k].name)) == 0);
  return made;
}
}  // namespace gpu_planning_scene::core::benchmark
