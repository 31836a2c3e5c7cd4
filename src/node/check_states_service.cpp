#include "node/check_states_service.h"

#include <cmath>
#include <exception>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene
{
namespace
{
std::vector<double> statesOf(const CheckStates::Request& request, const RobotModel& robot, const PartialState& current)
{
  if (request.joint_names.empty())
    throw Error("joint_names is empty; name at least one variable");
  const std::vector<int> columns = variableIndices(robot, request.joint_names);
  const std::size_t width = columns.size();
  if (request.positions.size() % width != 0)
    throw Error(std::to_string(request.positions.size()) + " positions are not rows of " + std::to_string(width) +
                " values, one per joint name");
  for (std::size_t i = 0; i < request.positions.size(); ++i)
    if (!std::isfinite(request.positions[i]))
      throw Error("state " + std::to_string(i / width) + ": the position of '" + request.joint_names[i % width] +
                  "' is not a finite number");
  return fullStates(robot, columns, request.positions.data(), request.positions.size() / width, current);
}

CheckStates::Response responseFrom(const BatchResult& result, const PlanningScene& scene)
{
  CheckStates::Response response;
  response.success = true;
  response.valid = result.valid;
  response.body_1.resize(result.valid.size());
  response.body_2.resize(result.valid.size());
  for (std::size_t i = 0; i < result.valid.size(); ++i)
  {
    if (result.valid[i])
      continue;
    response.body_1[i] = scene.bodyName(result.colliding[i][0]);
    response.body_2[i] = scene.bodyName(result.colliding[i][1]);
  }
  response.scene_revision = result.revision;
  response.seconds = result.seconds;
  return response;
}

CheckStates::Response refusal(const std::string& message)
{
  CheckStates::Response response;
  response.success = false;
  response.message = message;
  return response;
}
}  // namespace

CheckStates::Response answerCheckStates(const CheckStates::Request& request, const PlanningScene& scene,
                                        const PartialState& current, StateChecker& checker)
{
  try
  {
    const std::vector<double> states = statesOf(request, *scene.robot, current);
    const std::size_t count = states.size() / scene.robot->variables().size();
    return responseFrom(checker.check(states.data(), count, request.group), scene);
  }
  catch (const std::bad_alloc&)
  {
    return refusal("out of memory; send fewer states at once");
  }
  catch (const std::exception& error)
  {
    return refusal(error.what());
  }
  catch (...)
  {
    return refusal("unknown error");
  }
}
}  // namespace gpu_planning_scene
