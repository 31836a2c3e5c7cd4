#include "collision/problem/collision_problem.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "collision/problem/checked_pairs.h"
#include "collision/problem/shape_key.h"
#include "gpu_planning_scene/error.h"
#include "model/rigid_pose.h"

// A table of shapes finds equal shapes, which share a tree. The instances are those of all groups; the instance pairs
// are only those of one group. Own method.
namespace gpu_planning_scene::core
{
namespace
{
/// Adds the trees of shapes to a problem. If trees are shared, each distinct shape gets one tree.
class TreeTable
{
 public:
  /// `shapes`: the approximate number of shapes.
  TreeTable(CollisionProblem& problem, bool share, TessellationCache& tessellations, std::size_t shapes)
    : problem_(problem), share_(share), tessellations_(tessellations)
  {
    trees_.reserve(shapes);
    problem.tessellations.reserve(shapes);
    problem.shapes.reserve(shapes);
  }

  std::uint32_t treeOf(const Shape& shape)
  {
    const auto next = static_cast<std::uint32_t>(problem_.tessellations.size());
    const auto [entry, is_new] = trees_.try_emplace(ShapeKey(shape), next);
    if (is_new || !share_)
    {
      problem_.tessellations.push_back(is_new ? tessellations_.of(shape) : problem_.tessellations[entry->second]);
      problem_.shapes.push_back(shape);
    }
    return share_ ? entry->second : next;
  }

 private:
  CollisionProblem& problem_;
  bool share_;
  TessellationCache& tessellations_;
  std::unordered_map<ShapeKey, std::uint32_t, ShapeKeyHash> trees_;
};

/// A half-open range of indices of shape instances.
struct Range
{
  std::size_t begin;
  std::size_t end;
};

/// The ranges of CollisionProblem::robot, ::world and ::half_spaces that belong to each body.
struct Instances
{
  std::vector<Range> of_body;  // into the robot's instances, by index of a RobotBody
  std::vector<Range> of_object;
  std::vector<Range> half_spaces_of_object;
};

void addObject(const WorldObject& object, std::int32_t body, TreeTable& trees, CollisionProblem& problem)
{
  for (const PlacedShape& placed : object.shapes)
  {
    const Eigen::Isometry3d pose = rigidProduct(object.pose, placed.pose);
    if (const auto* half_space = std::get_if<HalfSpace>(&placed.shape))
    {
      const HalfSpace placed_half_space = moved(*half_space, pose);
      problem.half_spaces.push_back({body, placed_half_space.normal, placed_half_space.offset, object.padding});
    }
    else
    {
      problem.world.push_back({trees.treeOf(placed.shape), body, -1, pose, object.padding});
    }
  }
}

/// Adds the instances of all bodies that are in a checked pair of any group: first the robot's bodies, then the
/// objects.
Instances addInstances(const PlanningScene& scene, const std::vector<RobotBody>& bodies, const CheckedPairs& pairs,
                       bool share_trees, TessellationCache& tessellations, CollisionProblem& problem)
{
  std::vector<bool> body_needed(bodies.size(), false);
  std::vector<bool> object_needed(scene.objects.size(), false);
  for (const CheckedPair& pair : pairs.self)
    body_needed[pair.body] = body_needed[pair.other] = true;
  for (const CheckedPair& pair : pairs.world)
    body_needed[pair.body] = object_needed[pair.other] = true;

  const auto objects = static_cast<std::size_t>(std::count(object_needed.begin(), object_needed.end(), true));
  TreeTable trees(problem, share_trees, tessellations, bodies.size() + objects);
  Instances instances;
  instances.of_body.reserve(bodies.size());
  instances.of_object.reserve(scene.objects.size());
  instances.half_spaces_of_object.reserve(scene.objects.size());
  problem.world.reserve(objects);
  for (std::size_t i = 0; i < bodies.size(); ++i)
  {
    const RobotBody& body = bodies[i];
    const std::size_t begin = problem.robot.size();
    if (body_needed[i])
    {
      for (const PlacedShape& placed : *body.shapes)
      {
        problem.robot.push_back(
            {trees.treeOf(placed.shape), body.body, body.link, rigidProduct(body.pose, placed.pose), body.padding});
      }
    }
    instances.of_body.push_back({begin, problem.robot.size()});
  }
  for (std::size_t k = 0; k < scene.objects.size(); ++k)
  {
    const std::size_t begin = problem.world.size();
    const std::size_t first_half_space = problem.half_spaces.size();
    if (object_needed[k])
      addObject(scene.objects[k], static_cast<std::int32_t>(scene.robot->links().size() + k), trees, problem);
    instances.of_object.push_back({begin, problem.world.size()});
    instances.half_spaces_of_object.push_back({first_half_space, problem.half_spaces.size()});
  }
  return instances;
}

/// Marks the columns [columns.begin, columns.end) of one row of a pair matrix.
void markPairs(std::vector<std::uint8_t>& matrix, std::size_t width, std::size_t row, const Range& columns)
{
  for (std::size_t column = columns.begin; column < columns.end; ++column)  // mostly one column
    matrix[row * width + column] = 1;
}

/// Adds the instance pairs of all body pairs that the group moves.
void addPairs(const CheckedPairs& pairs, const Instances& instances, CollisionProblem& problem)
{
  for (const CheckedPair& pair : pairs.self)
  {
    if (!pair.moved)
      continue;
    const Range& first = instances.of_body[pair.body];
    const Range& second = instances.of_body[pair.other];
    for (std::size_t a = first.begin; a < first.end; ++a)
      for (std::size_t b = second.begin; b < second.end; ++b)
        problem.self_pairs.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)});
  }
  problem.world_pairs.assign(problem.robot.size() * problem.world.size(), 0);
  problem.half_space_pairs.assign(problem.robot.size() * problem.half_spaces.size(), 0);
  for (const CheckedPair& pair : pairs.world)
  {
    if (!pair.moved)
      continue;
    const Range& body = instances.of_body[pair.body];
    for (std::size_t a = body.begin; a < body.end; ++a)
    {
      markPairs(problem.world_pairs, problem.world.size(), a, instances.of_object[pair.other]);
      markPairs(problem.half_space_pairs, problem.half_spaces.size(), a, instances.half_spaces_of_object[pair.other]);
    }
  }
}

