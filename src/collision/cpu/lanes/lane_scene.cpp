#include "collision/cpu/lanes/lane_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "collision/cpu/lanes/lane_objects.h"
#include "collision/geometry/outward_rounding.h"

// Each threshold includes the kernel's rounding errors (docs/error_bounds.md, "The lane kernel"). Own method.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kGroup = 8;  // world pairs of a group: at most 32, the bits of the kernel

void writeBall(const Vector3d& center, float radius, int place, lanes::Balls& balls)
{
  balls.x[place] = static_cast<float>(center.x());
  balls.y[place] = static_cast<float>(center.y());
  balls.z[place] = static_cast<float>(center.z());
  balls.radius[place] = radius;
}

/// Upper bound of the distance, in metres, between the balls of two shapes if `inner` is inside `outer`. The balls of
/// each shape contain its surface. A point of the inner surface is in a ball of `outer`, or it is in the uncovered
/// layer of `outer` and so at most as far from a ball as the layer is deep. If `inner` contains a ball that is thicker
/// than both layers, the centre of this ball is in balls of both shapes, and the distance is 0.
double openLayer(const BallCover& outer, const BallCover& inner)
{
  return inner.thickness > std::max(outer.layer, inner.layer) ? 0.0 : outer.layer;
}

template <class T>
lanes::Array<T> arrayOf(const std::vector<T>& values)
{
  return {values.data(), static_cast<std::uint32_t>(values.size())};
}
}  // namespace

LaneScene::LaneScene(const RobotModel& robot, const CollisionProblem& problem, const CpuForest& forest,
                     std::shared_ptr<const RobotProofs> proofs, const lanes::Rounding& rounding)
  : rounding_(rounding), proofs_(std::move(proofs)), origin_(problem.origin), frames_(robot, problem.origin, rounding)
{
  for (std::size_t i = 0; i < problem.robot.size(); ++i)
    addInstance(problem.robot[i], *proofs_->covers[i], forest.tree(problem.robot[i].tree).box);
  addClusters();
  findLinkCenters(problem);
  addSelfPairs(problem);
  addWorld(problem, forest);
  model_ = {robot.variables().size(), frames_.base(),        arrayOf(frames_.frames()), arrayOf(instances_),
            arrayOf(objects_),        arrayOf(tables_),      arrayOf(clusters_),        arrayOf(self_pairs_),
            arrayOf(self_groups_),    arrayOf(world_pairs_), arrayOf(world_groups_)};
}

static_assert(kCoverBalls.size() == lanes::kLevels + 1, "levels of the kernel");

void LaneScene::addInstance(const ShapeInstance& instance, const BallCover& cover, const OrientedBox& box)
{
  const auto link = static_cast<std::size_t>(instance.link);
  const Isometry3d pose = frames_.poseInFrame(link) * instance.pose;
  lanes::Instance made{};
  made.frame = frames_.ofLink(link);
  made.same_centers = true;
  double largest_distance = 0.0;
  const auto is_same = [](const CoverBall& ball) { return ball.witness == ball.center; };
  for (std::size_t level = 1; level < cover.levels.size(); ++level)
  {
    const std::vector<CoverBall>& balls = cover.levels[level];
    made.same_centers = made.same_centers && std::all_of(balls.begin(), balls.end(), is_same);
    const int first = lanes::kLevelBegin[level - 1];
    const int count = lanes::kLevelBegin[level] - first;
    for (int i = 0; i < count; ++i)
    {
      const CoverBall& ball = balls[std::min<std::size_t>(static_cast<std::size_t>(i), balls.size() - 1)];
      writeBall(pose * ball.center, floatAbove(ball.outer), first + i, made.outer_balls);
      writeBall(pose * ball.witness, floatBelow(ball.inner), first + i, made.inner_balls);
      largest_distance = std::max({largest_distance, (pose * ball.center).norm(), (pose * ball.witness).norm()});
    }
  }
  const CoverBall& enclosing = cover.levels[0].front();
  const Vector3d center = pose * enclosing.center;
  for (int axis = 0; axis < 3; ++axis)
    made.center[axis] = static_cast<float>(center[axis]);
  made.outer = floatAbove(enclosing.outer);
  made.inner = is_same(enclosing) ? floatBelow(enclosing.inner) : -1.0F;
  const Matrix3d axes = pose.linear() * box.axes;
  const Vector3d box_center = pose * box.center;
  for (int k = 0; k < 3; ++k)
  {
    for (int axis = 0; axis < 3; ++axis)
      made.box.axes[axis][k] = static_cast<float>(axes(k, axis));
    made.box.center[k] = static_cast<float>(box_center[k]);
    made.box.half[k] = floatAbove(box.half[k]);
  }
  largest_distance = std::max({largest_distance, center.norm(), box_center.norm()});
  instances_.push_back(made);
  const LaneFrameError& frame = frames_.error(made.frame);
  instance_errors_.push_back({made.frame, largest_distance, frame.largest_distance + largest_distance,
                              frame.position_error + frame.rotation_error * largest_distance +
                                  rounding_.sum() * (frame.largest_distance + largest_distance)});
  box_errors_.push_back({frame.rotation_error + rounding_.axis(), box.half.norm()});
}

