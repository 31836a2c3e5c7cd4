#include "gpu_planning_scene/allowed_collision_matrix.h"

namespace gpu_planning_scene
{
namespace
{
std::pair<std::string, std::string> key(const std::string& body_1, const std::string& body_2)
{
  return body_1 < body_2 ? std::make_pair(body_1, body_2) : std::make_pair(body_2, body_1);
}
}  // namespace

AllowedCollisionMatrix AllowedCollisionMatrix::fromRobot(const RobotModel& robot)
{
  AllowedCollisionMatrix matrix;
  const auto& links = robot.links();
  const SrdfCollisions& srdf = robot.srdfCollisions();
  if (!srdf.has_srdf)
  {
    for (const auto& pair : robot.adjacentLinks())
    {
      matrix.setEntry(links[pair.first].name, links[pair.second].name, true);
    }
    return matrix;
  }
  for (const int link : srdf.disabled_by_default)
  {
    matrix.setDefault(links[link].name, true);
  }
  // As in MoveIt, a pair that is both enabled and disabled ends up disabled.
  for (const LinkPair& pair : srdf.enabled)
  {
    matrix.setEntry(links[pair.first].name, links[pair.second].name, false);
  }
  for (const LinkPair& pair : srdf.disabled)
  {
    matrix.setEntry(links[pair.first].name, links[pair.second].name, true);
  }
  return matrix;
}

void AllowedCollisionMatrix::setEntry(const std::string& body_1, const std::string& body_2, bool allowed)
{
  entries_[key(body_1, body_2)] = allowed;
}

void AllowedCollisionMatrix::setDefault(const std::string& body, bool allowed)
{
  defaults_[body] = allowed;
}

bool AllowedCollisionMatrix::allowed(const std::string& body_1, const std::string& body_2) const
{
  const auto entry = entries_.find(key(body_1, body_2));
  if (entry != entries_.end())
  {
    return entry->second;
  }
  const auto default_1 = defaults_.find(body_1);
  const auto default_2 = defaults_.find(body_2);
  if (default_1 != defaults_.end() && default_2 != defaults_.end())
  {
    return default_1->second && default_2->second;
  }
  if (default_1 != defaults_.end())
  {
    return default_1->second;
  }
  return default_2 != defaults_.end() && default_2->second;
}
}  // namespace gpu_planning_scene
