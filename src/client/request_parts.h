#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <gpu_planning_scene/CheckStates.h>
#include <gpu_planning_scene/PlanningScene.h>

namespace gpu_planning_scene::core
{
/// The revision of the scene, and the values of joints by the name of their variable. They are the same for all parts
/// of a request.
struct CommonState
{
  std::uint64_t revision = 0;
  std::map<std::string, double> joints;
};

/// The common state in a scene of ~get_planning_scene.
CommonState commonStateOf(const gpu_planning_scene::PlanningScene& scene);

/// The number of states of a request whose states all parts can have; 0 if it must go to one node as it is.
std::size_t plainStates(const CheckStates::Request& request);

/// Splits a request into parts of `part_states` states. Joints that it does not name get their values of `common`, as
/// further columns. Returns an empty list if the rows then lack one of the `variables` variables of the robot.
std::vector<CheckStates::Request> partsOf(const CheckStates::Request& request, const CommonState& common,
                                          std::size_t variables, std::size_t part_states);

/// The answer to the whole request. `answers`: to the parts, in their order.
CheckStates::Response joined(const CheckStates::Request& request, std::vector<CheckStates::Response> answers);
}  // namespace gpu_planning_scene::core
