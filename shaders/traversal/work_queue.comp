// Traversal by work queues. Each invocation takes node pairs from the entry list and traverses them with a stack of its
// own. It adds leaf pairs to a list that the work group shares. As soon as that list holds QUEUE_FLUSH pairs, all
// invocations of the work group test its triangles. All invocations of a work group meet at the same barriers: the
// outer loop is uniform, and an invocation makes at most QUEUE_STEPS steps between two barriers.
//
// Node pairs go to the entry list of the next pass if the stack is full, if the iterations run out, or
// QUEUE_LAST_ROUNDS rounds after the first invocation of the work group found the entry list empty. So a long traversal
// does not keep one invocation busy while all others have ended: the next pass distributes its node pairs. What the
// last pass would hand on is an overflow. The sources are in src/collision/gpu/traversal/work_queue.cpp.
//
// On llvmpipe a branch skips nothing, so every store and atomic costs time in each step of each invocation. A step
// therefore has only one store: the memory of an invocation holds node pairs from below and leaf pairs from above. All
// other writes happen once a round.
#include "shader_constants.h"
layout(local_size_x = QUEUE_INVOCATIONS) in;
#include "common/comparisons.glsl"
#include "common/invocation.glsl"
#include "traversal/root_pairs.glsl"
#include "problem/nodes.glsl"
#include "geometry/error_bounds.glsl"
#include "problem/instances.glsl"
#include "traversal/bounding_volume_overlap.glsl"
#if SOLIDS
#include "traversal/solid_nodes.glsl"
#endif
#include "common/lists.glsl"
#include "traversal/verdicts.glsl"
// Room for all leaf pairs that the invocations can add before the work group tests triangles.
#define LEAF_QUEUE (QUEUE_FLUSH + QUEUE_INVOCATIONS * QUEUE_STEPS)
#include "traversal/leaf_queue.glsl"
#if PADDED
#include "traversal/close_enough.glsl"
#endif
layout(location = LOCATION_IN_LIST) uniform uint in_list;
layout(location = LOCATION_OUT_LIST) uniform uint out_list;
layout(location = LOCATION_PASS) uniform uint pass_counters;  // the first counter of this pass
layout(location = LOCATION_ENTRY_CAPACITY) uniform uint entry_capacity;
layout(location = LOCATION_IN_CAPACITY) uniform uint in_capacity;  // of the list that is read
layout(location = LOCATION_IS_LAST) uniform uint is_last;          // 1: no further pass follows
layout(binding = UNIT_ENTRIES) uniform usamplerBuffer entries;
layout(std430, binding = BINDING_A) writeonly buffer Spill { uvec4 spilled[]; };

// Loop iterations of one step, if the compiler does not unroll the inner loops. If a step has more, the device may end
// invocations early. The count of invocations below detects this.
#define STEP_ITERATIONS 4u

shared uint busy;
shared uint list_ended;  // 1: an invocation has found the entry list empty

// Hands a node pair on to the next pass. If the list is full, the state becomes undecided, so that no collision is
// missed.
void spill(uint root_pair, uvec2 nodes, uint state)
{
  if (is_last != 0u)
    atomicOr(counters[COUNTER_OVERFLOW], 1u);
  const uint at = newEntries(out_list, 1u, entry_capacity, QUEUE_INVOCATIONS);
  if (at < entry_capacity)
    spilled[at] = uvec4(root_pair, nodes, 0u);
  else
    reportUndecided(state);
}

