// Required distances that are long against the triangles: the time of a check just outside of the required distance,
// and as a ratio to the same check without a required distance. Gaps between the poses of a row are the same.

#include <algorithm>
#include <limits>
#include <optional>

#include "benchmark/csv_table.h"
#include "benchmark/settings.h"
#include "benchmark/statistics.h"
#include "collision/exact/cpu_shape_pair.h"
#include "literature/models.h"
#include "literature/poses.h"
#include "tools/progress_bar.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr std::size_t kPartTriangles = 57000;
constexpr std::size_t kQuickPartTriangles = 5000;
constexpr double kGap = 1e-5;  // metres, beyond the required distance

/// A mesh, scaled so that its box is `size` long.
std::shared_ptr<const Mesh> scaled(const Mesh& mesh, double size)
{
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : mesh.vertices)
    box.extend(vertex);
  auto scaled = std::make_shared<Mesh>(mesh);
  for (Vector3d& vertex : scaled->vertices)
    vertex *= size / box.sizes().maxCoeff();
  return scaled;
}

/// Two equal parts.
class TwoParts
{
 public:
  explicit TwoParts(const std::shared_ptr<const Mesh>& mesh)
  {
    CollisionProblem problem;
    problem.shapes = {Shape(mesh)};
    problem.tessellations = {tessellate(problem.shapes[0])};
    pair_.emplace(std::make_shared<const CpuForest>(problem));
  }

  bool collide(const Isometry3d& pose, double required)
  {
    return pair_->collide(0, Isometry3d::Identity(), 0, pose, required, scratch_);
  }

  /// Moves the second part along the direction of its translation, to kGap beyond the required distance.
  Isometry3d justOutside(Isometry3d pose, double required)
  {
    const Vector3d direction = pose.translation().normalized();
    double low = 0.0;
    double high = required + 10.0 * pose.translation().norm();
    for (int i = 0; i < 60; ++i)
    {
      const double middle = 0.5 * (low + high);
      pose.translation() = middle * direction;
      (collide(pose, required) ? low : high) = middle;
    }
    pose.translation() = (high + kGap) * direction;
    return pose;
  }

  std::uint64_t steps() const { return scratch_.steps; }

 private:
  std::optional<CpuShapePair> pair_;
  CpuShapePair::Scratch scratch_;
};
}  // namespace

std::size_t measureRequiredDistances(const Settings& settings)
{
  CsvTable table(settings.out, "required_distances.csv",
                 {"triangles", "size_m", "required_m", "poses", "p50_us", "max_us", "steps_a_pose", "of_no_distance"});
  const std::shared_ptr<const Mesh> lump = literature::lump(settings.quick ? kQuickPartTriangles : kPartTriangles);
  const std::vector<double> sizes = {0.02, 0.04, 0.1};
  const std::size_t count = settings.quick ? 8 : 64;
  ProgressBar progress("required distances", sizes.size());
  std::size_t done = 0;
  std::size_t wrong = 0;
  for (const double size : sizes)
  {
    progress.update(done++);
    const std::shared_ptr<const Mesh> mesh = scaled(*lump, size);
    TwoParts parts(mesh);
    std::vector<Isometry3d> from = literature::posesAt(1.0, count, settings.seed);
    for (Isometry3d& pose : from)
      pose.translation() *= size;
    double without = 0.0;
    for (const double required : {0.0, 0.01, 0.1, 0.3})
    {
      std::vector<double> least;
      std::uint64_t steps = 0;
      for (const Isometry3d& start : from)
      {
        const Isometry3d pose = parts.justOutside(start, required);
        least.push_back(std::numeric_limits<double>::infinity());
        for (std::size_t i = 0; i < std::max<std::size_t>(2, settings.repeats); ++i)
        {
          bool collide = false;
          least.back() = std::min(least.back(), 1e6 * secondsOf([&] { collide = parts.collide(pose, required); }));
          wrong += collide ? 1 : 0;
        }
        const std::uint64_t before = parts.steps();
        parts.collide(pose, required);
        steps += parts.steps() - before;
      }
      without = required == 0.0 ? median(least) : without;
      table.add({mesh->triangles.size(), size, required, count, median(least), percentile(least, 1.0),
                 static_cast<std::size_t>(steps) / count, median(least) / without});
    }
  }
  return wrong;
}
}  // namespace gpu_planning_scene::core::benchmark
