#pragma once

#include <memory>

#include "literature/method.h"
#include "literature/shared_tree.h"
#include "literature/trees/dop_tree.h"

namespace gpu_planning_scene::core::literature
{
std::unique_ptr<Method> makeDop24(const MeshPtr& a, const MeshPtr& b);

/// Bounds the extent of a 24-DOP along other axes by the extents along its own ones. See dop24.cpp.
class Realignment
{
 public:
  /// For a DOP of b that is aligned with a.
  explicit Realignment(const Eigen::Isometry3d& b_in_a);
  Slabs<12> operator()(const Slabs<12>& slabs) const;

 private:
  struct Row
  {
    std::array<std::uint8_t, 3> planes;  ///< plane 2 i: the upper side of slab i; 2 i + 1: its lower side
    std::array<double, 3> weights;
    double shift;
  };
  std::array<Row, 12> rows_;
};
}  // namespace gpu_planning_scene::core::literature
