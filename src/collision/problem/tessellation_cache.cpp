#include "collision/problem/tessellation_cache.h"

#include <iterator>

#include "collision/geometry/primitive_solid.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kFewEntries = 1024;
}  // namespace

Tessellation TessellationCache::of(const Shape& shape)
{
  if (isMesh(shape))
    return tessellate(shape);
  if (primitives_.size() > 2 * size_when_cleared_ + kFewEntries)
  {
    for (auto entry = primitives_.begin(); entry != primitives_.end();)
      entry = entry->second.mesh.expired() ? primitives_.erase(entry) : std::next(entry);
    size_when_cleared_ = primitives_.size();
  }
  Entry& entry = primitives_[ShapeKey(shape)];
  if (auto mesh = entry.mesh.lock())
    return {std::move(mesh), entry.sagitta};
  const Tessellation made = tessellate(shape);
  entry = {made.mesh, made.sagitta};
  return made;
}
}  // namespace gpu_planning_scene::core
