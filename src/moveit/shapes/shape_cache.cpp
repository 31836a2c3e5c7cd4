#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <shared_mutex>
#include <utility>
#include <vector>

#include "moveit/shapes/collision_shape.h"
#include "moveit/shapes/log.h"

// Like MoveIt's FCL detector, finds the conversion of a shape by the shape's weak pointer. MoveIt's scenes, states and
// robot models share their shapes, so a copied scene or an attached object costs no conversion.
namespace gpu_planning_scene::detector
{
namespace
{
/// Numbers that change when MoveIt scales or pads a shape in place, which it does with the shapes of attached bodies.
using Fingerprint = std::array<double, 8>;

/// NaN equals NaN, so that a shape with such a number is converted once too.
bool equal(const Fingerprint& a, const Fingerprint& b)
{
  return std::equal(
      a.begin(), a.end(), b.begin(), [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

Fingerprint fingerprintOf(const shapes::Shape& shape)
{
  switch (shape.type)
  {
    case shapes::BOX:
    {
      const auto& size = static_cast<const shapes::Box&>(shape).size;
      return {size[0], size[1], size[2]};
    }
    case shapes::SPHERE:
      return {static_cast<const shapes::Sphere&>(shape).radius};
    case shapes::CYLINDER:
      return {static_cast<const shapes::Cylinder&>(shape).radius, static_cast<const shapes::Cylinder&>(shape).length};
    case shapes::CONE:
      return {static_cast<const shapes::Cone&>(shape).radius, static_cast<const shapes::Cone&>(shape).length};
    case shapes::MESH:
    {
      const auto& mesh = static_cast<const shapes::Mesh&>(shape);
      if (mesh.vertex_count == 0)
        return {};
      const double* const first = mesh.vertices;
      const double* const last = first + 3 * (std::size_t{mesh.vertex_count} - 1);
      return {static_cast<double>(mesh.vertex_count),
              static_cast<double>(mesh.triangle_count),
              first[0],
              first[1],
              first[2],
              last[0],
              last[1],
              last[2]};
    }
    default:
      return {};
  }
}

class ShapeCache
{
 public:
  CollisionShapePtr find(const shapes::ShapeConstPtr& shape, double scale)
  {
    const std::shared_lock<std::shared_mutex> lock(mutex_);
    const auto found = shapes_.find(shape);
    if (found == shapes_.end() || !equal(found->second.fingerprint, fingerprintOf(*shape)))
      return nullptr;
    for (const auto& [its_scale, converted] : found->second.scaled)
      if (its_scale == scale)
        return converted;
    return nullptr;
  }

  /// Returns the conversion that is known by now: another thread may have added it.
  CollisionShapePtr add(const shapes::ShapeConstPtr& shape, double scale, CollisionShapePtr converted)
  {
    const std::lock_guard<std::shared_mutex> lock(mutex_);
    forgetUnused();
    Entry& known = shapes_[shape];
    const Fingerprint fingerprint = fingerprintOf(*shape);
    if (!equal(known.fingerprint, fingerprint))
      known = {fingerprint, {}};
    for (const auto& [its_scale, earlier] : known.scaled)
      if (its_scale == scale)
        return earlier;
    known.scaled.emplace_back(scale, std::move(converted));
    return known.scaled.back().second;
  }

  void remove()
  {
    const std::lock_guard<std::shared_mutex> lock(mutex_);
    forgetUnused();
  }

 private:
  /// Looks through the entries only after a number of calls that grows with the entries, so that a call costs the same
  /// on average however many entries there are.
  void forgetUnused()
  {
    if (++calls_ < shapes_.size() / 4)
      return;
    calls_ = 0;
    for (auto entry = shapes_.begin(); entry != shapes_.end();)
      entry = entry->first.expired() ? shapes_.erase(entry) : std::next(entry);
  }

  struct Entry
  {
    Fingerprint fingerprint = {};
    std::vector<std::pair<double, CollisionShapePtr>> scaled;  // by scale
  };

  std::shared_mutex mutex_;  // guards the members below; not held while a shape is converted
  std::map<std::weak_ptr<const shapes::Shape>, Entry, std::owner_less<>> shapes_;
  std::size_t calls_ = 0;
};

ShapeCache& shapeCache()
{
  static ShapeCache cache;
  return cache;
}
}  // namespace

CollisionShapePtr collisionShapeOf(const shapes::ShapeConstPtr& shape, double scale, const std::string& name)
{
  if (CollisionShapePtr known = shapeCache().find(shape, scale))
    return known;
  auto converted = std::make_shared<const CollisionShape>(*shape, scale, name);
  if (converted->kind() == ShapeKind::Faulty)
    ROS_ERROR_STREAM_NAMED(kLogName, "A shape of '" << name << "' cannot be checked: " << converted->fault()
                                                    << ". It counts as colliding with every body that is checked "
                                                       "against it.");
  else if (converted->kind() == ShapeKind::Empty)
    ROS_WARN_STREAM_NAMED(kLogName, "A mesh of '" << name << "' has no triangles, so it collides with nothing");
  return shapeCache().add(shape, scale, std::move(converted));
}

void forgetUnusedShapes()
{
  shapeCache().remove();
}
}  // namespace gpu_planning_scene::detector
