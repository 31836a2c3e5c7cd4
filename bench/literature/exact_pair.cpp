#include "literature/exact_pair.h"

#include "base/parallel_for.h"
#include "collision/trees/binned_sah.h"

namespace gpu_planning_scene::core::literature
{
std::shared_ptr<const CollisionProblem> pairProblem(const Shape& a, const Shape& b)
{
  auto problem = std::make_shared<CollisionProblem>();
  problem->shapes = {b, a};
  problem->tessellations = {tessellate(b), tessellate(a)};
  problem->robot = {{0, 0, 0, Eigen::Isometry3d::Identity()}};
  problem->world = {{1, 1, -1, Eigen::Isometry3d::Identity()}};
  problem->world_pairs = {1};
  return problem;
}

ExactPair::ExactPair(std::shared_ptr<const CollisionProblem> problem)
  : exact_(problem, std::make_shared<const Forest>(buildBinnedSah(problem->tessellations)))
{
}

bool ExactPair::collides(const Eigen::Isometry3d& b_in_a, ExactChecker::Scratch& scratch) const
{
  return exact_.firstCollision(&b_in_a, scratch).has_value();
}

std::vector<std::uint8_t> ExactPair::collide(const std::vector<Eigen::Isometry3d>& b_in_a) const
{
  std::vector<std::uint8_t> answers(b_in_a.size());
  parallelFor(b_in_a.size(), 16,
              [&, scratch = ExactChecker::Scratch()](std::size_t begin, std::size_t end) mutable
              {
                for (std::size_t i = begin; i < end; ++i)
                  answers[i] = collides(b_in_a[i], scratch) ? 1 : 0;
              });
  return answers;
}
}  // namespace gpu_planning_scene::core::literature
