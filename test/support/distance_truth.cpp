#include "support/distance_truth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "collision/bounds/problem_maker.h"
#include "collision/geometry/triangle_pair.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

constexpr double kClearanceError = 1.1e-6;  // metres; exceeds the error of a clearance

BodyPair ascendingBodies(const BodyPair& bodies)
{
  return {std::min(bodies[0], bodies[1]), std::max(bodies[0], bodies[1])};
}

std::shared_ptr<const CollisionProblem> problemWithAllPairs(const PlanningScene& scene, const std::string& group)
{
  return std::make_shared<const CollisionProblem>(ProblemMaker(optionsWithAllPairs()).make(scene, group, nullptr));
}

/// The larger error. A NaN is larger than any number, so that it is seen.
double largest(double error, double other)
{
  return std::isnan(error) || error > other ? error : other;
}

oracle::Motion shifted(const Vector3d& translation, oracle::Motion motion)
{
  motion.translation = motion.translation + oracle::Vector(translation);
  return motion;
}
}  // namespace

void DistanceFaults::addDistance(double error)
{
  distance_error = largest(distance_error, error);
}

void DistanceFaults::addPoint(double error)
{
  point_error = largest(point_error, error);
}

DistanceFaults& DistanceFaults::operator+=(const DistanceFaults& other)
{
  compared += other.compared;
  colliding += other.colliding;
  missing += other.missing;
  invented += other.invented;
  addDistance(other.distance_error);
  addPoint(other.point_error);
  return *this;
}

DistanceTruth::DistanceTruth(const std::shared_ptr<const PlanningScene>& scene, const std::string& group)
  : scene_(scene), problem_(problemWithAllPairs(*scene, group)), oracle_(problem_)
{
  for (const Shape& shape : problem_->shapes)
    shapes_.push_back(std::make_unique<oracle::PreparedShape>(shape));
  for (const WorldHalfSpace& plane : problem_->half_spaces)
    shapes_.push_back(std::make_unique<oracle::PreparedShape>(HalfSpace{plane.normal, plane.offset}));
}

bool DistanceTruth::isOfRobot(std::int32_t body) const
{
  return std::any_of(
      problem_->robot.begin(), problem_->robot.end(), [body](const ShapeInstance& each) { return each.body == body; });
}

std::vector<DistanceTruth::Placed> DistanceTruth::shapesOf(std::int32_t body,
                                                           const std::vector<oracle::Motion>& link_poses) const
{
  std::vector<Placed> placed;
  for (const ShapeInstance& each : problem_->robot)
    if (each.body == body)
      placed.push_back(
          {each.tree, link_poses[static_cast<std::size_t>(each.link)] * oracle::Motion(each.pose), each.padding});
  for (const ShapeInstance& each : problem_->world)
    if (each.body == body)
      placed.push_back({each.tree, oracle::Motion(each.pose), each.padding});
  for (std::size_t k = 0; k < problem_->half_spaces.size(); ++k)
    if (problem_->half_spaces[k].body == body)
      placed.push_back({problem_->shapes.size() + k, {}, problem_->half_spaces[k].padding});
  return placed;
}

/// The distance of a point from the surface of a mesh, or from another shape.
double DistanceTruth::distanceTo(const Placed& shape, const Vector3d& point) const
{
  const auto* mesh = shape.tree < problem_->shapes.size()
                         ? std::get_if<std::shared_ptr<const Mesh>>(&problem_->shapes[shape.tree])
                         : nullptr;
  oracle::Motion at;
  at.translation = oracle::Vector(point);
  if (!mesh)
    return oracle::distance(*shapes_[shape.tree], shape.pose, oracle::PreparedShape(Sphere{1e-12}), at);
  const Vector3d local = (shape.pose.inverse() * at.translation).toDouble();
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [i, j, k] : (*mesh)->triangles)
  {
    const auto& vertices = (*mesh)->vertices;
    least = std::min(least, (nearestPoint({vertices[i], vertices[j], vertices[k]}, local) - local).norm());
  }
  return least;
}