/// See docs/error_bounds.md, "The lane kernel", "Boxes".
lanes::BoxThresholds LaneScene::boxThresholds(std::uint32_t a, std::uint32_t b) const
{
  const double rotation = box_errors_[a].rotation + box_errors_[b].rotation + 8.0 * rounding_.unit;
  const double centers = distanceBetween(instance_errors_[a], instance_errors_[b]);
  const double lengths = centers + box_errors_[a].radius + box_errors_[b].radius;
  const double between = instance_errors_[a].position + instance_errors_[b].position + rotation * centers;
  return {floatAbove(2.0 * between + (2.0 * rotation + 32.0 * rounding_.unit) * lengths),
          floatAbove(4.0 * rotation + 32.0 * rounding_.unit)};
}

/// An upper bound of the distance between two centres. The distance from the base to the origin of coordinates is not
/// in it.
double LaneScene::distanceBetween(const CenterError& a, const CenterError& b) const
{
  return a.in_frame + frames_.distanceBetween(a.frame, b.frame) + b.in_frame;
}

double LaneScene::selfError(std::uint32_t a, std::uint32_t b) const
{
  const CenterError& first = instance_errors_[a];
  const CenterError& second = instance_errors_[b];
  const double between = distanceBetween(first, second);
  const double lengths = between + static_cast<double>(instances_[a].outer + instances_[b].outer);
  return first.position + second.position + rounding_.distance * lengths +
         rounding_.relative * frames_.error(first.frame).rotation_error * between;
}

/// Finds clusters. A cluster is all instances that a frame moves, if a ball around the origin of the frame contains
/// them and is not much larger than the largest instance. Pairs within a cluster are always tested, so a cluster of
/// most of the robot would be of no use.
void LaneScene::addClusters()
{
  constexpr double kLargestCluster = 3.0;  // radius relative to the largest instance
  struct Part
  {
    double radius = 0.0;
    double largest = 0.0;
    std::size_t instances = 0;
  };
  const std::vector<lanes::Frame>& frames = frames_.frames();
  std::vector<Part> parts(frames.size());
  for (const lanes::Instance& instance : instances_)
  {
    Part& part = parts[static_cast<std::size_t>(instance.frame)];
    const auto outer = static_cast<double>(instance.outer);
    part.radius =
        std::max(part.radius, Eigen::Map<const Eigen::Vector3f>(instance.center).cast<double>().norm() + outer);
    part.largest = std::max(part.largest, outer);
    ++part.instances;
  }
  for (std::size_t f = frames.size(); f-- > 0;)  // parents have smaller numbers
    if (const int parent = frames[f].parent; parent >= 0 && parts[f].instances > 0)
    {
      Part& part = parts[static_cast<std::size_t>(parent)];
      part.radius = std::max(part.radius, frames_.error(static_cast<int>(f)).step + parts[f].radius);
      part.largest = std::max(part.largest, parts[f].largest);
      part.instances += parts[f].instances;
    }
  const std::size_t most = instances_.size() / 2;
  for (std::size_t f = 0; f < frames.size(); ++f)
  {
    const int parent = frames[f].parent;
    int cluster = parent < 0 ? -1 : cluster_of_frame_[static_cast<std::size_t>(parent)];
    if (cluster < 0 && parts[f].instances > 1 && parts[f].instances <= most &&
        parts[f].radius <= kLargestCluster * parts[f].largest)
    {
      cluster = static_cast<int>(clusters_.size());
      clusters_.push_back({static_cast<int>(f), floatAbove(parts[f].radius * (1.0 + 1e-6))});
    }
    cluster_of_frame_.push_back(cluster);
  }
}

