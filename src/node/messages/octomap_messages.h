#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "gpu_planning_scene/scene_change.h"
#include "node/messages/messages.h"

namespace gpu_planning_scene::core
{
/// The change that an octomap makes: it adds the object kOctomapId, or removes it if the octomap has no occupied leaf.
/// No value: the message has no octomap, because `octomap.id` is empty. `max_leaves`: most occupied leaves; 0: no
/// limit. Throws Error for data that are not an octree, and for more leaves.
std::optional<ObjectChange> octomapChangeFrom(const OctomapWithPose& message, std::size_t max_leaves);

/// The message of a change of the object kOctomapId: the octree in its binary form, without free leaves. As in MoveIt,
/// a removal has the id "cleared" and no data.
OctomapWithPose octomapMessageOf(const ObjectChange& change, const std::string& planning_frame);
}  // namespace gpu_planning_scene::core
