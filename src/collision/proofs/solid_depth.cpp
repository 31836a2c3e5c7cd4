#include "collision/proofs/solid_depth.h"

#include <algorithm>

// The depth at the centre of a cube bounds the depth of each point of the cube, because two depths differ by at most
// the distance of their points. Own method.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kPoints = 400;
constexpr double kDepthRounding = 1e-6;  // of a depth: exceeds the rounding to float
}  // namespace

SolidDepth::SolidDepth(const ShapeSamples& samples, double sagitta)
  : grid_(samples.grid), depths_(static_cast<std::size_t>(samples.grid.count.prod()), 0.0F)
{
  const std::size_t step = std::max<std::size_t>(1, samples.points.size() / kPoints);
  for (std::size_t i = 0; i < samples.points.size(); i += step)
    points_.push_back(samples.points[i]);
  // The true surface of a curved primitive is up to the sagitta away from the triangles.
  for (const SolidCell& cell : samples.cells)
    depths_[grid_.numberOf(grid_.cubeOf(cell.center))] =
        static_cast<float>(std::max(0.0, (1.0 - kDepthRounding) * cell.depth - sagitta));
}

double SolidDepth::at(const Eigen::Vector3d& point) const
{
  const Eigen::Vector3i cube = grid_.cubeOf(point);
  const double depth = static_cast<double>(depths_[grid_.numberOf(cube)]);
  return depth == 0.0 ? 0.0 : std::max(0.0, depth - (point - grid_.centerOf(cube)).norm());
}
}  // namespace gpu_planning_scene::core
