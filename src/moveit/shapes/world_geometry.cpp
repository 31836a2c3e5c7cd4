#include "moveit/shapes/world_geometry.h"

#include <algorithm>
#include <cmath>
#include <utility>

// A change puts the shapes of the changed object on a list that is searched linearly. When the list has become long, a
// new tree is built over all shapes, by the next check. So the cost of a change does not grow with the scene.
namespace gpu_planning_scene::detector
{
namespace
{
/// The longest list of shapes outside of the tree. Its square root growth balances the search of the list in each check
/// with the cost of a new tree.
std::size_t longestList(std::size_t shapes)
{
  return 8 + 2 * static_cast<std::size_t>(std::sqrt(static_cast<double>(shapes)));
}
}  // namespace

WorldGeometry::WorldGeometry(const WorldGeometry& other)
{
  const std::lock_guard<std::mutex> lock(other.building_);
  objects_ = other.objects_;
  slots_ = other.slots_;
  free_slots_ = other.free_slots_;
  outside_ = other.outside_;
  tree_ = other.tree_;
  tree_slots_ = other.tree_slots_;
  is_built_ = other.is_built_.load();
}

void WorldGeometry::place(std::uint32_t number, const Eigen::Isometry3d& pose)
{
  Slot& slot = slots_[number];
  slot.pose = pose;
  const ShapeInstance instance = makeShapeInstance(*slot.shape, slot.pose, 0.0, slot.instance().body);
  slot.bounds = instance.bounds;
  slot.faulty = instance.shape != slot.shape.get();
  slot.in_tree = false;
  if (!slot.is_listed)
    outside_.push_back(number);
  slot.is_listed = true;
}

void WorldGeometry::set(const collision_detection::World::Object& object)
{
  remove(object.id_);
  Object& added = objects_[object.id_];
  added.name = std::make_shared<const std::string>(object.id_);
  added.slots.reserve(object.shapes_.size());
  for (std::size_t i = 0; i < object.shapes_.size(); ++i)
  {
    if (free_slots_.empty())
    {
      free_slots_.push_back(static_cast<std::uint32_t>(slots_.size()));
      slots_.emplace_back();
    }
    const std::uint32_t number = free_slots_.back();
    CollisionShapePtr shape = collisionShapeOf(object.shapes_[i], 1.0, object.id_);
    if (shape->kind() == ShapeKind::Empty)
      continue;
    free_slots_.pop_back();
    slots_[number].shape = std::move(shape);
    slots_[number].name = added.name.get();
    place(number, object.global_shape_poses_[i]);
    added.slots.push_back(number);
  }
  is_built_ = false;
}

void WorldGeometry::move(const collision_detection::World::Object& object)
{
  const auto known = objects_.find(object.id_);
  // An object with an empty shape has fewer slots than shapes.
  if (known == objects_.end() || known->second.slots.size() != object.global_shape_poses_.size())
    return set(object);
  for (std::size_t i = 0; i < object.global_shape_poses_.size(); ++i)
    place(known->second.slots[i], object.global_shape_poses_[i]);
  is_built_ = false;
}

void WorldGeometry::remove(const std::string& id)
{
  const auto known = objects_.find(id);
  if (known == objects_.end())
    return;
  for (const std::uint32_t number : known->second.slots)
  {
    slots_[number].shape.reset();
    slots_[number].bounds.setEmpty();
    slots_[number].in_tree = false;
    free_slots_.push_back(number);
  }
  objects_.erase(known);
  is_built_ = false;
}

void WorldGeometry::updateTree() const
{
  if (is_built_.load(std::memory_order_acquire))
    return;
  const std::lock_guard<std::mutex> lock(building_);
  if (!is_built_.load(std::memory_order_relaxed))
  {
    buildTree();
    is_built_.store(true, std::memory_order_release);
  }
}

void WorldGeometry::buildTree() const
{
  const auto is_limited = [this](std::uint32_t number) { return slots_[number].bounds.min().allFinite(); };
  const auto unlist_if = [this](const auto& predicate)
  {
    const auto unlist = [&](std::uint32_t number)
    {
      const bool is_removed = predicate(number);
      slots_[number].is_listed = !is_removed;
      return is_removed;
    };
    outside_.erase(std::remove_if(outside_.begin(), outside_.end(), unlist), outside_.end());
  };
  unlist_if([this](std::uint32_t number) { return !slots_[number].shape; });
  const auto limited = static_cast<std::size_t>(std::count_if(outside_.begin(), outside_.end(), is_limited));
  if (limited <= longestList(slots_.size() - free_slots_.size()))
    return;
  unlist_if(is_limited);
  auto numbers = std::make_shared<std::vector<std::uint32_t>>();
  std::vector<Eigen::AlignedBox3d> boxes;
  for (std::uint32_t number = 0; number < slots_.size(); ++number)
  {
    Slot& slot = slots_[number];
    if (!slot.shape || !is_limited(number))
      continue;
    slot.in_tree = true;
    numbers->push_back(number);
    boxes.push_back(slot.bounds);
  }
  tree_ = std::make_shared<const core::ObjectTree>(std::move(boxes), core::ObjectTree());
  tree_slots_ = std::move(numbers);
}
}  // namespace gpu_planning_scene::detector
