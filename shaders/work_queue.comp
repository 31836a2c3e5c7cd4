// Traversal by work queues. Every lane takes node pairs from the entry list and walks them with a stack of its own; pairs of
// leaves go to a list that the workgroup shares. When the list is full enough, all lanes turn to its triangles. All lanes
// of a group meet at the same barriers: the outer loop is uniform, and a lane does at most QUEUE_STEPS steps between
// two barriers. What does not fit a stack, or is left when the iterations run out, goes to the next entry list.
#include "interface.h"
layout(local_size_x = QUEUE_LANES) in;
#include "common.glsl"
#include "items.glsl"
#include "boxes.glsl"
#include "descend.glsl"
#include "counters.glsl"
#include "verdicts.glsl"
#include "leaf_pair.glsl"
layout(location = 0) uniform uint in_counter;   // COUNTER_ENTRIES_* of the list read, and of the one written
layout(location = 1) uniform uint out_counter;
layout(location = 2) uniform uint entry_capacity;
layout(binding = UNIT_ENTRIES) uniform usamplerBuffer entries;
layout(std430, binding = BINDING_OUT) writeonly buffer Spill { uvec4 spilled[]; };

// Loop iterations of one step and of one slot of a leaf pair, in case the compiler does not unroll the inner loops.
#define STEP_ITERATIONS 4u
#define SLOT_ITERATIONS 20u

shared uint leaf_pair_count;
shared uint busy_lanes;
shared uvec4 leaf_pairs[QUEUE_LEAF_PAIRS];  // item, a's first triangle, b's first triangle, counts (a low, b high)

// The state is undecided if the list is full: its answer is never lost.
void spill(uint item, uvec2 nodes, uint state)
{
  const uint at = atomicAdd(counters[out_counter], 1u);
  if (at < entry_capacity)
    spilled[at] = uvec4(item, nodes, 0u);
  else
    reportUndecided(state);
}

void testLeafPairs(uint count)
{
  const uint slots = count * LEAF_TRIANGLES;
  for (uint slot = gl_LocalInvocationID.x; slot < slots; slot += QUEUE_LANES)
  {
    const uvec4 pair = leaf_pairs[slot / LEAF_TRIANGLES];
    const uint triangle = slot % LEAF_TRIANGLES;
    if (triangle < (pair.w & 0xffffu))
      testTriangles(fetchItem(pair.x), pair.y + triangle, pair.z, pair.w >> 16u);
  }
}

void main()
{
  const uint entry_count = min(counters[in_counter], entry_capacity);
  uvec2 stack[QUEUE_STACK];
  int top = 0;
  bool exhausted = false;
  uint item_index = 0u;
  Item item;
  item.state = 0u;
  if (gl_LocalInvocationID.x == 0u)
  {
    leaf_pair_count = 0u;
    busy_lanes = 0u;
  }
  barrier();

  uint iterations = 0u;
  bool running = true;
  while (running)
  {
    if (top == 0 && !exhausted)
    {
      const uint at = atomicAdd(counters[COUNTER_NEXT_ENTRY], 1u);
      exhausted = at >= entry_count;
      const uvec4 entry = texelFetch(entries, int(min(at, entry_count - 1u)));
      item_index = entry.x;
      item = fetchItem(item_index);
      stack[0] = entry.yz;
      top = exhausted ? 0 : 1;
    }
    if (isDecided(item.state))
      top = 0;
    for (int step = 0; step < QUEUE_STEPS && top > 0; ++step)
    {
      --top;
      const uvec2 nodes = stack[top];
      const TreeNode a = fetchNode(nodes.x);
      const TreeNode b = fetchNode(nodes.y);
      if (!boxesApart(a.box, b.box, item.pose, item.slack + item.error))
      {
        if (a.count != 0u && b.count != 0u)
        {
          leaf_pairs[atomicAdd(leaf_pair_count, 1u)] = uvec4(item_index, a.first, b.first, a.count | (b.count << 16u));
        }
        else if (top + 2 > QUEUE_STACK)
        {
          spill(item_index, nodes, item.state);
        }
        else
        {
          const bool into_a = descendsIntoA(a, b);
          stack[top] = into_a ? uvec2(a.first, nodes.y) : uvec2(nodes.x, b.first);
          stack[top + 1] = into_a ? uvec2(a.first + 1u, nodes.y) : uvec2(nodes.x, b.first + 1u);
          top += 2;
        }
      }
    }
    if (top > 0 || !exhausted)
      atomicAdd(busy_lanes, 1u);
    barrier();
    const uint count = leaf_pair_count;
    const bool busy = busy_lanes > 0u;
    barrier();
    const bool flush = count >= QUEUE_FLUSH || !busy;
    if (gl_LocalInvocationID.x == 0u)
    {
      busy_lanes = 0u;
      if (flush)
        leaf_pair_count = 0u;
    }
    if (flush)
      testLeafPairs(count);
    iterations += 1u + STEP_ITERATIONS * QUEUE_STEPS + (flush ? SLOT_ITERATIONS * (1u + (count * LEAF_TRIANGLES) / QUEUE_LANES) : 0u);
    running = busy && iterations < QUEUE_ITERATIONS;
    barrier();
  }

  // Only after too many iterations: hand on what is left.
  testLeafPairs(leaf_pair_count);
  while (top > 0)
  {
    --top;
    spill(item_index, stack[top], item.state);
  }
  // A device that ends lanes early is found out by this count.
  atomicAdd(counters[COUNTER_LANES_ENDED], 1u);
}
