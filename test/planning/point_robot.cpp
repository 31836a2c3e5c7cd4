#include "planning/point_robot.h"

#include <string>

#include <ompl/base/goals/GoalStates.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/planning/state_validity_checker.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;

std::shared_ptr<const RobotModel> slidingCube()
{
  const std::string limits = R"(<limit lower="-2" upper="2" effort="1" velocity="1"/>)";
  return robotOf(R"(<link name="base"/><link name="slide"/>
                    <link name="cube"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>)" +
                     jointXml("x", "prismatic", "base", "slide", R"(<axis xyz="1 0 0"/>)" + limits) +
                     jointXml("y", "prismatic", "slide", "cube", R"(<axis xyz="0 1 0"/>)" + limits),
                 R"(<group name="plane"><joint name="x"/><joint name="y"/></group>)");
}
}  // namespace

PointRobot::PointRobot(const std::vector<Wall>& walls, const MotionCheckerOptions& options)
{
  PlanningScene scene(slidingCube());
  for (const Wall& wall : walls)
  {
    WorldObject object;
    object.id = "wall_" + std::to_string(scene.objects.size());
    object.pose.translation() =
        Eigen::Vector3d(0.5 * (wall.x_lower + wall.x_upper), 0.5 * (wall.y_lower + wall.y_upper), 0.0);
    object.shapes.push_back({Box{{wall.x_upper - wall.x_lower, wall.y_upper - wall.y_lower, 1.0}}});
    scene.objects.push_back(object);
  }
  scene_ = std::make_shared<const PlanningScene>(std::move(scene));
  checker_ = std::make_shared<CpuChecker>(scene_);
  information_ = std::make_shared<ob::SpaceInformation>(std::make_shared<GroupStateSpace>(scene_->robot, "plane"));
  information_->setStateValidityChecker(std::make_shared<StateValidityChecker>(information_, scene_, checker_));
  validator_ = std::make_shared<MotionValidator>(information_, scene_, checker_, options);
  information_->setMotionValidator(validator_);
  information_->setup();
}

ob::ScopedState<> PointRobot::at(const Position& position) const
{
  ob::ScopedState<> state(information_);
  state = std::vector<double>{position.first, position.second};
  return state;
}

PointRobot::Position PointRobot::positionOf(const ob::State* state)
{
  const auto* joints = state->as<ob::CompoundState>()->as<ob::RealVectorStateSpace::StateType>(0);
  return {joints->values[0], joints->values[1]};
}

ob::ProblemDefinitionPtr PointRobot::problem(const Position& start, const std::vector<Position>& goals) const
{
  auto problem = std::make_shared<ob::ProblemDefinition>(information_);
  problem->addStartState(at(start));
  const auto states = std::make_shared<ob::GoalStates>(information_);
  for (const Position& goal : goals)
    states->addState(at(goal));
  problem->setGoal(states);
  return problem;
}

ompl::geometric::PathGeometric PointRobot::path(const std::vector<Position>& positions) const
{
  ompl::geometric::PathGeometric path(information_);
  for (const Position& position : positions)
    path.append(at(position).get());
  return path;
}
}  // namespace gpu_planning_scene::core
