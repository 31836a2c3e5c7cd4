#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "collision/cpu_traversal.h"
#include "collision/forest_cache.h"
#include "collision/problem_maker.h"

namespace gpu_planning_scene
{
/// A scene's problems, group by group, and how the CPU answers them. Each is made when it is first asked for, and trees
/// are kept for the next scene with the same shapes. One caller at a time.
class CpuScene
{
 public:
  /// Throws Error for a tolerance that is not one.
  explicit CpuScene(const CheckerOptions& options);

  /// Throws Error and keeps the old scene if this one cannot be used.
  void setScene(std::shared_ptr<const PlanningScene> scene);
  const std::shared_ptr<const PlanningScene>& scene() const { return scene_; }

  /// These throw Error for an unknown group.
  const SceneReport& report(const std::string& group) { return groupOf(group).report; }
  const std::shared_ptr<const CollisionProblem>& problem(const std::string& group) { return groupOf(group).problem; }

  /// The trees that it walks.
  const std::shared_ptr<ForestCache>& trees() const { return forest_; }

  /// Makes ready what the first call of `check` would.
  void prepare(const std::string& group) { prepare(groupOf(group)); }

  /// Checks rows of the robot's variables on all cores: any rows, also those that `problem` does not hold for. Fills
  /// `valid` and `colliding`.
  void check(const double* states, std::size_t count, const std::string& group, BatchResult& result);

 private:
  /// With what was learned of the order of its pairs.
  struct Traversal
  {
    std::unique_ptr<const CpuTraversal> on_cpu;
    CpuTraversal::Scratch scratch;
  };
  struct Group
  {
    SceneReport report;
    std::shared_ptr<const CollisionProblem> problem;
    Traversal within;   // of that problem
    Traversal outside;  // of states that it does not hold for
  };

  Group& groupOf(const std::string& group);
  void prepare(Group& group);
  void prepareOutside(const std::string& name, Group& group);
  void checkRow(const double* state, std::size_t row, const Group& group, CpuTraversal::Scratch& within,
                CpuTraversal::Scratch& outside, std::vector<Eigen::Isometry3d>& poses, BatchResult& result) const;

  CheckerOptions options_;
  ProblemMaker maker_;
  std::shared_ptr<const PlanningScene> scene_;
  std::map<std::string, Group> groups_;
  std::shared_ptr<ForestCache> forest_ = std::make_shared<ForestCache>();
  ForestCache forest_outside_;
  std::vector<Eigen::Isometry3d> poses_;
};
}  // namespace gpu_planning_scene
