#include "collision/filter/lanes/lane_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "collision/filter/lanes/lane_objects.h"
#include "collision/geometry/outward_rounding.h"
#include "model/math_constants.h"

// Links that are rigidly connected share a frame, which has the balls of their shapes. The rounding errors of the
// frames add up from the root to the tips. Each threshold includes them (docs/error_bounds.md, "The lane kernel"). Own
// method.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

// The error bounds are derived in docs/error_bounds.md, "The lane kernel".
constexpr double kUnit = 0x1p-24;               // rounding unit of float
constexpr double kTurnError = 1.5e-6;           // of a vector of length 1 that a turning joint rotates
constexpr double kProductError = 12.0 * kUnit;  // of a vector of length 1, by the product of two rotations
constexpr double kSumError = 12.0 * kUnit;      // of a transformed point, times its largest coordinates
constexpr double kDistanceError = 32.0 * kUnit;
constexpr double kAxisError = 16.0 * kUnit;  // of an axis of a box: a rounded constant, transformed

constexpr double kConstantError = 4.0 * kUnit;     // of a vector of length 1, by a rounded constant rotation
constexpr double kQuaternionError = 64.0 * kUnit;  // of a vector of length 1 that a quaternion rotates

constexpr double kLargestLaneAngle = 1e4;    // radians: a larger angle modulo 2 pi is not accurate
constexpr double kLargestBaseSlide = 32.0;   // metres, along each direction of a planar or floating joint
constexpr double kLargestCoefficient = 1e6;  // of a quaternion
constexpr std::size_t kGroup = 8;            // world pairs of a group

Matrix3d crossProductMatrix(const Vector3d& a)
{
  Matrix3d matrix;
  matrix << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return matrix;
}

void writeRotation(const Matrix3d& rotation, float* rows)
{
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      rows[4 * row + column] = static_cast<float>(rotation(row, column));
}

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

LaneScene::LaneScene(std::shared_ptr<const RobotModel> robot, const CollisionProblem& problem, const CpuForest& forest,
                     std::shared_ptr<const RobotProofs> proofs)
  : robot_(std::move(robot)), proofs_(std::move(proofs)), origin_(problem.origin)
{
  addFrames();
  for (std::size_t i = 0; i < problem.robot.size(); ++i)
    addInstance(problem.robot[i], *proofs_->covers[i], forest.tree(problem.robot[i].tree).box);
  addClusters();
  addSelfPairs(problem);
  addWorld(problem, forest);
  model_ = {robot_->variables().size(), arrayOf(frames_),      arrayOf(instances_),  arrayOf(objects_),
            arrayOf(tables_),           arrayOf(clusters_),    arrayOf(self_pairs_), arrayOf(self_groups_),
            arrayOf(world_pairs_),      arrayOf(world_groups_)};
}

/// Links that are rigidly connected share a frame.
void LaneScene::addFrames()
{
  limits_.resize(robot_->variables().size());
  for (std::size_t link = 0; link < robot_->links().size(); ++link)
  {
    const int number = robot_->links()[link].parent_joint;
    const Joint fixed;
    const Joint& joint = number < 0 ? fixed : robot_->joints()[static_cast<std::size_t>(number)];
    const bool has_parent = joint.parent_link >= 0;
    const auto parent = static_cast<std::size_t>(joint.parent_link);
    Isometry3d base = Isometry3d::Identity();
    base.translation() = -origin_;
    const Isometry3d origin = (has_parent ? in_frame_[parent] : base) * joint.origin;
    if (joint.type == JointType::Fixed && has_parent)
    {
      frame_of_link_.push_back(frame_of_link_[parent]);
      in_frame_.push_back(origin);
      continue;
    }
    frame_of_link_.push_back(addFramesOf(joint, has_parent ? frame_of_link_[parent] : -1, origin));
    in_frame_.push_back(Isometry3d::Identity());
  }
}

