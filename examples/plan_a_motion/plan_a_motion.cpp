// plan_a_motion URDF SRDF GROUP: plans a path of a planning group between two states, past a ball, and prints it.
#include <iostream>

#include <ompl/geometric/SimpleSetup.h>

#include <gpu_planning_scene/batch_checker.h>
#include <gpu_planning_scene/planning/batch_rrt_connect.h>
#include <gpu_planning_scene/planning/motion_validator.h>
#include <gpu_planning_scene/planning/state_validity_checker.h>

using namespace gpu_planning_scene::core;

int main(int argc, char** argv)
try
{
  if (argc != 4)
    throw std::runtime_error("usage: plan_a_motion URDF SRDF GROUP");
  const auto robot = RobotModel::fromFiles(argv[1], argv[2], {});
  auto scene = std::make_shared<PlanningScene>(robot);
  WorldObject ball;
  ball.id = "ball";
  ball.pose.translation() = Eigen::Vector3d(0.0, 0.12, 0.5);
  ball.shapes.push_back({Sphere{0.06}});
  scene->objects.push_back(ball);

  const auto space = std::make_shared<GroupStateSpace>(robot, argv[3]);
  ompl::geometric::SimpleSetup setup(space);
  const auto information = setup.getSpaceInformation();
  const auto checker = std::make_shared<BatchChecker>(scene, BatchCheckerOptions());
  setup.setStateValidityChecker(std::make_shared<StateValidityChecker>(information, scene, checker));
  information->setMotionValidator(std::make_shared<MotionValidator>(information, scene, checker));
  setup.setPlanner(std::make_shared<BatchRrtConnect>(information));

  ompl::base::ScopedState<> start(space), goal(space);
  start = std::vector<double>{-1.0, 0.8};  // a value for each joint of the group
  goal = std::vector<double>{1.0, 0.8};
  setup.setStartAndGoalStates(start, goal);
  if (setup.solve(10.0) != ompl::base::PlannerStatus::EXACT_SOLUTION)
    throw std::runtime_error("there is no path");
  setup.getSolutionPath().printAsMatrix(std::cout);  // a row per waypoint; the path is free between them too
  return 0;
}
catch (const std::exception& error)
{
  std::cerr << error.what() << std::endl;
  return 1;
}