/// The shapes of a body have one padding.
double DistanceTruth::requiredOf(const BodyPair& bodies) const
{
  if (isOfRobot(bodies[0]) && isOfRobot(bodies[1]))
    return 0.0;
  const std::vector<oracle::Motion> poses(scene_->robot->links().size());
  return shapesOf(bodies[0], poses).front().padding + shapesOf(bodies[1], poses).front().padding;
}

DistanceFaults DistanceTruth::compareAllPairs(const double* state, const BodyDistances& found, std::size_t state_number,
                                              double range) const
{
  const std::vector<oracle::Motion> poses = oracle::linkPoses(*scene_->robot, state);
  std::map<BodyPair, double> truth = oracle_.clearances(poses, range);
  DistanceFaults faults;
  for (std::size_t k = found.first[state_number]; k < found.first[state_number + 1]; ++k)
  {
    const BodyDistance& pair = found.pairs[k];
    const auto known = truth.find(ascendingBodies(pair.bodies));
    if (known == truth.end())
    {
      faults.invented += pair.distance < range - kClearanceError ? 1 : 0;
      continue;
    }
    const double expected = known->second;
    truth.erase(known);
    ++faults.compared;
    if (pair.collides || expected <= 0.0)
    {
      ++faults.colliding;
      faults.invented += !pair.collides || expected > oracle::kTolerance ? 1 : 0;
      continue;
    }
    // A clearance is a lower bound.
    faults.addDistance(pair.distance > expected + 1e-9 ? 1.0 : expected - pair.distance);
    const double length = expected + requiredOf(pair.bodies);
    if (length < 1e-8)
      continue;  // such points have no direction
    faults.addPoint(std::abs((pair.points[1] - pair.points[0]).dot(pair.normal) - length));
    for (std::size_t end = 0; end < 2; ++end)
    {
      double distance = std::numeric_limits<double>::infinity();
      for (const Placed& shape : shapesOf(pair.bodies[end], poses))
        distance = std::min(distance, distanceTo(shape, pair.points[end]));
      faults.addPoint(distance);
    }
  }
  for (const auto& [bodies, clearance] : truth)
    faults.missing += clearance < range - kClearanceError ? 1 : 0;
  return faults;
}

double DistanceTruth::gradientError(const double* state, const BodyDistance& pair, const double* gradient) const
{
  // Radians or metres: short against the distance, because the slope turns with the points.
  const double step = std::clamp(1e-4 * pair.distance, 1e-9, 1e-6);
  const RobotModel& robot = *scene_->robot;
  const BodyPair bodies = ascendingBodies(pair.bodies);
  std::vector<double> moved(state, state + robot.variables().size());
  const auto clearance = [&]
  { return oracle_.clearanceOf(bodies, oracle::linkPoses(robot, moved.data()), pair.distance + 1e-3); };
  const double here = clearance();
  double error = 0.0;
  for (std::size_t v = 0; v < moved.size(); ++v)
  {
    moved[v] = state[v] + step;
    const double above = (clearance() - here) / step;
    moved[v] = state[v] - step;
    const double below = (here - clearance()) / step;
    moved[v] = state[v];
    error = largest(error, gradient[v] - std::max(above, below));
    error = largest(error, std::min(above, below) - gradient[v]);
  }
  return error;
}

bool DistanceTruth::collidesAfter(const double* state, const BodyDistance& pair, double length,
                                  std::uint64_t seed) const
{
  const std::vector<oracle::Motion> poses = oracle::linkPoses(*scene_->robot, state);
  const std::vector<Placed> first = shapesOf(pair.bodies[0], poses);
  const std::vector<Placed> second = shapesOf(pair.bodies[1], poses);
  const double required = requiredOf(pair.bodies);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20; ++i)
  {
    Vector3d direction(normal(random), normal(random), normal(random));
    direction = i < 2 ? Vector3d((i == 0 ? 1.0 : -1.0) * pair.normal) : direction.normalized();
    bool collides = false;
    for (const Placed& a : first)
      for (const Placed& b : second)
        collides = collides || oracle::verdict(*shapes_[a.tree], a.pose, *shapes_[b.tree],
                                               shifted(length * direction, b.pose), required) != oracle::Verdict::Free;
    if (!collides)
      return false;
  }
  return true;
}
}  // namespace gpu_planning_scene::core
