#include "collision/cpu/lanes/lane_objects.h"

#include <algorithm>
#include <numeric>
#include <variant>

#include "collision/exact/cpu_shape_pair.h"
#include "collision/geometry/median_split.h"

// A mesh of the world becomes its oriented bounding box. A primitive keeps its kind and size; its thickness is the
// radius of its largest inscribed ball. Own method.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kEndless = 1e15;  // metres: its square is finite in float

/// Kind, size and thickness of a primitive.
struct Size
{
  lanes::ObjectKind kind;
  Vector3d half;
  double thickness;
};

Size sizeOf(const Shape& shape)
{
  if (const auto* box = std::get_if<Box>(&shape))
    return {lanes::ObjectKind::Box, 0.5 * box->size, 0.5 * box->size.minCoeff()};
  if (const auto* sphere = std::get_if<Sphere>(&shape))
    return {lanes::ObjectKind::Sphere, Vector3d::Constant(sphere->radius), sphere->radius};
  if (const auto* cylinder = std::get_if<Cylinder>(&shape))
  {
    const double half = 0.5 * cylinder->length;
    return {lanes::ObjectKind::Cylinder, {cylinder->radius, half, 0.0}, std::min(cylinder->radius, half)};
  }
  const auto& cone = std::get<Cone>(shape);
  // The radius of the inscribed ball is area / half perimeter of the triangle through the axis.
  const double side = std::hypot(cone.radius, cone.length);
  return {
      lanes::ObjectKind::Cone, {cone.radius, 0.5 * cone.length, 0.0}, cone.radius * cone.length / (cone.radius + side)};
}

LaneObject placed(const Size& size, const Isometry3d& pose, const Vector3d& origin, double padding)
{
  LaneObject made{};
  Isometry3d here = pose;
  here.translation() -= origin;
  const Isometry3d inverse = here.inverse();
  made.object.kind = size.kind;
  writePose(inverse, made.object.from_planning_frame);
  for (int axis = 0; axis < 3; ++axis)
    made.object.half[axis] = static_cast<float>(size.half[axis]);
  made.padding = padding;
  made.thickness = size.thickness;
  made.largest_distance = here.translation().norm() + size.half.norm();
  return made;
}

AlignedBox3d shifted(const AlignedBox3d& box, const Vector3d& origin)
{
  return {box.min() - origin, box.max() - origin};
}
}  // namespace

void writePose(const Isometry3d& pose, float* rows)
{
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      rows[4 * row + column] = static_cast<float>(pose(row, column));
}

std::vector<LaneObject> laneObjects(const CollisionProblem& problem, const CpuForest& forest, const Vector3d& origin)
{
  std::vector<LaneObject> objects;
  objects.reserve(problem.world.size() + problem.half_spaces.size());
  for (const ShapeInstance& instance : problem.world)
  {
    const CpuTree& tree = forest.tree(instance.tree);
    if (tree.mesh)
    {
      Isometry3d box = Isometry3d::Identity();
      box.linear() = tree.box.axes;
      box.translation() = tree.box.center;
      objects.push_back(
          placed({lanes::ObjectKind::BoundingBox, tree.box.half, 0.0}, instance.pose * box, origin, instance.padding));
    }
    else
    {
      objects.push_back(placed(sizeOf(tree.shape), instance.pose, origin, instance.padding));
    }
    objects.back().bounds = shifted(boundsOf(tree, instance.pose), origin);
  }
  for (const WorldHalfSpace& half_space : problem.half_spaces)
  {
    LaneObject made{};
    made.object.kind = lanes::ObjectKind::HalfSpace;
    const double offset = half_space.offset - half_space.normal.dot(origin);
    for (int axis = 0; axis < 3; ++axis)
      made.object.from_planning_frame[axis] = static_cast<float>(half_space.normal[axis]);
    made.object.from_planning_frame[3] = static_cast<float>(-offset);
    made.padding = half_space.padding;
    made.thickness = kEndless;
    made.largest_distance = std::abs(offset);
    made.bounds = AlignedBox3d(Vector3d::Constant(-kEndless), Vector3d::Constant(kEndless));
    objects.push_back(made);
  }
  return objects;
}

/// Only a plane along two axes cuts the box. Above a tilted plane, the half-space reaches beyond such a cut, however
/// small the tilt is.
AlignedBox3d boundsWithin(const LaneObject& object, double reach)
{
  if (object.object.kind != lanes::ObjectKind::HalfSpace)
    return object.bounds;
  AlignedBox3d bounds(Vector3d::Constant(-reach), Vector3d::Constant(reach));
  const float* plane = object.object.from_planning_frame;
  const double end = std::clamp(-static_cast<double>(plane[3]), -reach, reach);
  for (int axis = 0; axis < 3; ++axis)
  {
    if (plane[(axis + 1) % 3] != 0.0F || plane[(axis + 2) % 3] != 0.0F)
      continue;
    if (plane[axis] == 1.0F)
      bounds.max()[axis] = end;
    if (plane[axis] == -1.0F)
      bounds.min()[axis] = -end;
  }
  return bounds;
}

/// The order of the leaves of a tree that halves the objects along the longest extent of their centres.
std::vector<std::uint32_t> nearOrder(const std::vector<LaneObject>& objects)
{
  std::vector<std::uint32_t> numbers(objects.size());
  std::iota(numbers.begin(), numbers.end(), 0U);
  sortBySplits(numbers.begin(), numbers.end(),
               [&objects](std::uint32_t number) -> Vector3d { return objects[number].bounds.center(); });
  return numbers;
}
}  // namespace gpu_planning_scene::core
