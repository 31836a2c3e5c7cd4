#include "scene/shape_order.h"

#include <algorithm>
#include <memory>
#include <variant>

namespace gpu_planning_scene::core
{
namespace
{
int rankOf(const PlacedShape& placed)
{
  if (std::holds_alternative<HalfSpace>(placed.shape))
    return 2;
  return std::holds_alternative<std::shared_ptr<const Mesh>>(placed.shape) ? 1 : 0;
}
}  // namespace

void orderShapes(std::vector<PlacedShape>& shapes)
{
  std::stable_sort(
      shapes.begin(), shapes.end(), [](const PlacedShape& a, const PlacedShape& b) { return rankOf(a) < rankOf(b); });
}
}  // namespace gpu_planning_scene::core
