#include "moveit/collision_env.h"

#include <algorithm>
#include <atomic>
#include <optional>
#include <utility>

#include "moveit/pairs/workspace.h"
#include "moveit/queries/collision_query.h"
#include "moveit/queries/continuous_check.h"
#include "moveit/queries/distance_query.h"
#include "moveit/shapes/log.h"

// MoveIt's states hold the poses of all links, so a check begins with the bounds of the links' shapes. Pairs whose
// bounds overlap go through the filter, and the exact tests decide the rest.
namespace gpu_planning_scene::detector
{
namespace
{
using collision_detection::AllowedCollisionMatrix;
using collision_detection::CollisionRequest;
using collision_detection::CollisionResult;
using collision_detection::DistanceRequest;
using collision_detection::DistanceResult;
using collision_detection::World;
using collision_detection::WorldPtr;
using moveit::core::RobotState;

/// A state whose link poses are valid: the state itself, or an updated copy. MoveIt's other detectors use old poses.
class UpdatedState
{
 public:
  explicit UpdatedState(const RobotState& state) : state_(state)
  {
    if (state.dirtyCollisionBodyTransforms())
      copy_.emplace(state).update();
  }

  const RobotState& operator*() const { return copy_ ? *copy_ : state_; }

 private:
  const RobotState& state_;
  std::optional<RobotState> copy_;
};

DistanceRequest distanceRequestOf(const CollisionRequest& request, const AllowedCollisionMatrix* matrix,
                                  const moveit::core::RobotModelConstPtr& robot)
{
  DistanceRequest distance;
  distance.group_name = request.group_name;
  distance.acm = matrix;
  distance.enableGroup(robot);
  return distance;
}

/// The distance of a check of the robot and that of a check of itself go into one result, so the smaller one stays.
void addDistance(const CollisionRequest& request, const DistanceResult& found, CollisionResult& result)
{
  result.distance = std::min(result.distance, found.minimum_distance.distance);
  if (!request.detailed_distance)
    return;
  DistanceResult& known = result.distance_result;
  known.collision = known.collision || found.collision;
  if (found.minimum_distance.distance < known.minimum_distance.distance)
    known.minimum_distance = found.minimum_distance;
  known.distances.insert(found.distances.begin(), found.distances.end());
}
/// A pair of shape instances of a distance request.
struct Candidate
{
  double least;  // lower bound of the distance
  const ShapeInstance* a;
  ShapeInstance b;
};

void measureNearestFirst(std::vector<Candidate>& candidates, DistanceQuery& query)
{
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.least < b.least; });
  for (const Candidate& candidate : candidates)
  {
    if (query.isDone())
      return;
    query.measure(*candidate.a, candidate.b);
  }
}
}  // namespace

CollisionEnv::CollisionEnv(const moveit::core::RobotModelConstPtr& model, double padding, double scale)
  : collision_detection::CollisionEnv(model, padding, scale),
    robot_(std::make_shared<const RobotGeometry>(*model, getLinkPadding(), getLinkScale())),
    world_(std::make_shared<WorldGeometry>())
{
  observeWorld();
}

CollisionEnv::CollisionEnv(const moveit::core::RobotModelConstPtr& model, const WorldPtr& world, double padding,
                           double scale)
  : collision_detection::CollisionEnv(model, world, padding, scale),
    robot_(std::make_shared<const RobotGeometry>(*model, getLinkPadding(), getLinkScale())),
    world_(std::make_shared<WorldGeometry>())
{
  observeWorld();
  getWorld()->notifyObserverAllObjects(observer_, World::CREATE);
}

CollisionEnv::CollisionEnv(const CollisionEnv& other, const WorldPtr& world)
  : collision_detection::CollisionEnv(other, world), robot_(other.robot_), world_(other.world_)
{
  observeWorld();
}

CollisionEnv::~CollisionEnv()
{
  getWorld()->removeObserver(observer_);
}

void CollisionEnv::observeWorld()
{
  observer_ = getWorld()->addObserver(
      [this](const World::ObjectConstPtr& object, World::Action action)
      {
        if (action == World::DESTROY)
        {
          changedWorld().remove(object->id_);
          forgetUnusedShapes();
        }
        else if (action == World::MOVE_SHAPE)
          changedWorld().move(*object);
        else
          changedWorld().set(*object);
      });
}

/// The geometry of the world, as a copy if another environment has it too.
WorldGeometry& CollisionEnv::changedWorld()
{
  if (world_.use_count() > 1)
    world_ = std::make_shared<WorldGeometry>(*world_);
  else
    std::atomic_thread_fence(
        std::memory_order_acquire);  // reads of an environment that has just given it up come first
  return *world_;
}

void CollisionEnv::setWorld(const WorldPtr& world)
{
  if (world == getWorld())
    return;
  getWorld()->removeObserver(observer_);
  collision_detection::CollisionEnv::setWorld(world);
  world_ = std::make_shared<WorldGeometry>();
  observeWorld();
  getWorld()->notifyObserverAllObjects(observer_, World::CREATE);
  forgetUnusedShapes();
}

void CollisionEnv::updatedPaddingOrScaling(const std::vector<std::string>& links)
{
  for (const std::string& link : links)
    if (!robot_model_->hasLinkModel(link))
      ROS_ERROR_STREAM_NAMED(kLogName, "Padding or scale of '" << link << "': the robot has no such link");
  robot_ = std::make_shared<const RobotGeometry>(*robot_model_, getLinkPadding(), getLinkScale());
}

