// plan_a_motion [--package NAME=FOLDER] URDF SRDF GROUP START GOAL [SCENE]: plans a path of a planning group between
// two states, and prints it.
// --package: the folder of package://NAME/..., can be repeated. Packages on ROS_PACKAGE_PATH need no option.
// START and GOAL: values by name, "elbow=0.5,wrist=-1"; or one value for each variable that is planned for, in the
// order of the robot, "0,0.5,-1"; or the name of a state of the SRDF, "ready". SCENE: a scene file with the objects
// around the robot.
#include <algorithm>
#include <iostream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <ompl/geometric/SimpleSetup.h>
#include <ompl/util/Console.h>

#include <gpu_planning_scene/batch_checker.h>
#include <gpu_planning_scene/error.h>
#include <gpu_planning_scene/planning/batch_rrt_connect.h>
#include <gpu_planning_scene/planning/motion_validator.h>
#include <gpu_planning_scene/planning/state_validity_checker.h>

using namespace gpu_planning_scene::core;

struct Arguments
{
  std::map<std::string, std::string> packages;  ///< folders by name
  std::vector<std::string> words;               ///< the arguments without --package
};

Arguments argumentsFrom(int argc, char** argv)
{
  Arguments arguments;
  for (int i = 1; i < argc; ++i)
  {
    if (argv[i] != std::string("--package"))
    {
      arguments.words.push_back(argv[i]);
      continue;
    }
    const std::string text = ++i < argc ? argv[i] : "";
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
      throw Error("--package: '" + text + "' is not NAME=FOLDER");
    arguments.packages[text.substr(0, equals)] = text.substr(equals + 1);
  }
  if (arguments.words.size() != 5 && arguments.words.size() != 6)
    throw Error("usage: plan_a_motion [--package NAME=FOLDER] URDF SRDF GROUP START GOAL [SCENE]");
  return arguments;
}

/// The variables that are planned for, in the order of the robot. (The space has another order: joints with limits
/// first.)
std::vector<int> plannedVariables(const GroupStateSpace& space)
{
  std::vector<int> variables = space.variables();
  std::sort(variables.begin(), variables.end());
  return variables;
}

std::string variableNames(const GroupStateSpace& space, const char* separator)
{
  std::string names;
  for (const int variable : plannedVariables(space))
    names += (names.empty() ? "" : separator) + space.robot()->variables()[variable].name;
  return names;
}

/// Reads a number. Throws Error, which names the whole text, if the word is not one.
double numberFrom(const std::string& word, const std::string& text)
{
  std::istringstream stream(word);
  double number = 0.0;
  if (!(stream >> number) || !(stream >> std::ws).eof())
    throw Error("'" + text + "': '" + word + "' is not a number");
  return number;
}

/// Sets the variable of "NAME=VALUE". Variables that the text does not name keep their values.
void setByName(const std::string& word, const std::string& text, const GroupStateSpace& space, std::set<int>& named,
               std::vector<double>& row)
{
  const std::size_t equals = word.find('=');
  const std::string name = word.substr(0, equals);
  const std::vector<int> planned = plannedVariables(space);
  const int variable = space.robot()->variableIndex(name);
  if (equals == std::string::npos)
    throw Error("'" + text + "': give a name for each value or for none");
  if (std::find(planned.begin(), planned.end(), variable) == planned.end())
    throw Error("'" + text + "': the group does not plan for a variable '" + name + "'; its variables are " +
                variableNames(space, ","));
  if (!named.insert(variable).second)
    throw Error("'" + text + "': '" + name + "' is given twice");
  row[variable] = numberFrom(word.substr(equals + 1), text);
}

