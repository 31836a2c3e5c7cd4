// The robot as a set of balls in float32, tested against primitives by their distance. This is the idea of VAMP
// (Thomason, Kingston and Kavraki, "Motions in Microseconds via Vectorized Sampling-Based Planning", 2024), here with
// one state at a time.

#include <algorithm>
#include <cmath>

#include "benchmark/pairwise_peer.h"
#include "benchmark/sphere_fit.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
using Eigen::Vector3f;

/// The bounding ball of a shape, and the balls that were fitted to the shape.
struct Fitted
{
  Ball bound;
  std::vector<Ball> balls;
};

float outside(float along, float half)
{
  return std::max(0.0F, std::abs(along) - half);
}

/// Distance of a point to a solid, both in the solid's frame; 0 inside. Metres.
struct DistanceFrom
{
  Vector3f p;

  float operator()(const Box& box) const
  {
    return (p.cwiseAbs() - 0.5F * box.size.cast<float>()).cwiseMax(0.0F).norm();
  }
  float operator()(const Sphere& sphere) const { return std::max(0.0F, p.norm() - static_cast<float>(sphere.radius)); }
  float operator()(const Cylinder& c) const
  {
    return std::hypot(std::max(0.0F, p.head<2>().norm() - static_cast<float>(c.radius)),
                      outside(p.z(), static_cast<float>(0.5 * c.length)));
  }
  float operator()(const Cone& cone) const
  {
    // In the half-plane through the axis with its origin at the apex, the cone's side ends at (radius, -length).
    const auto radius = static_cast<float>(cone.radius);
    const auto length = static_cast<float>(cone.length);
    const float away = p.head<2>().norm();
    const float below = 0.5F * length - p.z();
    if (below > length)
      return std::hypot(std::max(0.0F, away - radius), below - length);
    if (away * length <= radius * below)
      return 0.0F;
    const float share = (away * radius + below * length) / (radius * radius + length * length);
    const float on_side = std::clamp(share, 0.0F, 1.0F);
    return std::hypot(away - on_side * radius, below - on_side * length);
  }
  float operator()(const std::shared_ptr<const Mesh>&) const { return 0.0F; }  // unused: world meshes are balls
  float operator()(const HalfSpace&) const { return 0.0F; }                    // unused: half-spaces are refused
};

bool near(const Ball& a, const Ball& b, float required)
{
  const float reach = a.radius + b.radius + required;
  return (a.center - b.center).squaredNorm() <= reach * reach;
}

class Spheres : public PairwisePeer
{
 public:
  Spheres(const std::shared_ptr<const CollisionProblem>& problem, std::size_t count) : PairwisePeer(problem)
  {
    auto fitted = std::make_shared<std::vector<Fitted>>();
    std::vector<bool> made_of_balls;
    for (const Shape& shape : problem->shapes)
      made_of_balls.push_back(std::holds_alternative<std::shared_ptr<const Mesh>>(shape));
    for (const ShapeInstance& instance : problem->robot)
      made_of_balls[instance.tree] = true;
    for (std::size_t i = 0; i < problem->tessellations.size(); ++i)
    {
      const Mesh& mesh = *problem->tessellations[i].mesh;
      fitted->push_back({boundingBall(mesh), made_of_balls[i] ? fitBalls(mesh, count) : std::vector<Ball>()});
    }
    fitted_ = std::move(fitted);
    for (const ShapeInstance& instance : problem->robot)
      robot_.push_back({&(*fitted_)[instance.tree]});
    for (const ShapeInstance& instance : problem->world)
    {
      Obstacle obstacle{&problem->shapes[instance.tree], instance.pose.inverse().cast<float>(), {}, {}};
      const Fitted& fit = (*fitted_)[instance.tree];
      const Eigen::Isometry3f pose = instance.pose.cast<float>();
      obstacle.bound = {pose * fit.bound.center, fit.bound.radius};
      if (std::holds_alternative<std::shared_ptr<const Mesh>>(*obstacle.shape))
        for (const Ball& ball : fit.balls)
          obstacle.balls.push_back({pose * ball.center, ball.radius});
      world_.push_back(std::move(obstacle));
    }
  }

  std::unique_ptr<Peer> copy() const override { return std::make_unique<Spheres>(*this); }

 private:
  struct Part
  {
    const Fitted* fit;
    Eigen::Isometry3f pose = Eigen::Isometry3f::Identity();
    Ball bound = {};
    bool placed = false;  // whether `balls` has the poses of the current state
    std::vector<Ball> balls = {};
  };

  struct Obstacle
  {
    const Shape* shape;  // of the problem
    Eigen::Isometry3f inverse;
    Ball bound;
    std::vector<Ball> balls;  // of a mesh
  };

  void place(const Eigen::Isometry3d* link_poses) override
  {
    for (std::size_t i = 0; i < robot_.size(); ++i)
    {
      const ShapeInstance& instance = problem().robot[i];
      robot_[i].pose = (link_poses[instance.link] * instance.pose).cast<float>();
      robot_[i].bound = {robot_[i].pose * robot_[i].fit->bound.center, robot_[i].fit->bound.radius};
      robot_[i].placed = false;
    }
  }

  static const std::vector<Ball>& ballsOf(Part& part)
  {
    if (!part.placed)
    {
      part.balls.resize(part.fit->balls.size());
      for (std::size_t i = 0; i < part.balls.size(); ++i)
        part.balls[i] = {part.pose * part.fit->balls[i].center, part.fit->balls[i].radius};
      part.placed = true;
    }
    return part.balls;
  }

  static bool meets(const Ball& ball, const Obstacle& obstacle, float required)
  {
    if (!obstacle.balls.empty())
      return std::any_of(obstacle.balls.begin(), obstacle.balls.end(),
                         [&](const Ball& other) { return near(ball, other, required); });
    return std::visit(DistanceFrom{obstacle.inverse * ball.center}, *obstacle.shape) <= ball.radius + required;
  }

  bool collidesWithWorld(std::size_t robot, std::size_t world, double padding) override
  {
    Part& part = robot_[robot];
    const Obstacle& obstacle = world_[world];
    const auto required = static_cast<float>(padding);
    if (!near(part.bound, obstacle.bound, required) || !meets(part.bound, obstacle, required))
      return false;
    const std::vector<Ball>& balls = ballsOf(part);
    return std::any_of(balls.begin(), balls.end(), [&](const Ball& ball) { return meets(ball, obstacle, required); });
  }

  bool collidesWithSelf(std::size_t first, std::size_t second) override
  {
    Part& a = robot_[first];
    Part& b = robot_[second];
    if (!near(a.bound, b.bound, 0.0F))
      return false;
    const std::vector<Ball>& others = ballsOf(b);
    const std::vector<Ball>& balls = ballsOf(a);
    return std::any_of(balls.begin(), balls.end(),
                       [&](const Ball& ball)
                       {
                         return near(ball, b.bound, 0.0F) &&
                                std::any_of(others.begin(), others.end(),
                                            [&](const Ball& other) { return near(ball, other, 0.0F); });
                       });
  }

  std::shared_ptr<const std::vector<Fitted>> fitted_;
  std::vector<Part> robot_;
  std::vector<Obstacle> world_;
};
}  // namespace

std::unique_ptr<PairwisePeer> makeSpheres(const std::shared_ptr<const CollisionProblem>& problem, std::size_t count)
{
  return std::make_unique<Spheres>(problem, count);
}
}  // namespace gpu_planning_scene::core::benchmark
