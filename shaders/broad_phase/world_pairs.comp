// Broad phase against the world. One invocation per (state, query): finds the world instances near one robot instance.
// It traverses the tree over the world instances with the bounding box of the robot instance. Overlapping boxes make a
// candidate. The tree has skip pointers instead of a stack (B. Smits: Efficiency Issues for Ray Tracing, 1998).
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "problem/instance_lists.glsl"
#include "common/comparisons.glsl"
#include "broad_phase/candidates.glsl"
#include "geometry/pose.glsl"
#include "problem/nodes.glsl"
#include "broad_phase/placed_instance.glsl"
#include "broad_phase/queries.glsl"
#include "traversal/verdicts.glsl"
layout(location = LOCATION_WORLD_COUNT) uniform uint world_count;
layout(location = LOCATION_HALF_SPACE_COUNT) uniform uint half_space_count;
// See half_spaces.comp.
layout(std430, binding = BINDING_C) readonly buffer HalfSpaces { vec4 half_spaces[]; };
// One bit per pair: [robot][half-space].
layout(std430, binding = BINDING_D) readonly buffer HalfSpacePairs { uint half_space_pairs[]; };
// First texel of a node: the centre of its box, and the next node if the boxes are apart. Second texel: the half
// extents, and the world instance or NO_OBJECT. If the boxes overlap, the traversal continues with the next node in the
// list. So no stack is needed. The traversal ends behind the last node.
layout(binding = UNIT_OBJECT_TREE) uniform usamplerBuffer object_tree;
layout(binding = UNIT_WORLD_PAIRS) uniform usamplerBuffer world_pairs;

bool isChecked(uint robot, uint world)
{
  const uint bit = robot * world_count + world;
  return (texelFetch(world_pairs, int(bit >> 7u))[bit >> 5u & 3u] >> (bit & 31u) & 1u) != 0u;
}

// Adds the half-spaces that the box around a robot instance may reach.
void addHalfSpaces(uint state, uint robot, vec3 center, vec3 extent)
{
  for (uint h = 0u; h < half_space_count; ++h)
  {
    const uint bit = robot * half_space_count + h;
    const vec4 plane = half_spaces[HALF_SPACE_TEXELS * h];
    const float padding = half_spaces[HALF_SPACE_TEXELS * h + 1u].x;
    const float reach = dot(abs(plane.xyz), extent) + padding;
    const float error = 1e-5 * (dot(abs(plane.xyz), abs(center)) + abs(plane.w) + reach);
    // With an infinite margin, a product with 0 is NaN, which proves nothing.
    const bool apart = provenGreater(dot(plane.xyz, center) - plane.w, reach + error);
    if (!apart && (half_space_pairs[bit >> 5u] >> (bit & 31u) & 1u) != 0u)
      addCandidate(state, packPair(robot, robot_count + world_count + h));
  }
}

void main()
{
  const uint i = invocationIndex();
  if (i >= state_count * query_count)
    return;
  const uint state = stateOf(i);
  if (isDecided(state))
    return;
  const uint robot = fetchQuery(rowOf(i)).x;
  const PlacedInstance placed = place(robot, state);
  const vec3 center = placed.center;
  const vec3 extent = absolute(placed.pose.rotation) * placed.box.extent + placed.instance.padding +
                      placed.world_margin + placed.margin;

  addHalfSpaces(state, robot, center, extent);
  const uint node_count = max(2u * world_count, 1u) - 1u;
  uint at = 0u;
  for (uint steps = 0u; at < node_count && steps < INVOCATION_ITERATIONS / 2u; ++steps)
  {
    const uvec4 head = texelFetch(object_tree, int(OBJECT_NODE_TEXELS * at));
    const uvec4 tail = texelFetch(object_tree, int(OBJECT_NODE_TEXELS * at + 1u));
    const bool apart = any(greaterThan(abs(uintBitsToFloat(head.xyz) - center), uintBitsToFloat(tail.xyz) + extent));
    // The loop runs at most once. It stands for a branch: on llvmpipe, a branch costs all invocations time, but a loop
    // only those that enter it.
    for (bool leaf = !apart && tail.w != NO_OBJECT && isChecked(robot, tail.w); leaf; leaf = false)
      addCandidate(state, packPair(robot, robot_count + tail.w));
    at = apart ? head.w : at + 1u;
  }
  // The tree was too large for one invocation. The overflow makes the host split the batch, and a single state that
  // still overflows becomes undecided. So no object is lost.
  if (at < node_count)
    atomicOr(counters[COUNTER_OVERFLOW], 1u);
}
