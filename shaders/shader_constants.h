#pragma once
// Constants and layouts that the shaders and the C++ code share. Read by both: preprocessor lines and comments only.

// Lanes of a workgroup, but for the work queues.
#define GROUP_SIZE 64

// --- Uniforms -----------------------------------------------------------------------------------------------------------
// Where each of them is set; no two have the same place.
#define LOCATION_STATE_COUNT 0
#define LOCATION_ROBOT_COUNT 1
#define LOCATION_WORLD_COUNT 2
#define LOCATION_HALF_SPACE_COUNT 3
#define LOCATION_HALF_SPACE 4
#define LOCATION_CANDIDATE_CAPACITY 5
#define LOCATION_ROOT_PAIR_CAPACITY 6
#define LOCATION_SOLID_NODES 7
#define LOCATION_FIRST_QUERY 8
#define LOCATION_QUERY_COUNT 9
#define LOCATION_MARGIN_COUNT 10
#define LOCATION_IN_COUNTER 11
#define LOCATION_OUT_COUNTER 12
#define LOCATION_ENTRY_CAPACITY 13
#define LOCATION_LEAF_PAIR_CAPACITY 14
#define LOCATION_IN_CAPACITY 15
#define LOCATION_IS_LAST 16
#define LOCATION_TOLERANCE 17
#define LOCATION_SERIAL 18
#define LOCATION_COUNTER 19
#define LOCATION_CAPACITY 20
#define LOCATION_LANES 21
#define LOCATION_ARGUMENT_OFFSET 22
#define LOCATION_CLEARED 23
#define LOCATION_TRIANGLE_COUNT 24
#define LOCATION_PRIMITIVE_COUNT 25
#define LOCATION_MESH_COUNT 26
#define LOCATION_ROUND_INDEX 27
#define LOCATION_KEY_COUNT 28
#define LOCATION_SHIFT 29
#define LOCATION_BY_MESH 30
#define LOCATION_VALUE_COUNT 31
#define LOCATION_ROOT_BASE 32
#define LOCATION_LEAF_SIZE 33
#define LOCATION_PRIMITIVE_BASE 34
#define LOCATION_FIRST_TRIANGLE 35
#define LOCATION_FIRST_NODE 36
#define LOCATION_NODE_COUNT 37
#define LOCATION_FIRST_LISTED 38
#define LOCATION_LISTED_COUNT 39
#define LOCATION_CASE_COUNT 40

// --- Building trees ---------------------------------------------------------------------------------------------------
// A tree's leaf holds at most this many triangles.
#define LEAF_TRIANGLES 4
// A leaf in one word: its first triangle below this bit, its number of triangles less one above.
#define LEAF_COUNT_SHIFT 30
// A primitive that is tested as a solid has a tree of one leaf, with this bit for a triangle, and its instance.
#define SOLID_LEAF (1u << 29)
// What testing a triangle costs in a traversal, a node's box being 1 (surface area heuristic).
#define TRIANGLE_COST 0.4
// Oriented boxes: nodes of up to this many triangles are fitted by one lane, of more by a workgroup, of even more not at all.
#define FIT_LANE_TRIANGLES 128
#define FIT_MOST_TRIANGLES 65536
// Elements that one lane of the sort and of the compaction handles in sequence.
#define CHUNK 32
#define RADIX_BITS 4
#define RADIX_SIZE 16
#define MORTON_BITS 30
// Clusters look for their nearest neighbour this far to both sides.
#define SEARCH_RADIUS 12
// Merge rounds by nearest neighbour, then rounds that merge neighbours regardless, so that the depth is bounded.
#define NEAREST_ROUNDS 40
#define FORCED_ROUNDS 44
#define BUILD_ROUNDS (NEAREST_ROUNDS + FORCED_ROUNDS)
// One record of the build's round list, in uints.
#define ROUND_STRIDE 12
#define ROUND_CLUSTER_GROUPS 0   // indirect arguments: a lane per cluster
#define ROUND_CLUSTERS 3         // how many clusters the round begins with
#define ROUND_CHUNK_GROUPS 4     // indirect arguments: a lane per CHUNK clusters
#define ROUND_FIRST_PAIR 7       // pairs of children made before this round
#define ROUND_PAIR_GROUPS 8      // indirect arguments: a lane per pair that the round made
#define ROUND_PAIRS 11           // how many pairs the round made

// --- Checking batches of states -----------------------------------------------------------------------------------------
// Buffer textures.
#define UNIT_NODES 0
#define UNIT_TRIANGLES 1
#define UNIT_ROBOT_POSES 2
#define UNIT_WORLD_POSES 3
#define UNIT_ROOT_PAIRS 4
#define UNIT_ENTRIES 5
#define UNIT_LEAF_PAIRS 6
#define UNIT_CANDIDATES 7
#define UNIT_INSTANCES 8     // three texels an instance, see instances.glsl; robot's first, then the world's
#define UNIT_OBJECT_TREE 9   // two texels a node, see check_world_broad.comp
#define UNIT_WORLD_PAIRS 10  // bits [robot][world], 128 a texel
#define UNIT_QUERIES 11     // see searches.glsl
#define UNIT_SPHERES 12      // [robot][state]
#define UNIT_STATES 13       // these two: see kinematics.glsl
#define UNIT_LINK_SHAPES 14
#define UNIT_ORIENTED_NODES 15
#define UNIT_MARGINS 16      // see margins.glsl
// Storage buffers.
#define BINDING_COUNTERS 0
#define BINDING_FLAGS 1       // one uint a state: STATE_* bits
#define BINDING_HITS 2        // one uint a state: the pair that was hit
#define BINDING_A 3           // these differ from kernel to kernel
#define BINDING_B 4
#define BINDING_C 5
#define BINDING_D 6

