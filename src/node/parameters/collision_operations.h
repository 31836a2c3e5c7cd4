#pragma once

#include <string>
#include <vector>

#include <xmlrpcpp/XmlRpcValue.h>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// Makes the entries of MoveIt's parameter default_collision_operations in the scene's matrix: a list of
/// {object1: NAME, object2: NAME, operation: disable}, where disable allows the two bodies to touch and enable forbids
/// it. `parameter`: its name, for messages. If a scene file gave the matrix, this matrix counts, and `warnings` gets a
/// line. Throws Error for a wrong value, and then changes nothing.
void applyCollisionOperations(const XmlRpc::XmlRpcValue& operations, const std::string& parameter, PlanningScene& scene,
                              std::vector<std::string>* warnings);
}  // namespace gpu_planning_scene::core
