#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "collision/bounds/displacement_bounds.h"
#include "collision/bounds/problem_maker.h"
#include "collision/exact/cpu_traversal.h"
#include "collision/exact/forest_cache.h"

namespace gpu_planning_scene::core
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

  /// The margins of the group's pairs for `count` rows of the robot's variables. Throws Error as DisplacementBounds
  /// does.
  Margins margins(const JointNeighbourhood& around, const double* states, std::size_t count, const std::string& group);

  /// Checks rows of the robot's variables on all cores: any rows, also those that `problem` does not hold for. Fills
  /// `valid` and `colliding`. `margins`: of the group, for these states; null: none.
  void check(const double* states, std::size_t count, const std::string& group, BatchResult& result,
             const Margins* margins = nullptr);

 private:
  /// Of one thread, with what was learned of the order of pairs.
  struct Scratch
  {
    CpuTraversal::Scratch within;   // of states that the problem holds for
    CpuTraversal::Scratch outside;  // of the others
    CpuTraversal::Scratch near;     // of states with margins
    std::vector<Eigen::Isometry3d> poses;
  };
  struct Group
  {
    SceneReport report;
    std::shared_ptr<const CollisionProblem> problem;
    std::unique_ptr<const CpuTraversal> within;   // of that problem
    std::unique_ptr<const CpuTraversal> outside;  // of states that it does not hold for
    std::unique_ptr<const DisplacementBounds> displacements;
    Scratch scratch;
  };

  Group& groupOf(const std::string& group);
  void prepare(Group& group);
  void prepareOutside(const std::string& name, Group& group);
  void checkRow(const double* state, std::size_t row, const Group& group, const Margins* margins, Scratch& scratch,
                BatchResult& result) const;

  CheckerOptions options_;
  ProblemMaker maker_;
  std::shared_ptr<const PlanningScene> scene_;
  std::map<std::string, Group> groups_;
  std::shared_ptr<ForestCache> forest_ = std::make_shared<ForestCache>();
  ForestCache forest_outside_;
};
}  // namespace gpu_planning_scene::core