// What float32 is trusted with, see docs/error_bounds.md. The relative error of one operation in any rounding mode; the
// distance within which the contract leaves the answer to one canonical computation on the CPU (1e-9 m) and some.
#define UNIT_ROUNDOFF 1.1920929e-7
#define CONTRACT_BAND 1.1e-9

// 0 on a device whose arithmetic is not as assumed: then no triangle test proves anything.
#ifndef FLOATS_DECIDE
#define FLOATS_DECIDE 1
#endif

// 1 in the programs that traverse pairs of a mesh and a solid, 0 in those for pairs of meshes.
#ifndef SOLIDS
#define SOLIDS 0
#endif

// 1 in the programs that may stop early, see tolerance.glsl.
#ifndef TOLERANT
#define TOLERANT 0
#endif

// 1 in the programs for batches with margins, see margins.glsl.
#ifndef MARGINS
#define MARGINS 0
#endif

// 1 in the programs that test triangles for a required distance.
#ifndef PADDED
#define PADDED 0
#endif

// The bits of float32's infinity: those of NaN are larger.
#define INFINITY_BITS 0x7f800000u

#define STATE_HIT 1u
#define STATE_UNDECIDED 2u

// What an instance's shape is: a mesh without closed components is a surface, the others are solids.
#define SOLID_NONE 0u
#define SOLID_BOX 1u
#define SOLID_SPHERE 2u
#define SOLID_CYLINDER 3u
#define SOLID_CONE 4u
#define SOLID_MESH 5u
// Steps in which a triangle and a solid look for the place where they are nearest.
#define SOLID_ITERATIONS 16u
// A mesh of more connected components than this is not looked into for containment on the GPU.
#define MAX_COMPONENTS 1024

// A pair of instances in one uint: a robot instance, and a robot instance or (robot count + a world instance).
#define PAIR_OTHER_BITS 20
#define MAX_ROBOT_INSTANCES (1 << 12)
#define MAX_INSTANCES (1 << PAIR_OTHER_BITS)

// Lanes that one dispatch of a part may have: indices of lanes and texels are products in 32 bits, which must not wrap.
#define MOST_LANES (1 << 30)

// How many others one search of the broad phase compares a robot instance with, 16 bits each, and none.
#define QUERY_PARTNERS 6
#define NO_PARTNER 0xffffu
// A node of the tree over objects that is not a leaf.
#define NO_OBJECT 0xffffffffu

// A root pair's texels, see root pairs.glsl.
#define ROOT_PAIR_TEXELS 5

// Counters, in uints. Each list has a count and, before each dispatch over it, indirect arguments.
#define COUNTER_CANDIDATES 0
#define COUNTER_ROOT_PAIRS 1
#define COUNTER_NEXT_ENTRY 2      // work queues: the next entry that nobody has taken
#define COUNTER_OVERFLOW 3        // not 0: a list was too short or work was left, the batch has to be split
#define COUNTER_ENTRIES_EVEN 4    // node pairs; the two lists take turns
#define COUNTER_ENTRIES_ODD 5
#define COUNTER_LEAF_PAIRS 6
#define COUNTER_LANES_ENDED 7     // work queues: lanes that came to their end, and that were started
#define COUNTER_LANES_STARTED 8
#define COUNTER_MESH_ENTRIES 9    // root pairs whose shapes are both made of triangles, and those with a solid
#define COUNTER_SOLID_ENTRIES 10
#define COUNTER_SCRATCH 11       // may be cleared
#define COUNTER_DONE 15          // the part's serial number, when all of its work is done
#define COUNTER_ARGUMENTS 12      // three uints
#define COUNTER_LEAF_ARGUMENTS 16
#define COUNTER_CHUNK_ARGUMENTS 20
#define COUNTER_PASS_ENTRIES 23   // work queues: how many entries the pass has
#define COUNTER_WORDS 24

// Breadth-first traversal: node pairs that one lane handles in sequence.
#define LEVEL_CHUNK 8
// Leaf pairs whose triangles a workgroup spreads over its lanes at once.
#define LEAF_CHUNK 64
// Work queues: lanes of a workgroup, its most workgroups, steps between two barriers, node pairs that a lane's stack
// holds, leaf pairs at which the group turns to triangles.
#define QUEUE_LANES 32
#define QUEUE_MAX_GROUPS 2048
#define QUEUE_STEPS 8
#define QUEUE_STACK 48
#define QUEUE_FLUSH 32
// llvmpipe ends an invocation silently after 65535 loop iterations; a lane hands its work on before that.
#define LANE_ITERATIONS 50000
