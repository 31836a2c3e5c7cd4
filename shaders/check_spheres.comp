// One lane per (state, robot instance): the sphere around its root box in the planning frame. Out: centre and radius.
#include "interface.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common.glsl"
#include "pose.glsl"
#include "boxes.glsl"
#include "geometries.glsl"
layout(binding = UNIT_ROBOT_POSES) uniform usamplerBuffer robot_poses;
layout(std430, binding = BINDING_A) writeonly buffer Spheres { vec4 spheres[]; };

void main()
{
  const uint i = invocationIndex();
  if (i >= state_count * robot_count)
    return;
  const Instance instance = fetchInstance(robotOf(i));
  const Box box = fetchNode(instance.root).box;
  const vec3 center = apply(fetchPose(robot_poses, poseIndex(stateOf(i), robotOf(i))), box.center);
  // 1e-5: rounding of the pose, of the product and of the comparison, relative to all lengths that enter.
  const float error = 1e-5 * (abs(center.x) + abs(center.y) + abs(center.z) + length(box.center) + length(box.extent));
  spheres[i] = vec4(center, length(box.extent) + instance.slack + CONTRACT_BAND + error);
}
