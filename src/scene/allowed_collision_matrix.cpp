#include "gpu_planning_scene/allowed_collision_matrix.h"

namespace gpu_planning_scene::core
{
AllowedCollisionMatrix AllowedCollisionMatrix::fromRobot(const RobotModel& robot)
{
  AllowedCollisionMatrix matrix;
  const auto& links = robot.links();
  const SrdfCollisions& srdf = robot.srdfCollisions();
  if (!srdf.has_srdf)
  {
    for (const auto& pair : robot.adjacentLinks())
      matrix.setEntry(links[pair.first].name, links[pair.second].name, true);
    return matrix;
  }
  for (const int link : srdf.disabled_by_default)
    matrix.setDefault(links[link].name, true);
  // As in MoveIt, a pair that is both enabled and disabled ends up disabled.
  for (const LinkPair& pair : srdf.enabled)
    matrix.setEntry(links[pair.first].name, links[pair.second].name, false);
  for (const LinkPair& pair : srdf.disabled)
    matrix.setEntry(links[pair.first].name, links[pair.second].name, true);
  return matrix;
}

void AllowedCollisionMatrix::setEntry(const std::string& body_1, const std::string& body_2, bool allowed)
{
  bodies_[body_1].entries[body_2] = allowed;
  bodies_[body_2].entries[body_1] = allowed;
}

void AllowedCollisionMatrix::setDefault(const std::string& body, bool allowed)
{
  bodies_[body].default_allowed = allowed;
}

std::vector<std::string> AllowedCollisionMatrix::removeEntry(const std::string& body)
{
  const auto known = bodies_.find(body);
  if (known == bodies_.end())
    return {};
  // From now on, the default of the other body decides alone.
  std::vector<std::string> no_longer_forbidden;
  for (const auto& [other, row] : bodies_)
    if (other != body && row.default_allowed.value_or(false) && !allowed(body, other))
      no_longer_forbidden.push_back(other);
  for (const auto& [other, entry] : known->second.entries)
    if (other != body)
      removeHalfOfEntry(other, body);
  bodies_.erase(known);
  return no_longer_forbidden;
}

void AllowedCollisionMatrix::removeHalfOfEntry(const std::string& body, const std::string& other)
{
  const auto known = bodies_.find(body);
  known->second.entries.erase(other);
  if (known->second.entries.empty() && !known->second.default_allowed)
    bodies_.erase(known);
}

bool AllowedCollisionMatrix::allowed(const std::string& body_1, const std::string& body_2) const
{
  return row(body_1).allowed(row(body_2));
}

std::optional<bool> AllowedCollisionMatrix::entryOf(const std::string& body_1, const std::string& body_2) const
{
  const auto known = bodies_.find(body_1);
  if (known == bodies_.end())
    return std::nullopt;
  const auto entry = known->second.entries.find(body_2);
  return entry == known->second.entries.end() ? std::nullopt : std::optional<bool>(entry->second);
}

std::vector<std::string> AllowedCollisionMatrix::bodies() const
{
  std::vector<std::string> names;
  for (const auto& body : bodies_)
    names.push_back(body.first);
  return names;
}

std::vector<std::string> AllowedCollisionMatrix::bodiesWithEntries() const
{
  std::vector<std::string> names;
  for (const auto& body : bodies_)
    if (!body.second.entries.empty())
      names.push_back(body.first);
  return names;
}

std::optional<bool> AllowedCollisionMatrix::defaultOf(const std::string& body) const
{
  const auto known = bodies_.find(body);
  return known == bodies_.end() ? std::nullopt : known->second.default_allowed;
}

std::vector<std::string> AllowedCollisionMatrix::allowedPartners(const std::string& body) const
{
  std::vector<std::string> names;
  const auto known = bodies_.find(body);
  if (known == bodies_.end())
    return names;
  for (const auto& [name, allowed] : known->second.entries)
    if (allowed)
      names.push_back(name);
  return names;
}

AllowedCollisionMatrix::Row AllowedCollisionMatrix::row(const std::string& body) const
{
  Row row;
  row.name_ = &body;
  const auto known = bodies_.find(body);
  row.body_ = known != bodies_.end() ? &known->second : nullptr;
  return row;
}

bool AllowedCollisionMatrix::Row::allowed(const Row& other) const
{
  const std::optional<bool> none;
  const std::optional<bool>& first = body_ != nullptr ? body_->default_allowed : none;
  const std::optional<bool>& second = other.body_ != nullptr ? other.body_->default_allowed : none;
  if (body_ != nullptr && other.body_ != nullptr)
  {
    const auto entry = body_->entries.find(*other.name_);
    if (entry != body_->entries.end())
      return entry->second;
  }
  // Each default that there is must allow the pair, and there must be one.
  return (first || second) && first.value_or(true) && second.value_or(true);
}
}  // namespace gpu_planning_scene::core
