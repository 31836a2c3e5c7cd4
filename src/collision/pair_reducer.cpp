#include "collision/pair_reducer.h"

#include <algorithm>

#include "collision/primitive_solid.h"

namespace gpu_planning_scene
{
namespace
{
std::size_t countObjects(const CheckedPairs& pairs, std::size_t objects)
{
  std::vector<bool> seen(objects, false);
  for (const CheckedPair& pair : pairs.world)
    seen[pair.other] = true;
  return static_cast<std::size_t>(std::count(seen.begin(), seen.end(), true));
}
}  // namespace

const SweptBody& PairReducer::sweptBody(const RobotBody& body)
{
  const auto sweep = [&] { return reach_->sweep(*body.shapes, body.pose, body.link); };
  if (body.attached)
  {
    const auto known = carried_.find(body.attached);
    return known != carried_.end() ? known->second : carried_.emplace(body.attached, sweep()).first->second;
  }
  const auto known = links_.find(body.link);
  return known != links_.end() ? known->second : links_.emplace(body.link, sweep()).first->second;
}

Eigen::AlignedBox3d PairReducer::cachedBox(const Shape& shape, MeshBoxes& used)
{
  const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&shape);
  if (mesh == nullptr)
    return boxOf(shape);
  const auto known = boxes_.find(*mesh);
  return used.emplace(*mesh, known != boxes_.end() ? known->second : boxOf(shape)).first->second;
}

/// In the planning frame, by object.
std::vector<std::vector<Obstacle>> PairReducer::obstaclesOf(const PlanningScene& scene)
{
  MeshBoxes used;
  std::vector<std::vector<Obstacle>> obstacles(scene.objects.size());
  for (std::size_t k = 0; k < scene.objects.size(); ++k)
    for (const PlacedShape& placed : scene.objects[k].shapes)
    {
      const Eigen::Isometry3d pose = scene.objects[k].pose * placed.pose;
      if (const auto* half_space = std::get_if<HalfSpace>(&placed.shape))
      {
        const Eigen::Vector3d normal = (pose.linear() * half_space->normal).normalized();
        obstacles[k].push_back(HalfSpace{normal, half_space->offset + normal.dot(pose.translation())});
      }
      else
      {
        const Eigen::AlignedBox3d box = cachedBox(placed.shape, used);
        obstacles[k].push_back(PlacedBox(pose * Eigen::Translation3d(box.center()), 0.5 * box.sizes()));
      }
    }
  boxes_ = std::move(used);
  return obstacles;
}

std::vector<VariableRange> PairReducer::leaveOutUnreachable(const PlanningScene& scene,
                                                            const std::vector<RobotBody>& bodies, CheckedPairs& pairs,
                                                            SceneReport& report)
{
  if (robot_ != scene.robot)
  {
    links_.clear();
    reach_.emplace(*scene.robot);
    robot_ = scene.robot;
  }
  carried_.clear();
  const std::vector<std::vector<Obstacle>> obstacles = obstaclesOf(scene);
  const std::size_t objects_before = countObjects(pairs, scene.objects.size());

  CheckedPairs left_out;
  takePairs(pairs.self, left_out.self,
            [&](const CheckedPair& pair)
            { return !reach_->mayMeet(sweptBody(bodies[pair.body]), sweptBody(bodies[pair.other]), 0.0); });
  takePairs(pairs.world, left_out.world,
            [&](const CheckedPair& pair)
            {
              const RobotBody& body = bodies[pair.body];
              const Region* region = reach_->inPlanningFrame(sweptBody(body));
              const double padding = scene.link_padding.empty() ? 0.0 : scene.link_padding[body.link];
              const double distance = padding + scene.objects[pair.other].padding;
              return region != nullptr &&
                     std::none_of(obstacles[pair.other].begin(), obstacles[pair.other].end(),
                                  [&](const Obstacle& obstacle) { return mayMeet(*region, obstacle, distance); });
            });

  report.unreachable_self_pairs = countMoved(left_out.self);
  report.unreachable_world_pairs = countMoved(left_out.world);
  report.self_pairs -= report.unreachable_self_pairs;
  report.world_pairs -= report.unreachable_world_pairs;
  report.unreachable_objects = objects_before - countObjects(pairs, scene.objects.size());
  return left_out.self.empty() && left_out.world.empty() ? std::vector<VariableRange>() : reach_->ranges();
}

}  // namespace gpu_planning_scene
