#pragma once

#include <cstddef>
#include <vector>

#include "gpu_planning_scene/state_inspector.h"
#include "node/messages/messages.h"

namespace gpu_planning_scene::core
{
/// The message of a contact. `state`: the row of the request. `scene`: that of the contact.
ContactInformation messageOf(const Contact& contact, const PlanningScene& scene, std::size_t state);

/// The message of pair number `pair` of `distances`, with the columns `variables` of its gradient. `state`: the row of
/// the request.
BodyDistanceMessage messageOf(const BodyDistances& distances, std::size_t pair, const std::vector<int>& variables,
                              const PlanningScene& scene, std::size_t state);

/// The message of a nearest pair. Without a pair, it has no bodies.
NearestPairMessage messageOf(const NearestPair& pair, const PlanningScene& scene);
}  // namespace gpu_planning_scene::core
