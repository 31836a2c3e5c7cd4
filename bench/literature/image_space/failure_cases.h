#pragma once

#include <memory>

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core::literature
{
/// Two shapes of about a metre for which an image-space method is wrong.
struct FailureCase
{
  std::shared_ptr<const Mesh> a;
  std::shared_ptr<const Mesh> b;
  Eigen::Isometry3d b_in_a;
};

/// Two tori that are linked like the parts of a chain, without contact. RECODE takes the hole of a torus as a part of
/// it.
FailureCase linkedTori();

/// A block whose lower end lies 0.1 m deep in a plate. From above, the upper edges of the block hide the lower ones,
/// and no edge of the plate lies inside the block. So CInDeR finds nothing in this view.
FailureCase blockInPlate();
}  // namespace gpu_planning_scene::core::literature
