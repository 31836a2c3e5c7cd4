#pragma once

#include <memory>

#include "literature/method.h"
#include "literature/shared_tree.h"
#include "literature/trees/dop_tree.h"

namespace gpu_planning_scene::core::literature
{
/// Which of two overlapping nodes is opened, if neither is a leaf.
enum class DopDescent
{
  FixedFirst,  ///< the node of the fixed mesh, as in the paper, whose moving mesh is small
  Larger       ///< the larger one
};

std::unique_ptr<Method> makeDop18(const MeshPtr& a, const MeshPtr& b, DopDescent descent);

/// The corners of an 18-DOP. It contains points that lie outside by at most a billionth of its size.
std::vector<Eigen::Vector3d> cornersOf(const Slabs<9>& slabs);
}  // namespace gpu_planning_scene::core::literature
