#include "tools/state_values.h"

#include <set>
#include <sstream>

#include "base/text/name_list.h"
#include "command_line/command_line.h"
#include "command_line/scene_arguments.h"
#include "model/full_states.h"
#include "model/joint_limits.h"

namespace gpu_planning_scene::core
{
std::vector<double> startState(const PlanningScene& scene)
{
  return scene.current_state.empty() ? scene.robot->defaultState() : scene.current_state;
}

SetValues setValues(const RobotModel& robot, const std::string& text, bool has_state, std::vector<double>& state)
{
  if (text.empty())
    throw UsageError("--state: the text is empty; give NAME=VALUE or the name of a state of the SRDF");
  std::set<int> columns;
  std::set<int> assigned;  // by NAME=VALUE
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');)
  {
    const std::size_t equals = word.find('=');
    try
    {
      if (equals == std::string::npos)
      {
        const NamedState named = robot.namedState(word);
        for (std::size_t i = 0; i < named.variables.size(); ++i)
          state[static_cast<std::size_t>(named.variables[i])] = named.values[i];
        columns.insert(named.variables.begin(), named.variables.end());
        continue;
      }
      const int variable = variableIndices(robot, {word.substr(0, equals)}).front();
      if (!assigned.insert(variable).second)
        throw Error("variable '" + word.substr(0, equals) + "' is given twice");
      state[static_cast<std::size_t>(variable)] = numbersFrom("--state", word.substr(equals + 1), 1)[0];
      columns.insert(variable);
    }
    catch (const UsageError&)
    {
      throw;
    }
    catch (const Error& error)
    {
      throw UsageError("--state: '" + word + "': " + error.what());
    }
  }
  const std::vector<int> variables(columns.begin(), columns.end());
  std::vector<double> values;
  for (const int variable : variables)
    values.push_back(state[static_cast<std::size_t>(variable)]);
  const auto outside = findDoubtfulValue(robot, variables, values.data(), 1);
  std::vector<std::string> assumed;
  const std::vector<bool> may_be_missing = PartialState(robot).known;
  for (std::size_t i = 0; i < state.size() && !has_state; ++i)
    if (!may_be_missing[i] && columns.count(static_cast<int>(i)) == 0)
      assumed.push_back(robot.variables()[i].name);
  std::string warning = outside ? "--state: " + outside->text : "";
  if (!assumed.empty())
    warning +=
        (warning.empty() ? "--state: " : "; ") + ("joints without a value get their default: " + nameList(assumed));
  return {variables, warning};
}

void randomise(const RobotModel& robot, std::mt19937_64& generator, const std::vector<double>& start, bool keep_base,
               double* state)
{
  if (keep_base)
    robot.randomState(generator, start.data(), state);
  else
    robot.randomState(generator, state);
}
}  // namespace gpu_planning_scene::core