/// Adds the frames that a joint moves, and returns the last of them. `origin`: the joint's frame in the parent frame.
int LaneScene::addFramesOf(const Joint& joint, int parent, const Isometry3d& origin)
{
  const int v = joint.first_variable;
  const Isometry3d here = Isometry3d::Identity();
  // The position of a base is relative to the point that is nearest to the origin of coordinates.
  const Vector3d nearest =
      parent < 0 ? Vector3d(origin.linear().transpose() * -origin.translation()) : Vector3d::Zero();
  const auto slide_base = [&](const Vector3d& axis, int variable, const Isometry3d& from) {
    parent = addSlide({axis, variable, nearest.dot(axis), kLargestBaseSlide}, parent, from);
  };
  switch (joint.type)
  {
    case JointType::Revolute:
    case JointType::Continuous:
      return addTurn(joint, v, parent, origin);
    case JointType::Prismatic:
    {
      const Variable& limits = robot_->variables()[static_cast<std::size_t>(v)];
      const double farthest = std::max(std::abs(limits.lower), std::abs(limits.upper)) + 1e-6;
      return addSlide({joint.axis, v, 0.0, farthest, joint.multiplier, joint.offset}, parent, origin);
    }
    case JointType::Planar:
    {
      const Matrix3d directions = planarDirections(joint.axis);
      slide_base(directions.col(0), v, origin);
      slide_base(directions.col(1), v + 1, here);
      return addTurn(joint, v + 2, parent, here);
    }
    case JointType::Floating:
      slide_base(Vector3d::UnitX(), v, origin);
      slide_base(Vector3d::UnitY(), v + 1, here);
      slide_base(Vector3d::UnitZ(), v + 2, here);
      return addQuaternion(v + 3, parent);
    case JointType::Fixed:
      break;
  }
  lanes::Frame frame{};
  frame.kind = lanes::FrameKind::Fixed;
  writePose(origin, frame.constant);
  return addFrame(frame, parent, origin.translation().norm(), kConstantError);
}

/// Adds a frame. `step`: the largest distance of its origin from the parent's; `turn`: the error of its rotation, of a
/// vector of length 1.
int LaneScene::addFrame(lanes::Frame frame, int parent, double step, double turn)
{
  frame.parent = parent;
  const FrameError before = parent < 0 ? FrameError() : frame_errors_[static_cast<std::size_t>(parent)];
  frames_.push_back(frame);
  frame_errors_.push_back({step, before.largest_distance + step, before.rotation + turn + kProductError,
                           before.position + before.rotation * step + kSumError * (before.largest_distance + step)});
  return static_cast<int>(frames_.size()) - 1;
}

/// A frame that turns about the joint's axis.
int LaneScene::addTurn(const Joint& joint, int variable, int parent, const Isometry3d& origin)
{
  lanes::Frame frame{};
  frame.kind = lanes::FrameKind::Revolute;
  frame.variable = variable;
  frame.multiplier = joint.multiplier;
  frame.offset = joint.offset;
  const Matrix3d rotation = origin.linear();
  const Matrix3d along = joint.axis * joint.axis.transpose();
  writePose(origin, frame.constant);
  writeRotation(rotation * along, frame.constant);
  writeRotation(rotation * (Matrix3d::Identity() - along), frame.first);
  writeRotation(rotation * crossProductMatrix(joint.axis), frame.second);
  limit(variable, {0.0, (kLargestLaneAngle - std::abs(joint.offset)) / std::max(1.0, std::abs(joint.multiplier))});
  return addFrame(frame, parent, origin.translation().norm(), kTurnError);
}

/// A frame that slides along an axis. Its position is computed relative to that for the slide's middle.
int LaneScene::addSlide(const Slide& slide, int parent, const Isometry3d& origin)
{
  const Vector3d axis = origin.linear() * slide.axis;
  Isometry3d middle = origin;
  middle.translation() += (slide.multiplier * slide.middle + slide.offset) * axis;
  lanes::Frame frame{};
  frame.kind = lanes::FrameKind::Prismatic;
  frame.variable = slide.variable;
  frame.multiplier = slide.multiplier;
  frame.offset = -slide.multiplier * slide.middle;
  writePose(middle, frame.constant);
  writePose(Eigen::Isometry3d(Eigen::Translation3d(axis)), frame.first);
  limit(slide.variable, {slide.middle, slide.most});
  return addFrame(frame, parent, middle.translation().norm() + std::abs(slide.multiplier) * slide.most, kConstantError);
}

/// A frame that turns by a quaternion, whose x is the variable.
int LaneScene::addQuaternion(int variable, int parent)
{
  lanes::Frame frame{};
  frame.kind = lanes::FrameKind::Turned;
  frame.variable = variable;
  for (int k = 0; k < 4; ++k)
    limit(variable + k, {0.0, kLargestCoefficient});
  return addFrame(frame, parent, 0.0, kQuaternionError);
}

/// Variables of several joints, which are mimicked, have the middle 0.
void LaneScene::limit(int variable, const Limit& limit)
{
  Limit& known = limits_[static_cast<std::size_t>(variable)];
  known = {limit.middle, std::min(known.most, limit.most)};
}

static_assert(kCoverBalls.size() == lanes::kLevels + 1, "levels of the kernel");

void LaneScene::addInstance(const ShapeInstance& instance, const BallCover& cover, const OrientedBox& box)
{
  const auto link = static_cast<std::size_t>(instance.link);
  const Isometry3d pose = in_frame_[link] * instance.pose;
  lanes::Instance made{};
  made.frame = frame_of_link_[link];
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
  const FrameError& frame = frame_errors_[static_cast<std::size_t>(made.frame)];
  instance_errors_.push_back(
      {frame.largest_distance + largest_distance,
       frame.position + frame.rotation * largest_distance + kSumError * (frame.largest_distance + largest_distance)});
  box_errors_.push_back({frame.rotation + kAxisError, box.half.norm()});
}

