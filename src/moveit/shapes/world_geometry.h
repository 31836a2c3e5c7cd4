#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <moveit/collision_detection/world.h>

#include "collision/trees/object_tree.h"
#include "moveit/shapes/shape_instance.h"

namespace gpu_planning_scene::detector
{
/// The shapes of a world's objects, in a tree. Copies of an environment share it until one of them changes its world.
/// Concurrent calls of const functions are safe.
class WorldGeometry
{
 public:
  WorldGeometry() = default;
  WorldGeometry(const WorldGeometry& other);
  WorldGeometry& operator=(const WorldGeometry&) = delete;

  /// Adds the object, or replaces its shapes and poses.
  void set(const collision_detection::World::Object& object);
  /// Takes the new poses of an object whose shapes are unchanged. An object that is not known is added.
  void move(const collision_detection::World::Object& object);
  void remove(const std::string& id);

  bool empty() const { return objects_.empty(); }

  /// Calls visit(instance) for the shape instances whose bounds overlap `bounds`, until visit returns true. Returns
  /// whether it did. `stack`: work space.
  template <class Visit>
  bool visitNear(const Eigen::AlignedBox3d& bounds, std::vector<std::uint32_t>& stack, const Visit& visit) const;

  /// Calls visit(instance) for all shape instances.
  template <class Visit>
  void visitAll(const Visit& visit) const
  {
    for (const Slot& slot : slots_)
      if (slot.shape)
        visit(slot.instance());
  }

 private:
  struct Slot
  {
    CollisionShapePtr shape;  // null: the slot is free
    Eigen::Isometry3d pose;
    Eigen::AlignedBox3d bounds;
    bool faulty = false;     // the pose is not valid
    bool in_tree = false;    // the tree has the slot, with these bounds
    bool is_listed = false;  // outside_ has the slot
    const std::string* name = nullptr;

    ShapeInstance instance() const
    {
      return {faulty ? &CollisionShape::faulty() : shape.get(),
              &pose,
              bounds,
              0.0,
              {collision_detection::BodyTypes::WORLD_OBJECT, name, nullptr, nullptr}};
    }
  };
  struct Object
  {
    std::shared_ptr<const std::string> name;
    std::vector<std::uint32_t> slots;  // one per shape
  };

  void place(std::uint32_t number, const Eigen::Isometry3d& pose);
  void updateTree() const;
  void buildTree() const;

  std::map<std::string, Object> objects_;
  mutable std::vector<Slot> slots_;  // mutable: buildTree sets in_tree and is_listed
  std::vector<std::uint32_t> free_slots_;
  // Slots that are not in the tree, and slots without limits: tested one by one. May contain free slots.
  mutable std::vector<std::uint32_t> outside_;
  mutable std::shared_ptr<const core::ObjectTree> tree_;  // over tree_slots_; null: none
  mutable std::shared_ptr<const std::vector<std::uint32_t>> tree_slots_;
  mutable std::mutex building_;
  mutable std::atomic<bool> is_built_{true};
};

template <class Visit>
bool WorldGeometry::visitNear(const Eigen::AlignedBox3d& bounds, std::vector<std::uint32_t>& stack,
                              const Visit& visit) const
{
  updateTree();
  for (const std::uint32_t number : outside_)
  {
    const Slot& slot = slots_[number];
    if (slot.bounds.intersects(bounds) && visit(slot.instance()))
      return true;
  }
  // The tree's box of a slot that is in the tree is the slot's bounds.
  return tree_ && tree_->visitOverlapping(bounds, stack,
                                          [this, &visit](std::uint32_t object)
                                          {
                                            const Slot& slot = slots_[(*tree_slots_)[object]];
                                            return slot.shape && slot.in_tree && visit(slot.instance());
                                          });
}
}  // namespace gpu_planning_scene::detector