void CollisionEnv::checkSelfCollision(const CollisionRequest& request, CollisionResult& result,
                                      const RobotState& state) const
{
  checkSelf(request, result, state, nullptr);
}

void CollisionEnv::checkSelfCollision(const CollisionRequest& request, CollisionResult& result, const RobotState& state,
                                      const AllowedCollisionMatrix& matrix) const
{
  checkSelf(request, result, state, &matrix);
}

void CollisionEnv::checkRobotCollision(const CollisionRequest& request, CollisionResult& result,
                                       const RobotState& state) const
{
  checkRobot(request, result, state, nullptr);
}

void CollisionEnv::checkRobotCollision(const CollisionRequest& request, CollisionResult& result,
                                       const RobotState& state, const AllowedCollisionMatrix& matrix) const
{
  checkRobot(request, result, state, &matrix);
}

void CollisionEnv::checkRobotCollision(const CollisionRequest& request, CollisionResult& result, const RobotState& from,
                                       const RobotState& to, const AllowedCollisionMatrix& matrix) const
{
  checkMotion(request, result, from, to, &matrix);
}

void CollisionEnv::checkRobotCollision(const CollisionRequest& request, CollisionResult& result, const RobotState& from,
                                       const RobotState& to) const
{
  checkMotion(request, result, from, to, nullptr);
}

void CollisionEnv::checkSelf(const CollisionRequest& request, CollisionResult& result, const RobotState& state,
                             const AllowedCollisionMatrix* matrix) const
{
  const UpdatedState updated(state);
  const PairFilter filter(matrix, PairFilter::activeLinks(*robot_model_, request.group_name));
  Workspace work;
  robot_->place(*updated, nullptr, work->instances, work->attached);
  const std::vector<ShapeInstance>& instances = work->instances;
  CollisionQuery query(request, result, filter, work->pair);
  for (std::size_t i = 0; i < instances.size() && !query.isDone(); ++i)
  {
    const bool is_active = filter.isActive(instances[i].body);
    for (std::size_t j = i + 1; j < instances.size(); ++j)
      if (instances[i].bounds.intersects(instances[j].bounds) && (is_active || filter.isActive(instances[j].body)) &&
          query.test(instances[i], instances[j]))
        break;
  }
  if (!request.distance)
    return;
  DistanceResult distance;
  distanceSelf(distanceRequestOf(request, matrix, robot_model_), distance, *updated);
  addDistance(request, distance, result);
}

void CollisionEnv::checkRobot(const CollisionRequest& request, CollisionResult& result, const RobotState& state,
                              const AllowedCollisionMatrix* matrix) const
{
  const UpdatedState updated(state);
  const auto* active = PairFilter::activeLinks(*robot_model_, request.group_name);
  const PairFilter filter(matrix, active);
  if (!world_->empty())
  {
    Workspace work;
    robot_->place(*updated, active, work->instances, work->attached);
    CollisionQuery query(request, result, filter, work->pair);
    for (const ShapeInstance& instance : work->instances)
      if (world_->visitNear(instance.bounds, work->nodes,
                            [&](const ShapeInstance& object) { return query.test(instance, object); }))
        break;
  }
  if (!request.distance)
    return;
  DistanceResult distance;
  distanceRobot(distanceRequestOf(request, matrix, robot_model_), distance, *updated);
  addDistance(request, distance, result);
}

void CollisionEnv::checkMotion(const CollisionRequest& request, CollisionResult& result, const RobotState& from,
                               const RobotState& to, const AllowedCollisionMatrix* matrix) const
{
  const UpdatedState updated_from(from);
  const UpdatedState updated_to(to);
  const auto* active = PairFilter::activeLinks(*robot_model_, request.group_name);
  const PairFilter filter(matrix, active);
  detector::checkMotion(request, result, *updated_from, *updated_to, *robot_, *world_, filter, active);
}

void CollisionEnv::distanceSelf(const DistanceRequest& request, DistanceResult& result, const RobotState& state) const
{
  const UpdatedState updated(state);
  const PairFilter filter(request.acm, request.active_components_only);
  Workspace work;
  robot_->place(*updated, nullptr, work->instances, work->attached);
  const std::vector<ShapeInstance>& instances = work->instances;
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < instances.size(); ++i)
    for (std::size_t j = i + 1; j < instances.size(); ++j)
      candidates.push_back({leastDistance(instances[i], instances[j]), &instances[i], instances[j]});
  DistanceQuery query(request, result, filter, work->pair);
  measureNearestFirst(candidates, query);
}

void CollisionEnv::distanceRobot(const DistanceRequest& request, DistanceResult& result, const RobotState& state) const
{
  const UpdatedState updated(state);
  const PairFilter filter(request.acm, request.active_components_only);
  Workspace work;
  robot_->place(*updated, request.active_components_only, work->instances, work->attached);
  std::vector<Candidate> candidates;
  for (const ShapeInstance& instance : work->instances)
    world_->visitAll(
        [&](const ShapeInstance& object) {
          candidates.push_back({leastDistance(instance, object), &instance, object});
        });
  DistanceQuery query(request, result, filter, work->pair);
  measureNearestFirst(candidates, query);
}
}  // namespace gpu_planning_scene::detector