/// See docs/error_bounds.md, "The lane kernel", "Boxes".
lanes::BoxThresholds LaneScene::boxThresholds(std::uint32_t a, std::uint32_t b) const
{
  const double rotation = box_errors_[a].rotation + box_errors_[b].rotation + 8.0 * kUnit;
  const double centers = instance_errors_[a].largest_distance + instance_errors_[b].largest_distance;
  const double lengths = centers + box_errors_[a].radius + box_errors_[b].radius;
  const double between = instance_errors_[a].position + instance_errors_[b].position + rotation * centers;
  return {floatAbove(2.0 * between + (2.0 * rotation + 32.0 * kUnit) * lengths),
          floatAbove(4.0 * rotation + 32.0 * kUnit)};
}

double LaneScene::selfError(std::uint32_t a, std::uint32_t b) const
{
  const InstanceError& first = instance_errors_[a];
  const InstanceError& second = instance_errors_[b];
  const double lengths =
      first.largest_distance + second.largest_distance + static_cast<double>(instances_[a].outer + instances_[b].outer);
  return first.position + second.position + kDistanceError * lengths;
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
  std::vector<Part> parts(frames_.size());
  for (const lanes::Instance& instance : instances_)
  {
    Part& part = parts[static_cast<std::size_t>(instance.frame)];
    const auto outer = static_cast<double>(instance.outer);
    part.radius =
        std::max(part.radius, Eigen::Map<const Eigen::Vector3f>(instance.center).cast<double>().norm() + outer);
    part.largest = std::max(part.largest, outer);
    ++part.instances;
  }
  for (std::size_t f = frames_.size(); f-- > 0;)  // parents have smaller numbers
    if (const int parent = frames_[f].parent; parent >= 0 && parts[f].instances > 0)
    {
      Part& part = parts[static_cast<std::size_t>(parent)];
      part.radius = std::max(part.radius, frame_errors_[f].step + parts[f].radius);
      part.largest = std::max(part.largest, parts[f].largest);
      part.instances += parts[f].instances;
    }
  const std::size_t most = instances_.size() / 2;
  for (std::size_t f = 0; f < frames_.size(); ++f)
  {
    const int parent = frames_[f].parent;
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
    InstanceError error;
    double radius;
  };
  const auto placed = [&](std::uint32_t center)
  {
    if (center < instances)
      return Placed{instance_errors_[center], static_cast<double>(instances_[center].outer)};
    const lanes::Cluster& cluster = clusters_[center - instances];
    const FrameError& frame = frame_errors_[static_cast<std::size_t>(cluster.frame)];
    return Placed{{frame.largest_distance, frame.position}, static_cast<double>(cluster.radius)};
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
                         kDistanceError * (a.error.largest_distance + b.error.largest_distance + a.radius + b.radius);
    const bool is_tested = end - p > 1 && centers.first != centers.second;
    self_groups_.push_back(
        {{centers.first, centers.second},
         is_tested ? floatAbove(a.radius + b.radius + error) : std::numeric_limits<float>::infinity(),
         p,
         end});
    p = end;
  }
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
      lanes::WorldGroup group{b, first, end, {}, {}};
      for (int axis = 0; axis < 3; ++axis)
      {
        group.center[axis] = static_cast<float>(bounds.center()[axis]);
        const double rounding = 4.0 * kUnit * (std::abs(bounds.center()[axis]) + 0.5 * bounds.sizes()[axis]);
        group.half[axis] = floatAbove(0.5 * bounds.sizes()[axis] + rounding);
      }
      world_groups_.push_back(group);
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
                           kDistanceError * (instance_errors_[b].largest_distance + object.largest_distance + required +
                                             static_cast<double>(instances_[b].outer));
      const double layer = object.thickness > cover.layer ? 0.0 : cover.layer;
      const lanes::Thresholds thresholds = {floatAbove(required + error), floatAbove(required + layer + error),
                                            floatBelow(required - error)};
      const Vector3d growth = Vector3d::Constant(static_cast<double>(thresholds.enclosing));
      bounds.extend(object.bounds.min() - growth);
      bounds.extend(object.bounds.max() + growth);
      world_pairs_.push_back({b, o, thresholds});
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

bool LaneScene::isWithinBounds(const double* state) const
{
  for (std::size_t v = 0; v < limits_.size(); ++v)
    if (!(std::abs(state[v] - limits_[v].middle) <= limits_[v].most))
      return false;
  return true;
}
}  // namespace gpu_planning_scene::core