void main()
{
  const uint entry_count = lengthOf(in_list, in_capacity);
  uvec2 memory[QUEUE_STACK];
  uint waiting = 0u;   // number of node pairs in `memory`, from below
  uint leaves = 0u;    // number of leaf pairs in `memory`, from above
  uvec2 nodes = uvec2(0u);
  bool walking = false;    // true: `nodes` is a pair to be tested
  bool exhausted = false;  // true: the entry list is empty
  uint root_pair_index = 0u;
  RootPair root_pair;
  root_pair.state = 0u;
#if SOLIDS
  Instance instance_a = fetchInstance(0u);
  Instance instance_b = instance_a;
#endif
  if (gl_LocalInvocationID.x == 0u)
  {
    leaf_pair_count = 0u;
    busy = 0u;
    list_ended = 0u;
  }
  barrier();

  uint iterations = 0u;
  uint last_rounds = 0u;  // rounds since an invocation of this work group found the entry list empty
  bool running = true;
  while (running)
  {
    if (isDecided(root_pair.state))
    {
      walking = false;
      waiting = 0u;
    }
    if (!walking && !exhausted)
    {
      const uint at = atomicAdd(counters[pass_counters + PASS_NEXT_ENTRY], 1u);
      exhausted = at >= entry_count;
      walking = !exhausted;
      const uvec4 entry = texelFetch(entries, int(min(at, entry_count - 1u)));
      root_pair_index = entry.x;
      root_pair = fetchRootPair(root_pair_index);
      nodes = entry.yz;
#if SOLIDS
      instance_a = fetchInstance(pairOther(root_pair.pair));
      instance_b = fetchInstance(pairRobot(root_pair.pair));
#endif
    }
    bool inside = false;
    for (uint step = 0u; step < QUEUE_STEPS && walking && !inside && waiting + leaves < QUEUE_STACK; ++step)
    {
      const OrientedNode a = fetchOrientedNode(nodes.x);
      const OrientedNode b = fetchOrientedNode(nodes.y);
      bool overlap = !nodesApart(a, b, root_pair.pose, root_pair.gap, root_pair.error);
#if SOLIDS
      overlap = overlap && !nodeBeyondSolid(a, b, instance_a, instance_b, root_pair);
      inside = nodeInCore(a, b, instance_a.core, instance_b.core, root_pair.pose, boxError(root_pair.error));
#endif
#if PADDED
      inside = inside || isCloseEnough(root_pair_index, root_pair, a, b);
#endif
      const bool leaf = a.count != 0u && b.count != 0u;
      const bool into_a = descendsIntoA(a, b);
      const uvec2 first = into_a ? uvec2(a.first, nodes.y) : uvec2(nodes.x, b.first);
      const uvec2 second = into_a ? uvec2(a.first + 1u, nodes.y) : uvec2(nodes.x, b.first + 1u);
      const uvec2 leaf_pair = uvec2(leafReference(a.first, a.count), leafReference(b.first, b.count));
      // The pair is always stored, and counted only if the nodes overlap. A condition would be a branch for each
      // invocation.
      memory[leaf ? QUEUE_STACK - 1u - leaves : waiting] = leaf ? leaf_pair : second;
      leaves += overlap && leaf ? 1u : 0u;
      waiting += overlap && !leaf ? 1u : 0u;
      if (overlap && !leaf)
      {
        nodes = first;
      }
      else
      {
        walking = waiting > 0u;
        waiting -= walking ? 1u : 0u;
        nodes = memory[waiting];
      }
    }
    if (inside)
    {
      report(root_pair.state, root_pair.pair, STATE_HIT);
      walking = false;
      waiting = 0u;
    }
    // Node pairs alone fill the memory. The current pair goes to the next pass.
    if (walking && waiting >= QUEUE_STACK)
    {
      spill(root_pair_index, nodes, root_pair.state);
      --waiting;
      nodes = memory[waiting];
    }
    uint at = atomicAdd(leaf_pair_count, leaves);
    for (; leaves > 0u; --leaves)
      leaf_pairs[at++] = uvec4(root_pair_index, memory[QUEUE_STACK - leaves], 0u);
    if (walking || !exhausted)
      busy = 1u;
    if (exhausted)
      list_ended = 1u;
    barrier();
    const uint count = leaf_pair_count;
    const bool more = busy != 0u;
    last_rounds += list_ended;
    barrier();
    const bool flush = count >= QUEUE_FLUSH || !more;
    if (gl_LocalInvocationID.x == 0u)
    {
      busy = 0u;
      if (flush)
        leaf_pair_count = 0u;
    }
    iterations += 1u + (STEP_ITERATIONS + 2u) * QUEUE_STEPS + testLeafPairs(flush ? count : 0u);
    running = more && iterations < INVOCATION_ITERATIONS && (is_last != 0u || last_rounds < QUEUE_LAST_ROUNDS);
    barrier();
  }

  // What is left goes to the next pass.
  testLeafPairs(leaf_pair_count);
  if (walking)
    spill(root_pair_index, nodes, root_pair.state);
  for (; waiting > 0u; --waiting)
    spill(root_pair_index, memory[waiting - 1u], root_pair.state);
  // This count reveals a device that ends invocations early.
  atomicAdd(counters[pass_counters + PASS_ENDED], 1u);
}