void LaneScene::findLinkCenters(const CollisionProblem& problem)
{
  const auto is_link = [&](std::uint32_t i) { return problem.robot[i].body == problem.robot[i].link; };
  const auto instances = static_cast<std::uint32_t>(instances_.size());
  for (std::uint32_t i = 0; i < instances; ++i)
    if (is_link(i))
      link_centers_.push_back(i);
  for (std::uint32_t c = 0; c < clusters_.size(); ++c)
  {
    bool of_links = true;
    for (std::uint32_t i = 0; i < instances; ++i)
      of_links = of_links && (is_link(i) ||
                              cluster_of_frame_[static_cast<std::size_t>(instances_[i].frame)] != static_cast<int>(c));
    if (of_links)
      link_centers_.push_back(instances + c);
  }
}

bool LaneScene::isOfLinks(const lanes::SelfGroup& group) const
{
  const auto is_placed = [&](std::uint32_t center)
  { return std::binary_search(link_centers_.begin(), link_centers_.end(), center); };
  return is_placed(group.centers[0]) && is_placed(group.centers[1]);
}

/// The number of the centre near which an instance stays.
std::uint32_t LaneScene::centerOf(std::uint32_t instance) const
{
  const int cluster = cluster_of_frame_[static_cast<std::size_t>(instances_[instance].frame)];
  return cluster < 0 ? instance : static_cast<std::uint32_t>(instances_.size()) + static_cast<std::uint32_t>(cluster);
}

void LaneScene::addSelfPair(std::size_t p, const CollisionProblem& problem)
{
  const auto [a, b] = problem.self_pairs[p];
  const double error = selfError(a, b);
  const BallCover& cover_a = *proofs_->covers[a];
  const BallCover& cover_b = *proofs_->covers[b];
  const double layer = std::max(openLayer(cover_a, cover_b), openLayer(cover_b, cover_a));
  self_pairs_.push_back(
      {a, b, {floatAbove(error), floatAbove(layer + error), floatBelow(-error)}, boxThresholds(a, b)});
  pairs_.push_back({a, b});
  self_pair_of_.push_back(p);
}

/// Pairs with a table come first, see lanes::Model. The others are sorted by the centres of their instances.
void LaneScene::addSelfPairs(const CollisionProblem& problem)
{
  std::vector<std::size_t> others;
  for (std::size_t p = 0; p < problem.self_pairs.size(); ++p)
  {
    const JointTable* table = proofs_->tables[p].get();
    if (!table)
    {
      others.push_back(p);
      continue;
    }
    lanes::Table made{};
    made.pair = static_cast<std::uint32_t>(self_pairs_.size());
    made.variables = static_cast<int>(table->variables.size());
    for (std::size_t k = 0; k < table->variables.size(); ++k)
    {
      const TableVariable& variable = table->variables[k];
      made.variable[k] = {variable.variable, variable.wraps, variable.lower, 1.0 / variable.cell_width, variable.cells};
    }
    made.cells = table->cells.data();
    tables_.push_back(made);
    addSelfPair(p, problem);
  }
  const auto centers = [&](std::size_t p)
  {
    const auto [a, b] = problem.self_pairs[p];
    return std::minmax({centerOf(a), centerOf(b)});
  };
  std::stable_sort(others.begin(), others.end(), [&](std::size_t p, std::size_t q) { return centers(p) < centers(q); });
  const auto first = static_cast<std::uint32_t>(self_pairs_.size());
  for (const std::size_t p : others)
    addSelfPair(p, problem);
  addSelfGroups(first);
}