/// Writes the state that `text` describes into `row`, which has a value for each variable of the robot.
void setState(const std::string& text, const GroupStateSpace& space, std::vector<double>& row)
{
  const RobotModel& robot = *space.robot();
  const bool has_names = text.find('=') != std::string::npos;
  if (!has_names && text.find_first_not_of("0123456789+-.eE, ") != std::string::npos)
  {
    const NamedState state = robot.namedState(text);
    for (std::size_t i = 0; i < state.variables.size(); ++i)
      row[state.variables[i]] = state.values[i];
    return;
  }
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');)
    words.push_back(word);
  std::set<int> named;
  if (has_names)
  {
    for (const std::string& word : words)
      setByName(word, text, space, named, row);
    return;
  }
  const std::vector<int> planned = plannedVariables(space);
  if (words.size() != planned.size())
    throw Error("'" + text + "' has " + std::to_string(words.size()) + (words.size() == 1 ? " value" : " values") +
                "; the group plans for " + variableNames(space, ",") + ", in this order");
  for (std::size_t i = 0; i < words.size(); ++i)
    row[planned[i]] = numberFrom(words[i], text);
}

/// Throws Error if the state is outside the joint limits of the group or in collision. OMPL would say only that it is
/// invalid. `name`: of the state, for the message.
void requireValid(const std::string& name, const std::vector<double>& row, const GroupStateSpace& space,
                  const PlanningScene& scene, StateChecker& checker)
{
  for (const int index : plannedVariables(space))
    if (const Variable& variable = space.robot()->variables()[index];
        variable.bounded && (row[index] < variable.lower || row[index] > variable.upper))
      throw Error("the " + name + " is outside the joint limits: " + variable.name + " is " +
                  std::to_string(row[index]) + ", from " + std::to_string(variable.lower) + " to " +
                  std::to_string(variable.upper) + " is allowed");
  const BatchResult result = checker.check(row.data(), 1);
  if (!result.valid[0])
    throw Error("the " + name + " is in collision: " + scene.bodyName(result.colliding[0][0]) + " and " +
                scene.bodyName(result.colliding[0][1]));
}

int main(int argc, char** argv)
try
{
  const Arguments arguments = argumentsFrom(argc, argv);
  const std::vector<std::string>& words = arguments.words;
  ompl::msg::setLogLevel(ompl::msg::LOG_WARN);  // its information would stand between the waypoints
  const PackageResolver packages = packageResolver(arguments.packages, "name its folder (--package NAME=FOLDER)");
  RobotModelOptions options;
  options.packages = packages;
  options.package_folders = arguments.packages;  // for xacro's $(find NAME)
  const auto robot = RobotModel::fromFiles(words[0], words[1], options);
  const auto scene = std::make_shared<PlanningScene>(words.size() == 6 ? loadSceneFile(words[5], robot, packages)
                                                                       : PlanningScene(robot));
  if (scene->current_state.empty())
    scene->current_state = robot->defaultState();  // the variables outside the group

  const auto space = std::make_shared<GroupStateSpace>(robot, words[2]);
  ompl::geometric::SimpleSetup setup(space);
  const auto information = setup.getSpaceInformation();
  const auto checker = std::make_shared<BatchChecker>(scene);
  setup.setStateValidityChecker(std::make_shared<StateValidityChecker>(information, scene, checker));
  information->setMotionValidator(std::make_shared<MotionValidator>(information, scene, checker));
  setup.setPlanner(std::make_shared<BatchRrtConnect>(information));

  ompl::base::ScopedState<> start(space), goal(space);
  std::vector<double> row = scene->current_state;
  setState(words[3], *space, row);
  requireValid("start", row, *space, *scene, *checker);
  space->copyFromRow(row.data(), start.get());
  setState(words[4], *space, row);
  requireValid("goal", row, *space, *scene, *checker);
  space->copyFromRow(row.data(), goal.get());
  setup.setStartAndGoalStates(start, goal);
  const ompl::base::PlannerStatus status = setup.solve(10.0);
  if (status != ompl::base::PlannerStatus::EXACT_SOLUTION)
    throw Error("no path was found within 10 s: " + status.asString());
  std::cout << variableNames(*space, " ") << "\n";
  for (const ompl::base::State* state : setup.getSolutionPath().getStates())  // the path is free between them too
  {
    space->copyToRow(state, row.data());
    for (const int variable : plannedVariables(*space))
      std::cout << row[variable] << " ";
    std::cout << "\n";
  }
  return 0;
}
catch (const std::exception& error)
{
  std::cerr << "plan_a_motion: " << error.what() << std::endl;
  return 1;
}
