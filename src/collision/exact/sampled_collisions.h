#pragma once

#include <vector>

#include "collision/exact/exact_checker.h"
#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// The pairs that collide in each of kSampledStates random states within the joint limits, without
/// CollisionProblem::always_colliding, in ascending order. Pairs between which a planar, floating or passive joint lies
/// are left out: the robot's true pose and the true values of passive joints come from elsewhere, so random values tell
/// nothing about them. `problem` is that of `scene`, `exact` that of `problem`. Usually two or three states
/// suffice: the search ends when no pair has collided in all states so far.
std::vector<BodyPair> collidingInSamples(const PlanningScene& scene, const CollisionProblem& problem,
                                         const ExactChecker& exact);
}  // namespace gpu_planning_scene::core
