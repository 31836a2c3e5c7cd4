#include "collision/cpu_scene.h"

#include <utility>

#include "collision/state_rows.h"

namespace gpu_planning_scene
{
namespace
{
constexpr std::size_t kStatesPerChunk = 16;
}  // namespace

CpuScene::CpuScene(const CheckerOptions& options) : options_(options), maker_(options) {}

void CpuScene::setScene(std::shared_ptr<const PlanningScene> scene)
{
  refuseMissingRobot(scene);
  Group whole;
  whole.problem = std::make_shared<const CollisionProblem>(maker_.make(*scene, "", &whole.report));
  scene_ = std::move(scene);
  groups_.clear();
  groups_.emplace("", std::move(whole));
  poses_.resize(scene_->robot->links().size());
}

CpuScene::Group& CpuScene::groupOf(const std::string& group)
{
  const auto known = groups_.find(group);
  if (known != groups_.end())
    return known->second;
  Group made;
  made.problem = std::make_shared<const CollisionProblem>(maker_.make(*scene_, group, &made.report));
  return groups_.emplace(group, std::move(made)).first->second;
}

void CpuScene::prepare(Group& group)
{
  if (!group.within.on_cpu)
    group.within.on_cpu = forest_->traversalOf(group.problem);
}

void CpuScene::prepareOutside(const std::string& name, Group& group)
{
  if (group.outside.on_cpu)
    return;
  CheckerOptions options = options_;
  options.reductions.reach = false;
  const auto problem = std::make_shared<const CollisionProblem>(ProblemMaker(options).make(*scene_, name, nullptr));
  group.outside.on_cpu = forest_outside_.traversalOf(problem);
}

void CpuScene::checkRow(const double* state, std::size_t row, const Group& group, CpuTraversal::Scratch& within,
                        CpuTraversal::Scratch& outside, std::vector<Eigen::Isometry3d>& poses,
                        BatchResult& result) const
{
  const bool holds = holdsFor(*group.problem, state);
  scene_->robot->linkPoses(state, poses.data());
  const auto pair = holds ? group.within.on_cpu->firstCollision(poses.data(), within)
                          : group.outside.on_cpu->firstCollision(poses.data(), outside);
  if (pair)
  {
    result.valid[row] = 0;
    result.colliding[row] = *pair;
  }
}

void CpuScene::check(const double* states, std::size_t count, const std::string& name, BatchResult& result)
{
  Group& group = groupOf(name);
  if (group.problem->always_colliding)
  {
    result.valid.assign(count, 0);
    result.colliding.assign(count, *group.problem->always_colliding);
    return;
  }
  result.valid.assign(count, 1);
  result.colliding.assign(count, {-1, -1});
  prepare(group);
  const std::size_t width = scene_->robot->variables().size();
  for (std::size_t i = 0; i < count; ++i)
    if (!holdsFor(*group.problem, states + i * width))
    {
      prepareOutside(name, group);
      break;
    }
  // A few states are sooner checked than threads started; and what is learned from them is kept.
  if (count <= kStatesPerChunk)
  {
    for (std::size_t i = 0; i < count; ++i)
      checkRow(states + i * width, i, group, group.within.scratch, group.outside.scratch, poses_, result);
    return;
  }
  forChunks(count, kStatesPerChunk,
            [&, within = group.within.scratch, outside = group.outside.scratch, poses = poses_](std::size_t begin,
                                                                                                std::size_t end) mutable
            {
              for (std::size_t i = begin; i < end; ++i)
                checkRow(states + i * width, i, group, within, outside, poses, result);
            });
}
}  // namespace gpu_planning_scene
