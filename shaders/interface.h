#pragma once
// Constants and layouts that the shaders and the C++ code share. Read by both: preprocessor lines and comments only.

// Lanes of a workgroup, but for the work queues.
#define GROUP_SIZE 64

// --- Building trees ---------------------------------------------------------------------------------------------------
// A tree's leaf holds at most this many triangles.
#define LEAF_TRIANGLES 4
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
