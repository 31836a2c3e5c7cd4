#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
inline const std::string& idOf(const WorldObject& object)
{
  return object.id;
}
inline const std::string& idOf(const AttachedObject& attached)
{
  return attached.object.id;
}

/// The objects of a scene while many of them change. A table finds them by their ids. An object that is taken out
/// leaves a gap until close() is called, so that ten thousand changes do not move ten thousand objects each.
template <class Item>
class SceneItems
{
 public:
  explicit SceneItems(std::vector<Item>& items) : items_(items) {}

  /// The object with this id, or null. Valid until the next add().
  Item* find(const std::string& id)
  {
    makeTable();
    const auto known = table_.find(id);
    return known == table_.end() ? nullptr : &items_[known->second];
  }

  Item& add(Item item)
  {
    makeTable();
    table_.emplace(idOf(item), items_.size());
    is_gap_.push_back(false);
    items_.push_back(std::move(item));
    return items_.back();
  }

  /// Takes out an object, which must exist.
  Item take(const std::string& id)
  {
    makeTable();
    const auto known = table_.find(id);
    const std::size_t place = known->second;
    table_.erase(known);
    is_gap_[place] = true;
    return std::move(items_[place]);
  }

  std::vector<std::string> ids()
  {
    makeTable();
    std::vector<std::string> ids;
    for (std::size_t i = 0; i < items_.size(); ++i)
      if (!is_gap_[i])
        ids.push_back(idOf(items_[i]));
    return ids;
  }

  void close()
  {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < is_gap_.size(); ++i)
      if (!is_gap_[i])
      {
        if (kept != i)
          items_[kept] = std::move(items_[i]);
        ++kept;
      }
    if (!is_gap_.empty())
      items_.erase(items_.begin() + static_cast<std::ptrdiff_t>(kept), items_.end());
    is_gap_.clear();
    table_.clear();
  }

 private:
  void makeTable()
  {
    if (is_gap_.size() == items_.size())
      return;
    table_.reserve(items_.size());
    for (std::size_t i = 0; i < items_.size(); ++i)
      table_.emplace(idOf(items_[i]), i);
    is_gap_.assign(items_.size(), false);
  }

  std::vector<Item>& items_;
  std::unordered_map<std::string, std::size_t> table_;  // made when first needed
  std::vector<bool> is_gap_;
};
}  // namespace gpu_planning_scene::core
