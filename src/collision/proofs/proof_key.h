#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "collision/proofs/joint_chain.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// A hash of the bits of a shape, SHA-1. Boost has it, and 160 bits exclude equal hashes by chance. SHA-1 does not
/// resist an attacker; but an attacker who can write into the cache can change the proofs anyway.
using ShapeHash = std::array<char, 20>;

/// `sagitta`: see Tessellation. Takes about 15 ms for 100,000 triangles.
ShapeHash shapeHash(const Shape& shape, double sagitta);

/// One side of a pair with a joint table.
struct TableSide
{
  ShapeHash shape;
  Eigen::Isometry3d pose;  ///< of the shape, in the frame of its link
};

/// The keys of proofs on disk. A key has everything on which the proof depends: the shapes, their motion relative to
/// each other, and the source code that makes proofs.
std::string coverKey(const ShapeHash& shape);
/// `chain`: the joints between the links of `a` and `b`.
std::string tableKey(const RobotModel& robot, const std::vector<ChainJoint>& chain, const TableSide& a,
                     const TableSide& b);
}  // namespace gpu_planning_scene::core
