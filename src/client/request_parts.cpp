#include "client/request_parts.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

namespace gpu_planning_scene::core
{
namespace
{
template <class Items>
void append(Items& items, Items& added)
{
  items.insert(items.end(), std::make_move_iterator(added.begin()), std::make_move_iterator(added.end()));
}
}  // namespace

CommonState commonStateOf(const gpu_planning_scene::PlanningScene& scene)
{
  CommonState common;
  common.revision = scene.scene_revision;
  const sensor_msgs::JointState& joints = scene.robot_state.joint_state;
  for (std::size_t i = 0; i < std::min(joints.name.size(), joints.position.size()); ++i)
    common.joints[joints.name[i]] = joints.position[i];
  return common;
}

std::size_t plainStates(const CheckStates::Request& request)
{
  const std::size_t width = request.joint_names.size();
  const bool is_plain = request.named_state.empty() && width != 0 && request.positions.size() % width == 0 &&
                        request.scene_diff == gpu_planning_scene::PlanningScene();
  return is_plain ? request.positions.size() / width : 0;
}

std::vector<CheckStates::Request> partsOf(const CheckStates::Request& request, const CommonState& common,
                                          std::size_t variables, std::size_t part_states)
{
  CheckStates::Request pattern = request;
  pattern.positions.clear();
  pattern.scene_revision = common.revision;
  const std::set<std::string> named(request.joint_names.begin(), request.joint_names.end());
  std::vector<double> added;
  for (const auto& [name, value] : common.joints)
    if (named.count(name) == 0)
    {
      pattern.joint_names.push_back(name);
      added.push_back(value);
    }
  std::vector<CheckStates::Request> parts;
  if (named.size() + added.size() != variables)
    return parts;
  const auto width = static_cast<std::ptrdiff_t>(request.joint_names.size());
  const auto rows_of_part = static_cast<std::ptrdiff_t>(part_states);
  for (auto begin = request.positions.begin(); begin != request.positions.end();)
  {
    const std::ptrdiff_t rows = std::min(rows_of_part, (request.positions.end() - begin) / width);
    parts.push_back(pattern);
    std::vector<double>& positions = parts.back().positions;
    if (added.empty())
      positions.assign(begin, begin + rows * width);
    else
      for (std::ptrdiff_t row = 0; row < rows; ++row)
      {
        positions.insert(positions.end(), begin + row * width, begin + (row + 1) * width);
        positions.insert(positions.end(), added.begin(), added.end());
      }
    begin += rows * width;
  }
  return parts;
}

CheckStates::Response joined(const CheckStates::Request& request, std::vector<CheckStates::Response> answers)
{
  // The variables that partsOf added come last.
  const std::size_t named = request.joint_names.size();
  for (CheckStates::Response& answer : answers)
  {
    if (named == 0 || answer.gradient_names.size() <= named)
      continue;
    answer.gradient_names.resize(named);
    for (auto& distance : answer.distances)
      distance.gradient.resize(named);
  }
  CheckStates::Response whole = std::move(answers.front());
  std::set<std::string> messages = {whole.message};
  for (std::size_t i = 1; i < answers.size(); ++i)
  {
    CheckStates::Response& part = answers[i];
    const std::size_t first = whole.valid.size();
    for (auto& contact : part.contacts)
      contact.state += static_cast<std::uint32_t>(first);
    for (auto& distance : part.distances)
      distance.state += static_cast<std::uint32_t>(first);
    append(whole.valid, part.valid);
    append(whole.body_1, part.body_1);
    append(whole.body_2, part.body_2);
    append(whole.contacts, part.contacts);
    append(whole.clearance_world, part.clearance_world);
    append(whole.clearance_self, part.clearance_self);
    append(whole.nearest_world, part.nearest_world);
    append(whole.nearest_self, part.nearest_self);
    append(whole.distances, part.distances);
    whole.seconds += part.seconds;
    // Warnings that name a state count the states of their part.
    if (!part.message.empty() && messages.insert(part.message).second)
      whole.message +=
          (whole.message.empty() ? "" : "; ") + ("from state " + std::to_string(first) + " on: ") + part.message;
  }
  return whole;
}
}  // namespace gpu_planning_scene::core
