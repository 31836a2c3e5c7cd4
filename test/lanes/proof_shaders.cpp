#include "lanes/proof_shaders.h"

#include "collision/bounds/problem_maker.h"
#include "collision/cpu/lanes/lane_scene.h"
#include "collision/exact/forest_cache.h"
#include "collision/gpu/proofs/gpu_proofs.h"
#include "collision/gpu/sliding_balls.h"

namespace gpu_planning_scene::core
{
namespace
{
/// A table of two cells for the first joint that turns.
std::shared_ptr<const JointTable> anyTable(const RobotModel& robot)
{
  auto table = std::make_shared<JointTable>();
  for (const Joint& joint : robot.joints())
    if (table->variables.empty() && joint.type == JointType::Revolute)
    {
      TableVariable variable;
      variable.variable = joint.first_variable;
      variable.wraps = true;
      variable.lower = -1.0;
      variable.cell_width = 1.0;
      variable.cells = 2;
      table->variables.push_back(variable);
    }
  table->cells = {Proof::Apart, Proof::None};
  return table;
}
}  // namespace

void compileProofShaders(const std::string& folder, const std::shared_ptr<const RobotModel>& robot,
                         const std::string& definitions)
{
  PlanningScene scene(robot);
  scene.objects.push_back(
      {"box", Eigen::Isometry3d::Identity(), {{Box{{0.1, 0.1, 0.1}}, Eigen::Isometry3d::Identity()}}});
  for (const bool carries : {false, true})
  {
    if (carries)
    {
      AttachedObject carried;
      carried.object.id = "carried";
      carried.object.shapes = {{Sphere{0.05}, Eigen::Isometry3d::Identity()}};
      carried.link = static_cast<int>(robot->links().size()) - 1;
      scene.attached.push_back(carried);
    }
    const auto problem = std::make_shared<const CollisionProblem>(makeProblem(scene, "", nullptr));
    ForestCache forest;
    forest.exactCheckerOf(problem);
    RobotProofs proofs;
    proofs.covers.assign(problem->robot.size(), ballCover(0.1, 0.0, 0.1));
    proofs.tables.assign(problem->self_pairs.size(), nullptr);
    proofs.tables.front() = anyTable(*robot);
    GpuProofs made(folder, definitions);
    made.set(LaneScene(*robot, *problem, *forest.forest(), std::make_shared<const RobotProofs>(proofs),
                       lanes::kDeviceRounding));
    made.prepareMargins();
  }
}
}  // namespace gpu_planning_scene::core
