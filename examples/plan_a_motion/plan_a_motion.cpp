// plan_a_motion URDF SRDF GROUP START GOAL [SCENE]: plans a path of a planning group between two states, and prints it.
// START and GOAL: one value per variable of the group, "0,0.5,-1", or the name of a state of the SRDF, "ready".
// SCENE: a scene file with the objects around the robot. Meshes of package://NAME/... are found on ROS_PACKAGE_PATH.
#include <iostream>
#include <sstream>

#include <ompl/geometric/SimpleSetup.h>
#include <ompl/util/Console.h>

#include <gpu_planning_scene/batch_checker.h>
#include <gpu_planning_scene/error.h>
#include <gpu_planning_scene/planning/batch_rrt_connect.h>
#include <gpu_planning_scene/planning/motion_validator.h>
#include <gpu_planning_scene/planning/state_validity_checker.h>

using namespace gpu_planning_scene::core;

/// Writes the state that `text` describes into `row`, which has a value for each variable of the robot.
void setState(const std::string& text, const GroupStateSpace& space, std::vector<double>& row)
{
  const RobotModel& robot = *space.robot();
  if (text.find_first_not_of("0123456789+-.eE, ") != std::string::npos)
  {
    const NamedState state = robot.namedState(text);
    for (std::size_t i = 0; i < state.variables.size(); ++i)
      row[state.variables[i]] = state.values[i];
    return;
  }
  std::vector<double> values;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');)
    values.push_back(std::stod(word));
  std::string names;
  for (const int variable : space.variables())
    names += (names.empty() ? "" : ",") + robot.variables()[variable].name;
  if (values.size() != space.variables().size())
    throw Error("'" + text + "' has " + std::to_string(values.size()) + " values; the group has the variables " +
                names);
  for (std::size_t i = 0; i < values.size(); ++i)
    row[space.variables()[i]] = values[i];
}

int main(int argc, char** argv)
try
{
  if (argc != 6 && argc != 7)
    throw Error("usage: plan_a_motion URDF SRDF GROUP START GOAL [SCENE]");
  ompl::msg::setLogLevel(ompl::msg::LOG_WARN);               // its information would stand between the waypoints
  const PackageResolver packages = packageResolver({}, "");  // finds packages on ROS_PACKAGE_PATH
  RobotModelOptions options;
  options.packages = packages;
  const auto robot = RobotModel::fromFiles(argv[1], argv[2], options);
  const auto scene =
      std::make_shared<PlanningScene>(argc == 7 ? loadSceneFile(argv[6], robot, packages) : PlanningScene(robot));
  if (scene->current_state.empty())
    scene->current_state = robot->defaultState();  // the variables outside the group

  const auto space = std::make_shared<GroupStateSpace>(robot, argv[3]);
  ompl::geometric::SimpleSetup setup(space);
  const auto information = setup.getSpaceInformation();
  const auto checker = std::make_shared<BatchChecker>(scene, BatchCheckerOptions());
  setup.setStateValidityChecker(std::make_shared<StateValidityChecker>(information, scene, checker));
  information->setMotionValidator(std::make_shared<MotionValidator>(information, scene, checker));
  setup.setPlanner(std::make_shared<BatchRrtConnect>(information));

  ompl::base::ScopedState<> start(space), goal(space);
  std::vector<double> row = scene->current_state;
  setState(argv[4], *space, row);
  space->copyFromRow(row.data(), start.get());
  setState(argv[5], *space, row);
  space->copyFromRow(row.data(), goal.get());
  setup.setStartAndGoalStates(start, goal);
  const ompl::base::PlannerStatus status = setup.solve(10.0);
  if (status != ompl::base::PlannerStatus::EXACT_SOLUTION)
    throw Error("no path was found within 10 s: " + status.asString());
  setup.getSolutionPath().printAsMatrix(std::cout);  // a row per waypoint; the path is free between them too
  return 0;
}
catch (const std::exception& error)
{
  std::cerr << "plan_a_motion: " << error.what() << std::endl;
  return 1;
}
