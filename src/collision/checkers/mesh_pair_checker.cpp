#include "gpu_planning_scene/mesh_pair_checker.h"

#include <chrono>
#include <mutex>

#include "base/seconds_since.h"
#include "collision/gpu/gpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "model/rigid_pose.h"

namespace gpu_planning_scene::core
{
namespace
{
std::shared_ptr<const CollisionProblem> pairProblem(const Shape& a, const Shape& b)
{
  validateShape(a, "shape a");
  validateShape(b, "shape b");
  if (std::holds_alternative<HalfSpace>(b))
    throw Error("shape b is a half-space, which cannot move; give it as shape a");
  auto problem = std::make_shared<CollisionProblem>();
  problem->shapes = {b};
  problem->tessellations = {tessellate(b)};
  problem->robot = {{0, 0, 0, Eigen::Isometry3d::Identity()}};
  if (const auto* half_space = std::get_if<HalfSpace>(&a))
  {
    problem->half_spaces = {{1, half_space->normal, half_space->offset}};
    problem->half_space_pairs = {1};
    return problem;
  }
  problem->shapes.push_back(a);
  problem->tessellations.push_back(tessellate(a));
  problem->world = {{1, 1, -1, Eigen::Isometry3d::Identity()}};
  problem->world_pairs = {1};
  return problem;
}

std::vector<Eigen::Isometry3d> rigidPoses(const std::vector<Eigen::Isometry3d>& poses)
{
  std::vector<Eigen::Isometry3d> result;
  result.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i)
    result.push_back(nearestRigid(poses[i], "pose " + std::to_string(i)));
  return result;
}
}  // namespace

struct MeshPairChecker::Impl
{
  explicit Impl(const BatchCheckerOptions& options) : gpu_checker(options, std::make_shared<ForestCache>()) {}

  mutable std::mutex mutex;
  GpuChecker gpu_checker;
  BatchResult last;
};

MeshPairChecker::MeshPairChecker(const Shape& a, const Shape& b, const BatchCheckerOptions& options)
  : impl_(std::make_unique<Impl>(options))
{
  impl_->gpu_checker.setProblem(pairProblem(a, b));
}

MeshPairChecker::~MeshPairChecker() = default;

std::vector<std::uint8_t> MeshPairChecker::collide(const std::vector<Eigen::Isometry3d>& b_in_a)
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  const std::vector<Eigen::Isometry3d> poses = rigidPoses(b_in_a);
  const auto start = std::chrono::steady_clock::now();
  BatchResult result;
  impl_->gpu_checker.checkPoses(
      poses.size(), 1, [&](std::size_t row, Eigen::Isometry3d* pose) { *pose = poses[row]; }, result);
  result.seconds = secondsSince(start);
  std::vector<std::uint8_t> hits;
  hits.reserve(result.valid.size());
  for (const std::uint8_t valid : result.valid)
    hits.push_back(valid ? 0 : 1);
  impl_->last = std::move(result);
  return hits;
}

double MeshPairChecker::seconds() const
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  return impl_->last.seconds;
}

std::size_t MeshPairChecker::undecided() const
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  return impl_->last.undecided_states;
}
}  // namespace gpu_planning_scene::core
