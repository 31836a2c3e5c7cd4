// The proofs of a state, one invocation each: joint tables and enclosing balls decide most pairs, as in the lane kernel
// (src/collision/cpu/lanes/lane_kernel_body.h). Tables also prove collisions; enclosing balls only prove pairs apart
// here. A state without a hit and without open pairs is free. Pairs without a proof go to the lists of open pairs. This
// file has what the generated part of the shader uses (src/collision/gpu/proofs/state_shader.cpp); state_main.glsl
// follows it. Lengths are in metres.
//
// The loops that run at most once stand for branches: on llvmpipe, a branch costs all invocations time, but a loop only
// those that enter it.
#include "common/comparisons.glsl"
#include "geometry/pose.glsl"
#include "problem/instance_lists.glsl"
#include "problem/margins.glsl"
#include "problem/states.glsl"
#include "traversal/verdicts.glsl"
#include "proofs/records.glsl"
#include "proofs/open_pairs.glsl"
#include "proofs/joint_kinematics.glsl"

// The rows of the frames: [row][state]. The tests of open pairs read them.
layout(std430, binding = BINDING_A) writeonly buffer Frames { vec4 placed_frames[]; };

// Margins and attached objects need the centres as an array. ATTACHED: there are attached objects; CENTERS: its length.
#define CENTER_ARRAY (MARGINS || ATTACHED)

// Writes a frame for the tests of open pairs.
void writeFrame(uint state, uint number, vec4 x, vec4 y, vec4 z)
{
  placed_frames[(3u * number) * state_count + state] = x;
  placed_frames[(3u * number + 1u) * state_count + state] = y;
  placed_frames[(3u * number + 2u) * state_count + state] = z;
}

#if CENTER_ARRAY
// Places the centres of attached objects that move with a frame.
void placeAttached(Records records, uint frame, vec4 x, vec4 y, vec4 z, inout vec3 centers[CENTERS])
{
  const uvec4 range = proofWords(records.frames + frame);
  for (uint c = range.x; c < range.y; ++c)
  {
    const uvec4 center = proofWords(records.centers + c);
    centers[min(center.w, CENTERS - 1u)] = placedBy(x, y, z, uintBitsToFloat(center.xyz));
  }
}
#endif

// TABLE_APART, TABLE_COLLIDING or TABLE_NONE. `place`: of the state in the table, in cells.
uint lookUp(uint cells, dvec2 place, uvec2 counts)
{
  const bool inside = place.x >= 0.0lf && place.x < double(counts.x) && place.y >= 0.0lf && place.y < double(counts.y);
  const uint cell = inside ? uint(int(place.x)) * counts.y + uint(int(place.y)) : 0u;
  const uint word = cell / TABLE_CELLS_A_WORD;
  const uint proofs = proofWords(cells + word / TEXEL_WORDS)[word % TEXEL_WORDS];
  return inside ? proofs >> TABLE_CELL_BITS * (cell % TABLE_CELLS_A_WORD) & 3u : TABLE_NONE;
}

float squaredBetween(vec3 a, vec3 b)
{
  const vec3 between = vectorBetween(a, b);
  return dot(between, between);
}

// `to`: from the centre of a box.
float squaredDistanceFromBox(vec3 to, vec3 half_lengths)
{
  const vec3 beyond = max(abs(to) - half_lengths, vec3(0.0));
  return dot(beyond, beyond);
}

// Tests the pairs of an instance with the world. The box of a group contains the objects of several pairs, grown by
// their thresholds. If the enclosing ball is near this box, it is compared with the box of each object, whose ends are
// counted in steps of the half lengths of the group's box.
void proveWorldPairs(uint state, Records records, uint instance, vec3 center)
{
  const uvec4 head = proofWords(records.world_instances + instance);
  const float outer = uintBitsToFloat(head.z) + grownMargin(worldMargin(state, instance));
  for (uint g = head.x; g < head.y; ++g)
  {
    const uvec4 middle = proofWords(records.world_groups + WORLD_GROUP_TEXELS * g);
    const uvec4 size = proofWords(records.world_groups + WORLD_GROUP_TEXELS * g + 1u);
    const vec3 to_group = vectorBetween(uintBitsToFloat(middle.xyz), center);
    const vec3 half_lengths = uintBitsToFloat(size.xyz);
    const bool near = !isBeyond(squaredDistanceFromBox(to_group, half_lengths), outer);
    uint open = 0u;
    for (uint k = near ? middle.w : size.w; k < size.w; ++k)
    {
      const uvec3 box = proofWords(records.world_boxes + k).xyz;
      const vec3 low = vec3(box.x & 0xffffu, box.y & 0xffffu, box.z & 0xffffu) * (1.0 / BOX_STEPS) - 1.0;
      const vec3 high = vec3(box.x >> 16u, box.y >> 16u, box.z >> 16u) * (1.0 / BOX_STEPS) - 1.0;
      const vec3 beyond = max(max(low * half_lengths - to_group, to_group - high * half_lengths), vec3(0.0));
      open |= isBeyond(dot(beyond, beyond), outer) ? 0u : 1u << (k - middle.w);
    }
    addOpenWorldPairs(state, middle.w, open);
  }
}

#if CENTER_ARRAY
// The self pairs that the generated part does not test: those of attached objects, in groups that are near two centres,
// then each pair by its enclosing balls. With margins, this is all pairs, also those with tables.
void proveSelfPairs(uint state, Records records, vec3 centers[CENTERS])
{
  const uint groups = MARGINS != 0 ? records.all_self_group_count : records.self_group_count;
  for (uint g = 0u; g < groups; ++g)
  {
    const uvec4 group = proofWords(records.self_groups + g);
    const vec3 first = centers[min(group.x & 0xffffu, CENTERS - 1u)];
    const float apart = squaredBetween(first, centers[min(group.x >> 16u, CENTERS - 1u)]);
    const bool near = MARGINS != 0 || !isBeyond(apart, uintBitsToFloat(group.y));
    for (uint p = near ? group.z : group.w; p < group.w; ++p)
    {
      const uvec4 pair = proofWords(records.self_pairs + SELF_PAIR_TEXELS * p);
      const uint a = pairRobot(pair.x);
      const uint b = pairOther(pair.x);
      const float squared = squaredBetween(centers[min(a, CENTERS - 1u)], centers[min(b, CENTERS - 1u)]);
      const float reach = uintBitsToFloat(pair.y) + grownMargin(selfMargin(state, a, b));
      addOpenSelfPairs(state, p, isBeyond(squared, reach) ? 0u : 1u);
    }
  }
}

// The pairs of attached objects.
void proveAttached(uint state, Records records, vec3 centers[CENTERS])
{
  proveSelfPairs(state, records, centers);
  for (uint i = records.first_attached; i < robot_count; ++i)
    proveWorldPairs(state, records, i, centers[min(i, CENTERS - 1u)]);
}
#endif
