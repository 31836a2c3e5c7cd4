#include "scene/shape_order.h"

#include <memory>
#include <utility>
#include <variant>

namespace gpu_planning_scene::core
{
namespace
{
constexpr int kRanks = 3;

int rankOf(const PlacedShape& placed)
{
  if (std::holds_alternative<HalfSpace>(placed.shape))
    return 2;
  return std::holds_alternative<std::shared_ptr<const Mesh>>(placed.shape) ? 1 : 0;
}
}  // namespace

void orderShapes(std::vector<PlacedShape>& shapes)
{
  // One pass for each rank. std::stable_sort swaps variants, for which GCC 12 warns of uninitialized members.
  std::vector<PlacedShape> ordered;
  ordered.reserve(shapes.size());
  for (int rank = 0; rank < kRanks; ++rank)
    for (PlacedShape& shape : shapes)
      if (rankOf(shape) == rank)  // a shape that was moved keeps its kind, so its rank
        ordered.push_back(std::move(shape));
  shapes = std::move(ordered);
}
}  // namespace gpu_planning_scene::core
