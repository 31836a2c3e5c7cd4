#include "collision/pair_reducer.h"

#include <algorithm>

#include "scene/rigid_pose.h"

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

bool sameObject(const WorldObject& a, const WorldObject& b)
{
  return a.pose.matrix() == b.pose.matrix() && a.padding == b.padding &&
         std::equal(a.shapes.begin(), a.shapes.end(), b.shapes.begin(), b.shapes.end(),
                    [](const PlacedShape& x, const PlacedShape& y)
                    {
                      return !std::holds_alternative<HalfSpace>(x.shape) && x.shape.index() == y.shape.index() &&
                             x.pose.matrix() == y.pose.matrix() && sameShape(x.shape, y.shape);
                    });
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
      const Eigen::Isometry3d pose = rigidProduct(scene.objects[k].pose, placed.pose);
      if (const auto* half_space = std::get_if<HalfSpace>(&placed.shape))
        obstacles[k].push_back(moved(*half_space, pose));
      else
      {
        const Eigen::AlignedBox3d box = cachedBox(placed.shape, used);
        obstacles[k].push_back(PlacedBox(pose * Eigen::Translation3d(box.center()), 0.5 * box.sizes()));
      }
    }
  boxes_ = std::move(used);
  return obstacles;
}

/// What is known of objects that are as they were in the scene before.
void PairReducer::keepWhatStays(const PlanningScene& scene)
{
  if (link_padding_ != scene.link_padding)
    near_objects_.clear();
  link_padding_ = scene.link_padding;
  near_objects_.resize(scene.objects.size());
  for (std::size_t k = 0; k < scene.objects.size(); ++k)
    if (near_objects_[k].links.empty() || !sameObject(near_objects_[k].object, scene.objects[k]))
      near_objects_[k] = {scene.objects[k], std::vector<std::optional<bool>>(scene.robot->links().size())};
}

bool PairReducer::mayMeet(const PlanningScene& scene, const RobotBody& body, std::size_t object,
                          const std::vector<Obstacle>& obstacles)
{
  const Region* region = reach_->inPlanningFrame(sweptBody(body));
  const double padding = scene.link_padding.empty() ? 0.0 : scene.link_padding[body.link];
  const double distance = padding + scene.objects[object].padding;
  return region == nullptr || std::any_of(obstacles.begin(), obstacles.end(),
                                          [&](const Obstacle& obstacle)
                                          { return gpu_planning_scene::mayMeet(*region, obstacle, distance); });
}

bool PairReducer::mayMeet(const RobotBody& a, const RobotBody& b)
{
  if (a.attached || b.attached)
    return reach_->mayMeet(sweptBody(a), sweptBody(b), 0.0);
  const auto [entry, is_new] = near_links_.try_emplace({a.link, b.link}, true);
  if (is_new)
    entry->second = reach_->mayMeet(sweptBody(a), sweptBody(b), 0.0);
  return entry->second;
}

std::vector<VariableRange> PairReducer::leaveOutUnreachable(const PlanningScene& scene,
                                                            const std::vector<RobotBody>& bodies, CheckedPairs& pairs,
                                                            SceneReport& report)
{
  if (robot_ != scene.robot)
  {
    robot_.reset();  // should one of the next lines throw
    links_.clear();
    near_links_.clear();
    near_objects_.clear();
    reach_.emplace(*scene.robot);
    robot_ = scene.robot;
  }
  carried_.clear();
  keepWhatStays(scene);
  const std::vector<std::vector<Obstacle>> obstacles = obstaclesOf(scene);
  const std::size_t objects_before = countObjects(pairs, scene.objects.size());

  CheckedPairs left_out;
  takePairs(pairs.self, left_out.self,
            [&](const CheckedPair& pair) { return !mayMeet(bodies[pair.body], bodies[pair.other]); });
  takePairs(pairs.world, left_out.world,
            [&](const CheckedPair& pair)
            {
              const RobotBody& body = bodies[pair.body];
              if (body.attached)
                return !mayMeet(scene, body, pair.other, obstacles[pair.other]);
              std::optional<bool>& near = near_objects_[pair.other].links[static_cast<std::size_t>(body.link)];
              if (!near)
                near = mayMeet(scene, body, pair.other, obstacles[pair.other]);
              return !*near;
            });

  report.unreachable_self_pairs = countMoved(left_out.self);
  report.unreachable_world_pairs = countMoved(left_out.world);
  report.self_pairs -= report.unreachable_self_pairs;
  report.world_pairs -= report.unreachable_world_pairs;
  report.unreachable_objects = objects_before - countObjects(pairs, scene.objects.size());
  return left_out.self.empty() && left_out.world.empty() ? std::vector<VariableRange>() : reach_->ranges();
}
}  // namespace gpu_planning_scene
