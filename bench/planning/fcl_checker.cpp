#include "planning/fcl_checker.h"

#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "collision/bounds/problem_maker.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core::benchmark
{
FclChecker::FclChecker(std::shared_ptr<const PlanningScene> scene, const std::string& group)
  : scene_(std::move(scene)),
    group_(group),
    problem_(std::make_shared<const CollisionProblem>(makeProblem(*scene_, group, nullptr))),
    displacements_(scene_->robot, *problem_, levers_),
    fcl_(problem_, FclTree::Obbrss, FclOrder::Learned),
    near_(fcl_)
{
}

void FclChecker::setScene(std::shared_ptr<const PlanningScene> /*scene*/)
{
  throw std::logic_error("an FclChecker keeps its scene");
}

BatchResult FclChecker::checkBatch(const StateBatch& batch)
{
  const auto& [states, count, group, around, go_on] = batch;
  if (group != group_)
    throw std::logic_error("an FclChecker of group " + group_ + " got a request for group " + group);
  std::optional<Margins> margins;
  if (around)
    margins = displacements_.margins(*around, states, count);
  const std::size_t width = scene_->robot->variables().size();
  std::vector<Eigen::Isometry3d> poses(scene_->robot->links().size());
  BatchResult result;
  result.revision = scene_->revision;
  result.valid.assign(count, 1);
  result.colliding.assign(count, {-1, -1});
  constexpr std::size_t kStatesBetweenQuestions = 64;
  for (std::size_t i = 0; i < count; ++i)
  {
    if (go_on && i % kStatesBetweenQuestions == 0 && !go_on(i))
      throw Cancelled();
    scene_->robot->linkPoses(states + i * width, poses.data());
    FclPeer& peer = margins ? near_ : fcl_;
    peer.setState(poses.data());
    const auto pair = margins ? peer.firstNear(margins->of(i)) : peer.firstCollision();
    if (pair || (margins && margins->within[i] == 0))
      result.valid[i] = 0;
    if (pair)
      result.colliding[i] = *pair;
  }
  return result;
}

SceneReport FclChecker::report(const std::string& /*group*/)
{
  return {};
}
}  // namespace gpu_planning_scene::core::benchmark