/// Groups the self pairs from `first` on.
void LaneScene::addSelfGroups(std::uint32_t first)
{
  const auto instances = static_cast<std::uint32_t>(instances_.size());
  struct Placed
  {
    CenterError error;
    double radius;
  };
  const auto placed = [&](std::uint32_t center)
  {
    if (center < instances)
      return Placed{instance_errors_[center], static_cast<double>(instances_[center].outer)};
    const lanes::Cluster& cluster = clusters_[center - instances];
    const LaneFrameError& frame = frames_.error(cluster.frame);
    return Placed{{cluster.frame, 0.0, frame.largest_distance, frame.position_error},
                  static_cast<double>(cluster.radius)};
  };
  for (std::uint32_t p = first; p < self_pairs_.size();)
  {
    const auto centers = std::minmax({centerOf(self_pairs_[p].a), centerOf(self_pairs_[p].b)});
    std::uint32_t end = p;
    while (end < self_pairs_.size() &&
           std::minmax({centerOf(self_pairs_[end].a), centerOf(self_pairs_[end].b)}) == centers)
      ++end;
    const Placed a = placed(centers.first);
    const Placed b = placed(centers.second);
    const double error = a.error.position + b.error.position +
                         rounding_.distance * (distanceBetween(a.error, b.error) + a.radius + b.radius);
    const bool is_tested = end - p > 1 && centers.first != centers.second;
    self_groups_.push_back(
        {{centers.first, centers.second},
         is_tested ? floatAbove(a.radius + b.radius + error) : std::numeric_limits<float>::infinity(),
         p,
         end});
    p = end;
  }
}

/// Contains `bounds`, see FrameBox. For its rounding errors, see docs/error_bounds.md, "The lane kernel".
lanes::FrameBox LaneScene::frameBox(const Eigen::AlignedBox3d& bounds) const
{
  lanes::FrameBox box{};
  for (int axis = 0; axis < 3; ++axis)
  {
    box.center[axis] = static_cast<float>(bounds.center()[axis]);
    const double rounding = 4.0 * rounding_.unit * (std::abs(bounds.center()[axis]) + 0.5 * bounds.sizes()[axis]);
    box.half[axis] = floatAbove(0.5 * bounds.sizes()[axis] + rounding);
  }
  return box;
}

void LaneScene::addWorld(const CollisionProblem& problem, const CpuForest& forest)
{
  const std::vector<LaneObject> objects = laneObjects(problem, forest, origin_);
  for (const LaneObject& object : objects)
    objects_.push_back(object.object);
  const std::vector<std::uint32_t> order = nearOrder(objects);
  const auto is_checked = [&](std::size_t instance, std::size_t object)
  {
    return object < problem.world.size()
               ? problem.world_pairs[instance * problem.world.size() + object] != 0
               : problem.half_space_pairs[instance * problem.half_spaces.size() + object - problem.world.size()] != 0;
  };
  for (std::uint32_t b = 0; b < instances_.size(); ++b)
  {
    const BallCover& cover = *proofs_->covers[b];
    Eigen::AlignedBox3d bounds;
    const auto end_group = [&](std::uint32_t first)
    {
      const auto end = static_cast<std::uint32_t>(world_pairs_.size());
      if (first == end)
        return;
      world_groups_.push_back({b, first, end, frameBox(bounds)});
      bounds.setEmpty();
    };
    auto first = static_cast<std::uint32_t>(world_pairs_.size());
    for (const std::uint32_t o : order)
    {
      if (!is_checked(b, o))
        continue;
      const LaneObject& object = objects[o];
      const double required = problem.robot[b].padding + object.padding;
      const double error = instance_errors_[b].position +
                           rounding_.distance * (instance_errors_[b].largest_distance + object.largest_distance +
                                                 required + static_cast<double>(instances_[b].outer));
      const double layer = object.thickness > cover.layer ? 0.0 : cover.layer;
      const lanes::Thresholds thresholds = {floatAbove(required + error), floatAbove(required + layer + error),
                                            floatBelow(required - error)};
      const Vector3d growth = Vector3d::Constant(static_cast<double>(thresholds.enclosing));
      const Eigen::AlignedBox3d box =
          boundsWithin(object, instance_errors_[b].largest_distance + static_cast<double>(instances_[b].outer));
      world_bounds_.emplace_back(box.min() - growth, box.max() + growth);
      bounds.extend(world_bounds_.back());
      const Vector3d radius = Vector3d::Constant(static_cast<double>(instances_[b].outer));
      world_pairs_.push_back(
          {b, o, thresholds, frameBox({world_bounds_.back().min() - radius, world_bounds_.back().max() + radius})});
      pairs_.push_back({b, static_cast<std::uint32_t>(problem.robot.size()) + o});
      if (world_pairs_.size() - first == kGroup)
      {
        end_group(first);
        first = static_cast<std::uint32_t>(world_pairs_.size());
      }
    }
    end_group(first);
  }
}

}  // namespace gpu_planning_scene::core
