#pragma once

#include <vector>

#include <Eigen/Core>

#include "gpu_planning_scene/kinematic_constraints.h"

namespace gpu_planning_scene::core
{
/// A direction in which a group can move links: a variable, or a rotation of a floating joint.
struct DegreeOfFreedom
{
  int variable = -1;     ///< of a floating joint's rotation: the first number of the quaternion
  int axis = -1;         ///< 0 to 2: a rotation of a floating joint about this axis of its child link; else -1
  bool is_turn = false;  ///< an angle; a whole turn leads to the same poses of the links
  bool bounded = false;
  double lower = 0.0;  ///< limits, or the range of random values if there are none
  double upper = 0.0;
};
using DegreesOfFreedom = std::vector<DegreeOfFreedom>;

/// The degrees of freedom with limits that are narrowed to the ranges of constraints.
DegreesOfFreedom narrowed(DegreesOfFreedom freedoms, const std::vector<JointConstraint>& ranges);

/// Moves a state by a step: one number per degree of freedom. Values beyond the limits become the limits.
void advance(const DegreesOfFreedom& freedoms, const Eigen::VectorXd& step, double* state);

/// Moves values beyond the limits to the limits, angles by whole turns first.
void clampToLimits(const DegreesOfFreedom& freedoms, double* state);

/// Adds whole turns to angles, so that they are as near to `wanted` as their limits allow. Of the two quaternions of a
/// rotation, takes the one that is nearer to that of `wanted`.
void turnTowards(const DegreesOfFreedom& freedoms, const double* wanted, double* state);
}  // namespace gpu_planning_scene::core
