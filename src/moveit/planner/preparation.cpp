#include "moveit/planner/preparation.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <geometric_shapes/shapes.h>
#include <moveit/planning_scene/planning_scene.h>

// Drivers compile a program when it is first used. The scene has a box because the programs for primitives are made for
// scenes with primitives only, and the many states of the batch let a fast device check them.
namespace gpu_planning_scene::pipeline
{
void prepareChecker(Workshop& workshop, const moveit::core::RobotModelConstPtr& model)
{
  constexpr std::size_t kStates = 1024;
  if (model->getJointModelGroups().empty())
    return;  // there is nothing to plan for
  planning_scene::PlanningScene scene(model);
  moveit::core::RobotState& state = scene.getCurrentStateNonConst();
  state.setToDefaultValues();
  state.update();
  // The box is at the last link, so no reduction leaves it out.
  scene.getWorldNonConst()->addToObject("box", state.getGlobalLinkTransform(model->getLinkModels().back()),
                                        std::make_shared<shapes::Box>(1e-3, 1e-3, 1e-3), Eigen::Isometry3d::Identity());
  const ConvertedScene converted =
      workshop.converter.convert(scene, state, *model->getJointModelGroups().front(), std::nullopt);
  core::CheckerPool::Lease lease(workshop.checkers, converted.scene);
  const std::vector<double>& row = converted.scene->current_state;
  std::vector<double> states;
  for (std::size_t i = 0; i < kStates; ++i)
    states.insert(states.end(), row.begin(), row.end());
  const core::JointNeighbourhood around{std::vector<core::JointTravel>(converted.scene->robot->joints().size()),
                                        std::vector<std::uint32_t>(kStates, 0)};
  lease.checker()->check(states.data(), kStates);
  lease.checker()->check(states.data(), kStates, "", &around);
  lease.giveBack();
}
}  // namespace gpu_planning_scene::pipeline
