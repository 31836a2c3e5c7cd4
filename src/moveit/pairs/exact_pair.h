#pragma once

#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/cpu_shape_pair.h"
#include "moveit/shapes/shape_instance.h"

namespace gpu_planning_scene::detector
{
/// Work space of one thread.
using PairScratch = core::CpuShapePair::Scratch;

/// The exact test of two shapes.
const core::CpuShapePair& exactTest();

/// Whether the oriented boxes of two shape instances overlap, grown by their paddings. Half-spaces, octrees and faulty
/// shapes have no boxes and always overlap.
bool boxesOverlap(const ShapeInstance& a, const ShapeInstance& b);

/// Whether two shape instances collide, by the rules of the project's README: their distance is at most the sum of
/// their paddings, or one contains the other. A faulty shape collides with every other shape. A half-space or an octree
/// collides with every other half-space or octree, unless two half-spaces face away from each other. `margin`: an
/// additional distance that is required.
bool collide(const ShapeInstance& a, const ShapeInstance& b, PairScratch& scratch, double margin = 0.0);

/// The clearance of two shape instances that do not collide: their distance minus the sum of their paddings; `most` if
/// it is `most` or more. At most 1e-6 m below the true value, and never above it.
double clearance(const ShapeInstance& a, const ShapeInstance& b, double most, PairScratch& scratch);

/// A half-space in the planning frame.
core::PlacedHalfSpace placedHalfSpace(const ShapeInstance& instance);

/// An occupied leaf of an octree.
struct Leaf
{
  std::shared_ptr<const CollisionShape> shape;  ///< a cube
  Eigen::Isometry3d pose;                       ///< in the planning frame
};

/// The occupied leaves of an octree that collide with a solid. At most `most` leaves.
std::vector<Leaf> collidingLeaves(const ShapeInstance& octree, const ShapeInstance& solid, std::size_t most,
                                  PairScratch& scratch);

/// The occupied leaf that is nearest to a solid, if its clearance is below `least`, which is then set to it.
bool nearestLeaf(const ShapeInstance& octree, const ShapeInstance& solid, double& least, Leaf& leaf,
                 PairScratch& scratch);
}  // namespace gpu_planning_scene::detector
