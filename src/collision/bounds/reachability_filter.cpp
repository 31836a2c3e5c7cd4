#include "collision/bounds/reachability_filter.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "collision/geometry/shape_bounds.h"
#include "model/rigid_pose.h"

// Compares the swept bodies of Reach with each other and with the objects of the world. A new scene invalidates only
// the rows and columns of the objects that have changed. Own method. MoveIt's Setup Assistant leaves out pairs that
// collide in no random state; here, the bounds of Reach prove that a pair never collides.
namespace gpu_planning_scene::core
{
namespace
{
bool sameGeometry(const WorldObject& a, const WorldObject& b)
{
  return a.pose.matrix() == b.pose.matrix() && a.padding == b.padding &&
         std::equal(
             a.shapes.begin(), a.shapes.end(), b.shapes.begin(), b.shapes.end(),
             [](const PlacedShape& x, const PlacedShape& y)
             {
               return !std::holds_alternative<HalfSpace>(x.shape) && x.shape.index() == y.shape.index() &&
                      x.pose.matrix() == y.pose.matrix() && sameShape(x.shape, y.shape);
             });
}

bool sameAttachedGeometry(const AttachedObject& a, const AttachedObject& b)
{
  return a.link == b.link && a.padding == b.padding && a.scaled_shapes == b.scaled_shapes &&
         sameGeometry(a.object, b.object);
}

/// Counts the objects that occur in at least one pair.
class ObjectCount
{
 public:
  explicit ObjectCount(std::size_t objects) : seen_(objects, 0) {}
  void add(const CheckedPair& pair, bool counts) { seen_[pair.other] |= static_cast<std::uint8_t>(counts); }
  std::size_t count() const { return static_cast<std::size_t>(std::count(seen_.begin(), seen_.end(), 1)); }

 private:
  std::vector<std::uint8_t> seen_;
};

/// Removes the pairs for which leaves(pair) is true. Returns their number.
template <class Predicate>
std::size_t removePairs(std::vector<CheckedPair>& pairs, const Predicate& leaves)
{
  const std::size_t before = pairs.size();
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), leaves), pairs.end());
  return before - pairs.size();
}
}  // namespace

std::size_t ReachabilityFilter::moverOf(const PlanningScene& scene, const RobotBody& body) const
{
  return body.attached ? robot_->links().size() + static_cast<std::size_t>(body.attached - scene.attached.data())
                       : static_cast<std::size_t>(body.link);
}

const SweptBody& ReachabilityFilter::sweptBody(const RobotBody& body, std::size_t mover)
{
  if (!swept_[mover])
    swept_[mover] = reach_->sweep(*body.shapes, body.pose, body.link);
  return *swept_[mover];
}

Eigen::AlignedBox3d ReachabilityFilter::cachedBox(const Shape& shape)
{
  const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&shape);
  if (mesh == nullptr)
    return boundsOf(shape);
  const auto known = boxes_.find(mesh->get());
  if (known != boxes_.end() && known->second.mesh.lock() == *mesh)
    return known->second.box;
  return boxes_.insert_or_assign(mesh->get(), KnownBox{*mesh, boundsOf(shape)}).first->second.box;
}

std::vector<Obstacle> ReachabilityFilter::obstaclesOf(const WorldObject& object)
{
  std::vector<Obstacle> obstacles;
  for (const PlacedShape& placed : object.shapes)
  {
    const Eigen::Isometry3d pose = rigidProduct(object.pose, placed.pose);
    if (const auto* half_space = std::get_if<HalfSpace>(&placed.shape))
      obstacles.emplace_back(moved(*half_space, pose));
    else
    {
      const Eigen::AlignedBox3d box = cachedBox(placed.shape);
      obstacles.emplace_back(PlacedBox(pose * Eigen::Translation3d(box.center()), 0.5 * box.sizes()));
    }
  }
  return obstacles;
}

void ReachabilityFilter::takeRobot(const std::shared_ptr<const RobotModel>& robot)
{
  if (robot_ == robot)
    return;
  robot_.reset();  // first: if a line below throws, the next call starts anew
  swept_.clear();
  carried_.clear();
  objects_.clear();
  near_movers_.resize(0, 0);
  near_objects_.resize(0, 0);
  reach_.emplace(*robot);
  robot_ = robot;
}

