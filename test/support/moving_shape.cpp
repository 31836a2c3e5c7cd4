#include "support/moving_shape.h"

namespace gpu_planning_scene::core
{
MovingShape::MovingShape(const Shape& moving, const std::vector<PlacedShape>& objects, const PairPadding& padding,
                         const Build& build)
{
  auto problem = std::make_shared<CollisionProblem>();
  const auto add_tree = [&problem](const Shape& shape)
  {
    problem->tessellations.push_back(tessellate(shape));
    problem->shapes.push_back(shape);
    return static_cast<std::uint32_t>(problem->tessellations.size() - 1);
  };
  problem->robot.push_back({add_tree(moving), 0, 0, Eigen::Isometry3d::Identity(), padding.moving});
  for (std::size_t k = 0; k < objects.size(); ++k)
  {
    const auto body = static_cast<std::int32_t>(k + 1);
    if (const auto* half_space = std::get_if<HalfSpace>(&objects[k].shape))
    {
      const Eigen::Vector3d normal = objects[k].pose.linear() * half_space->normal;
      problem->half_spaces.push_back(
          {body, normal, half_space->offset + normal.dot(objects[k].pose.translation()), padding.objects});
      continue;
    }
    problem->world.push_back({add_tree(objects[k].shape), body, -1, objects[k].pose, padding.objects});
  }
  problem->world_pairs.assign(problem->world.size(), 1);
  problem->half_space_pairs.assign(problem->half_spaces.size(), 1);
  trees_ = problem->tessellations;
  exact_ = std::make_unique<ExactChecker>(
      problem, std::make_shared<const Forest>(build ? build(trees_) : buildBinnedSah(trees_)));
}

Eigen::Isometry3d randomPose(std::mt19937_64& generator, double reach)
{
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> shift(-reach, reach);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(normal(generator), normal(generator), normal(generator), normal(generator))
                      .normalized()
                      .toRotationMatrix();
  pose.translation() = Eigen::Vector3d(shift(generator), shift(generator), shift(generator));
  return pose;
}

Eigen::Isometry3d at(double x, double y, double z)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}
}  // namespace gpu_planning_scene::core