/// The position of a link in the robot's default state. A variable whose limits exclude 0 takes the limit nearest to 0
/// instead, so that the point is near the robot.
Eigen::Vector3d originFor(const RobotModel& robot, int link)
{
  std::vector<double> state = robot.defaultState();
  for (std::size_t i = 0; i < state.size(); ++i)
    if (const Variable& variable = robot.variables()[i]; variable.lower > 0.0)
      state[i] = variable.lower;
    else if (variable.upper < 0.0)
      state[i] = variable.upper;
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  robot.linkPoses(state.data(), poses.data());
  return poses[static_cast<std::size_t>(link)].translation();
}
}  // namespace

HalfSpace moved(const HalfSpace& half_space, const Eigen::Isometry3d& pose)
{
  const Eigen::Vector3d normal = (pose.linear() * half_space.normal).normalized();
  return {normal, half_space.offset + normal.dot(pose.translation())};
}

bool sameShape(const Shape& a, const Shape& b)
{
  return ShapeKey(a) == ShapeKey(b);
}

double requiredDistance(const CollisionProblem& problem, const InstancePair& pair)
{
  if (pair[1] < problem.robot.size())
    return 0.0;
  const std::size_t object = pair[1] - problem.robot.size();
  const std::size_t objects = problem.world.size();
  return problem.robot[pair[0]].padding +
         (object < objects ? problem.world[object].padding : problem.half_spaces[object - objects].padding);
}

bool withinRanges(const std::vector<VariableRange>& ranges, const double* state)
{
  return std::all_of(
      ranges.begin(), ranges.end(),
      [state](const VariableRange& range)
      { return state[range.variable] >= range.lower && state[range.variable] <= range.upper; });
}

CollisionProblem problemOf(const PlanningScene& scene, const std::vector<RobotBody>& bodies, const CheckedPairs& pairs,
                           bool share_trees, TessellationCache& tessellations)
{
  CollisionProblem problem;
  const Instances instances = addInstances(scene, bodies, pairs, share_trees, tessellations, problem);
  addPairs(pairs, instances, problem);
  if (!problem.robot.empty())
    problem.origin = originFor(*scene.robot, problem.robot.front().link);
  return problem;
}
}  // namespace gpu_planning_scene::core