void ReachabilityFilter::keepCarried(const PlanningScene& scene)
{
  const std::size_t links = robot_->links().size();
  const std::size_t movers = links + scene.attached.size();
  const std::size_t kept = std::min(carried_.size(), scene.attached.size());
  carried_.resize(kept);
  near_movers_.resize(movers, movers);
  swept_.resize(movers);
  for (std::size_t i = 0; i < scene.attached.size(); ++i)
  {
    const AttachedObject& attached = scene.attached[i];
    if (i < kept && sameAttachedGeometry(carried_[i], attached))
      continue;
    swept_[links + i].reset();
    near_movers_.forgetRow(links + i);
    near_movers_.forgetColumn(links + i);
    near_objects_.forgetColumn(links + i);
    if (i < kept)
      carried_[i] = attached;
    else
      carried_.push_back(attached);
  }
}

void ReachabilityFilter::keepObjects(const PlanningScene& scene)
{
  for (auto known = boxes_.begin(); known != boxes_.end();)
    known = known->second.mesh.expired() ? boxes_.erase(known) : std::next(known);
  const std::size_t kept = std::min(objects_.size(), scene.objects.size());
  objects_.resize(kept);
  objects_.reserve(scene.objects.size());
  for (std::size_t k = 0; k < scene.objects.size(); ++k)
  {
    const WorldObject& object = scene.objects[k];
    if (k < kept && sameGeometry(objects_[k].object, object))
      continue;
    near_objects_.forgetRow(k);
    KnownObject known{object, obstaclesOf(object)};
    if (k < kept)
      objects_[k] = std::move(known);
    else
      objects_.push_back(std::move(known));
  }
}

/// Updates the caches for a new scene. It first removes the outdated results and then stores the new objects, so that
/// the caches stay valid if a line throws.
void ReachabilityFilter::keepWhatStays(const PlanningScene& scene)
{
  near_objects_.resize(scene.objects.size(), robot_->links().size() + scene.attached.size());
  if (link_padding_ != scene.link_padding)
    near_objects_.clear();
  link_padding_ = scene.link_padding;
  keepCarried(scene);
  keepObjects(scene);
}

bool ReachabilityFilter::mayMeet(const PlanningScene& scene, const RobotBody& body, std::size_t mover,
                                 std::size_t object)
{
  const Region* region = reach_->inPlanningFrame(sweptBody(body, mover));
  const double distance = body.padding + scene.objects[object].padding;
  const std::vector<Obstacle>& obstacles = objects_[object].obstacles;
  return region == nullptr || std::any_of(obstacles.begin(), obstacles.end(),
                                          [&](const Obstacle& obstacle)
                                          { return gpu_planning_scene::core::mayMeet(*region, obstacle, distance); });
}

std::vector<VariableRange> ReachabilityFilter::leaveOutUnreachable(const PlanningScene& scene,
                                                                   const std::vector<RobotBody>& bodies,
                                                                   CheckedPairs& pairs, SceneReport& report)
{
  takeRobot(scene.robot);
  keepWhatStays(scene);
  std::vector<std::size_t> movers;
  for (const RobotBody& body : bodies)
    movers.push_back(moverOf(scene, body));

  const std::size_t self =
      removePairs(pairs.self,
                  [&](const CheckedPair& pair)
                  {
                    const std::size_t a = movers[pair.body];
                    const std::size_t b = movers[pair.other];
                    const auto may_meet = [&]
                    { return reach_->mayMeet(sweptBody(bodies[pair.body], a), sweptBody(bodies[pair.other], b), 0.0); };
                    const bool leaves = !near_movers_.mayBeNear(a, b, may_meet);
                    report.unreachable_self_pairs += leaves && pair.moved ? 1 : 0;
                    return leaves;
                  });
  ObjectCount before(scene.objects.size());
  ObjectCount after(scene.objects.size());
  const std::size_t world =
      removePairs(pairs.world,
                  [&](const CheckedPair& pair)
                  {
                    const std::size_t mover = movers[pair.body];
                    const bool leaves = !near_objects_.mayBeNear(
                        pair.other, mover, [&] { return mayMeet(scene, bodies[pair.body], mover, pair.other); });
                    report.unreachable_world_pairs += leaves && pair.moved ? 1 : 0;
                    before.add(pair, true);
                    after.add(pair, !leaves);
                    return leaves;
                  });
  report.self_pairs -= report.unreachable_self_pairs;
  report.world_pairs -= report.unreachable_world_pairs;
  report.unreachable_objects = before.count() - after.count();
  return self == 0 && world == 0 ? std::vector<VariableRange>() : reach_->ranges();
}
}  // namespace gpu_planning_scene::core
