#pragma once
// Constants and buffer layouts that the shaders and the C++ code share. Both read this file, so it holds only
// preprocessor lines and comments.

// Invocations of a work group. Work groups of the work queues have QUEUE_INVOCATIONS instead.
#define GROUP_SIZE 64
// Work groups that OpenGL lets a dispatch have along x.
#define MAX_GROUPS 65535
// Invocations of the one work group that computes prefix sums (common/prefix_sum.glsl).
#define SCAN_INVOCATIONS 256

// --- Uniforms ------------------------------------------------------------------------------------------------------
// The location of each uniform. No two of these uniforms share a location.
#define LOCATION_STATE_COUNT 0
#define LOCATION_ROBOT_COUNT 1
#define LOCATION_WORLD_COUNT 2
#define LOCATION_HALF_SPACE_COUNT 3
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
#define LOCATION_SERIAL 18
#define LOCATION_COUNTER 19
#define LOCATION_CAPACITY 20
#define LOCATION_INVOCATIONS 21
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
#define LOCATION_TO_CLIP_SPACE 41
#define LOCATION_PULL 42
#define LOCATION_EYE 43
#define LOCATION_LAMP 44
#define LOCATION_TO_LAMP 45
#define LOCATION_SOFTNESS 46
#define LOCATION_LIFT 47
#define LOCATION_GROUND 48
#define LOCATION_BACKGROUND 49
#define LOCATION_FLAT_COLOR 50
#define LOCATION_OPEN_PAIR_CAPACITY 51
#define LOCATION_LISTED 53
#define LOCATION_IN_LIST 54
#define LOCATION_OUT_LIST 55
#define LOCATION_PASS 56
#define LOCATION_HAS_QUEUES 57

// --- Sizes of records ----------------------------------------------------------------------------------------------
// A texel has 16 bytes: one element of a buffer texture, or one vec4 or uvec4 of a storage buffer.
#define TEXEL_WORDS 4  // words of 32 bits
#define POSE_TEXELS 3  // three rows of [rotation | translation], see geometry/pose.glsl
#define POSE_FLOATS 12
#define NODE_TEXELS 2           // see problem/nodes.glsl
#define ORIENTED_NODE_TEXELS 3  // see traversal/bounding_volume_overlap.glsl
#define TRIANGLE_TEXELS 3       // one for each corner, see problem/triangles.glsl
#define TRIANGLE_FLOATS 9       // three for each corner, in the input of the tree build
#define INSTANCE_TEXELS 3       // see problem/instances.glsl
#define ROOT_PAIR_TEXELS 5      // see traversal/root_pairs.glsl
#define OBJECT_NODE_TEXELS 2    // see broad_phase/world_pairs.comp
#define HALF_SPACE_TEXELS 2     // see broad_phase/half_spaces.comp
#define LINK_SHAPES_HEADER 2    // texels before the links, see problem/kinematics.glsl
#define LINK_SHAPE_TEXELS 7     // of one shape of a link, see problem/kinematics.glsl
#define CLUSTER_TEXELS 2        // see tree_build/cluster.glsl
#define PAIR_TEXELS 4           // the two clusters that the tree build has merged
#define LARGE_NODE_TEXELS 1     // see tree_build/fit_boxes.comp
#define BOUNDS_WORDS 6          // the bounds of a mesh, see tree_build/bounds.comp
#define OUTCOME_TEXELS 2        // of one case of self_test/float_arithmetic.comp
// Records of the proofs, see proofs/records.glsl.
#define SELF_PAIR_TEXELS 2
#define WORLD_GROUP_TEXELS 2
#define OBJECT_TEXELS 4
#define INSTANCE_AXES 1        // first texel of the three axes of the box of an instance
#define INSTANCE_BOX_CENTER 4  // texel of the centre of this box
#define INSTANCE_BALLS 5       // first texel of the outer balls
#define INSTANCE_RADII (INSTANCE_BALLS + COVER_BALLS)
#define INSTANCE_WITNESSES (INSTANCE_RADII + COVER_BALLS / TEXEL_WORDS)
#define INSTANCE_RECORD_TEXELS (INSTANCE_WITNESSES + COVER_BALLS)
#define BOX_STEPS 32767.0  // of a half length, see records.glsl
#define RECORDS_HEADER 4   // texels before the records

// --- Building trees ------------------------------------------------------------------------------------------------
// A leaf of a tree holds at most this many triangles.
#define LEAF_TRIANGLES 4
// A leaf is packed into one word. The bits below this one hold its first triangle, the bits from this one on hold its
// number of triangles minus 1.
#define LEAF_COUNT_SHIFT 30
// A primitive that is tested as a solid has a tree of one leaf. The first triangle of that leaf is this bit combined
// with the index of the primitive's instance.
#define SOLID_LEAF (1u << 29)
// Cost of testing one triangle in a traversal, relative to the cost of testing one box (surface area heuristic).
#define TRIANGLE_COST 0.4
// Oriented boxes: one invocation fits a node of up to FIT_INVOCATION_TRIANGLES triangles, a work group fits a node of
// up to FIT_MAX_TRIANGLES. A larger node keeps its axis-aligned box.
#define FIT_INVOCATION_TRIANGLES 128
#define FIT_MAX_TRIANGLES 65536
// Number of elements that one invocation of the sort and of the compaction handles in sequence.
#define CHUNK 32
#define RADIX_BITS 4
#define RADIX_SIZE 16
#define MORTON_BITS 30
// A cluster looks for its nearest neighbour among this many clusters before it and as many after it.
#define SEARCH_RADIUS 12
// The first rounds merge clusters that are nearest neighbours. The forced rounds then merge adjacent clusters whatever
// their boxes, so that the depth of the trees is bounded.
#define NEAREST_ROUNDS 40
#define FORCED_ROUNDS 44
#define BUILD_ROUNDS (NEAREST_ROUNDS + FORCED_ROUNDS)
// Size of one record of the build's list of rounds, in uints, and the places of its fields.
#define ROUND_STRIDE 12
#define ROUND_CLUSTER_GROUPS 0  // indirect arguments: one invocation per cluster
#define ROUND_CLUSTERS 3        // number of clusters at the beginning of the round
#define ROUND_CHUNK_GROUPS 4    // indirect arguments: one invocation per CHUNK clusters
#define ROUND_FIRST_PAIR 7      // number of pairs of children made before this round
#define ROUND_PAIR_GROUPS 8     // indirect arguments: one invocation per pair that the round made
#define ROUND_PAIRS 11          // number of pairs that the round made

// Bindings of the storage buffers of the tree build. OpenGL grants a shader eight of them, so buffers that no shader
// binds together share a number. Keys, clusters and their information are read from one buffer (IN) and written to
// another one (OUT).
#define BINDING_VERTICES 0
#define BINDING_MESH_OF 1  // the mesh of each primitive
#define BINDING_BOXES 2
#define BINDING_BOUNDS 5
#define BINDING_KEYS_IN 0
#define BINDING_KEYS_OUT 3
#define BINDING_COUNTS 4
#define BINDING_CLUSTERS_IN 0
#define BINDING_CLUSTER_INFO_IN 1
#define BINDING_ROUNDS 2
#define BINDING_NEAREST 3
#define BINDING_SUMS 4
#define BINDING_CLUSTERS_OUT 5
#define BINDING_CLUSTER_INFO_OUT 6
#define BINDING_PAIRS 7
#define BINDING_CLUSTERS_EVEN 0
#define BINDING_CLUSTERS_ODD 1
#define BINDING_FIRST_PRIMITIVE 3
#define BINDING_PAIR_STARTS 4
#define BINDING_NODES 5
#define BINDING_LEAF_ORDER 6
#define BINDING_TRIANGLES 1
#define BINDING_ORIENTED_NODES 0
#define BINDING_LARGE_NODES 1
#define BINDING_LARGE_COUNT 2
#define UNIT_CLUSTERS 0  // unit of the buffer texture of the clusters of BINDING_CLUSTERS_IN

// --- Drawing -------------------------------------------------------------------------------------------------------
#define UNIT_SHADOW_MAP 0  // unit of the shadow map's texture
// Locations of the attributes of a vertex.
#define ATTRIBUTE_POSITION 0
#define ATTRIBUTE_NORMAL 1
#define ATTRIBUTE_COLOR 2

// --- Checking batches of states ------------------------------------------------------------------------------------
// Units of the buffer textures.
#define UNIT_NODES 0
#define UNIT_TRIANGLES 1
#define UNIT_ROBOT_POSES 2
#define UNIT_WORLD_POSES 3
#define UNIT_ROOT_PAIRS 4
#define UNIT_ENTRIES 5
#define UNIT_LEAF_PAIRS 6
#define UNIT_CANDIDATES 7
#define UNIT_INSTANCES 8     // the robot's first, then the world's
#define UNIT_OBJECT_TREE 9   // see broad_phase/world_pairs.comp
#define UNIT_WORLD_PAIRS 10  // bits [robot][world], 128 a texel
#define UNIT_QUERIES 11      // see broad_phase/queries.glsl
#define UNIT_SPHERES 12      // [robot][state]
#define UNIT_STATES 13       // see problem/states.glsl
#define UNIT_LINK_SHAPES 14
#define UNIT_ORIENTED_NODES 15
#define UNIT_MARGINS 16  // see problem/margins.glsl
#define UNIT_PROOFS 17   // see proofs/records.glsl
#define UNIT_FRAMES 18   // [row][state], see proofs/state_proofs.glsl
// Bindings of the storage buffers.
#define BINDING_COUNTERS 0
#define BINDING_VERDICTS 1  // one uint a state, see traversal/verdicts.glsl
#define BINDING_OPEN_STATES 2
#define BINDING_A 3  // BINDING_A to BINDING_D differ from shader to shader
#define BINDING_B 4
#define BINDING_C 5
#define BINDING_D 6

// Limits of float32, derived in docs/error_bounds.md. UNIT_ROUNDOFF bounds the relative error of one operation in every
// rounding mode (2^-23). CONTRACT_BAND (metres) is slightly more than the 1e-9 m within which the contract leaves the
// verdict to one canonical computation on the CPU.
#define UNIT_ROUNDOFF 1.1920929e-7
#define CONTRACT_BAND 1.1e-9

// 0 on a device whose float32 arithmetic failed the self-test. Tests of triangles then prove nothing.
#ifndef FLOAT32_TRUSTED
#define FLOAT32_TRUSTED 1
#endif

// 1 in the programs that traverse pairs of a mesh and a solid, 0 in the programs that traverse pairs of meshes.
#ifndef SOLIDS
#define SOLIDS 0
#endif

// 1 in the programs for batches with margins, see problem/margins.glsl.
#ifndef MARGINS
#define MARGINS 0
#endif

// 1 in the programs for two meshes with a required distance: they also compare the distances of nodes and triangles
// with it.
#ifndef PADDED
#define PADDED 0
#endif

// The bits of infinity in float32. As unsigned integers, the bits of every NaN are larger.
#define INFINITY_BITS 0x7f800000u

// Bits of the verdict of a pair in a state. Both may be set; the hit then counts.
#define STATE_HIT 1u
#define STATE_UNDECIDED 2u
// The verdict of a state is the packed pair that collides, or one of these words. No packed pair is one of them.
#define VERDICT_FREE 0u
#define VERDICT_OPEN 0xfffffffeu  // free, unless a pair that the proofs left open collides
#define VERDICT_UNDECIDED 0xffffffffu

// Kinds of the shape of an instance. SOLID_NONE is a mesh without a part that bounds a solid: it is a surface and has
// no inside. All other kinds are solids.
#define SOLID_NONE 0u
#define SOLID_BOX 1u
#define SOLID_SPHERE 2u
#define SOLID_CYLINDER 3u
#define SOLID_CONE 4u
#define SOLID_MESH 5u
// Most steps of the search for the nearest points of a triangle and a solid (traversal/solid_leaf.glsl).
#define SOLID_ITERATIONS 16u
// The GPU tests a mesh for containment only if it has at most this many connected components. Otherwise the state
// becomes undecided.
#define MAX_COMPONENTS 1024
// Roles of the triangles of a mesh (TriangleRole in gpu_planning_scene/solids.h), in ROLE_BITS bits.
#define ROLE_SURFACE 0u
#define ROLE_WINDING 1u
#define ROLE_PARITY 2u
#define ROLE_BITS 2u
#define ROLES_PER_WORD 16u

// A pair of instances is packed into one uint. The upper bits hold a robot instance. The lower PAIR_OTHER_BITS bits
// hold the other instance: first come the robot instances, then the world instances, then the half-spaces.
#define PAIR_OTHER_BITS 20
#define MAX_ROBOT_INSTANCES (1 << 12)
#define MAX_INSTANCES ((1 << PAIR_OTHER_BITS) - 2)

// Most invocations that one dispatch of a part may have, so that the indices of invocations and texels do not overflow
// 32 bits.
#define MAX_INVOCATIONS (1 << 30)

// One query of the broad phase among links compares a robot instance with up to this many others, 16 bits each.
// NO_PARTNER marks an unused place.
#define QUERY_PARTNERS 6
#define NO_PARTNER 0xffffu
// Marks an inner node in the tree over the world's objects.
#define NO_OBJECT 0xffffffffu

// Balls of the covers on the device (proofs/covers.glsl): a coarse level, then a fine one.
#define COVER_COARSE_BALLS 8
#define COVER_FINE_BALLS 32
#define COVER_BALLS (COVER_COARSE_BALLS + COVER_FINE_BALLS)
// Kinds of the objects of the proofs (lanes::ObjectKind).
#define OBJECT_BOX 0u
#define OBJECT_SPHERE 1u
#define OBJECT_CYLINDER 2u
#define OBJECT_CONE 3u
#define OBJECT_HALF_SPACE 4u
#define OBJECT_BOUNDING_BOX 5u
// A proof needs a length greater than this: the square of a smaller one may be 0.
#define LEAST_PROVEN_LENGTH 1e-18
// A quaternion with a smaller squared length is too short for float arithmetic.
#define LEAST_SQUARED_QUATERNION 1e-12
// The verdicts of a cell of a joint table, and the bits of a cell.
#define TABLE_APART 0u
#define TABLE_COLLIDING 1u
#define TABLE_NONE 2u
#define TABLE_CELL_BITS 2
#define TABLE_CELLS_A_WORD 16

// Places of the counters (uints).
#define COUNTER_OVERFLOW 0  // not 0: a list was too short or work remained, so the batch must be split
#define COUNTER_DONE 1      // the serial number of the part, once all its work is done
// Breadth-first traversal: lengths of lists, and indirect arguments of three uints each.
#define COUNTER_ENTRIES_EVEN 2  // node pairs: this list and the next one are read and written in turn
#define COUNTER_ENTRIES_ODD 3
#define COUNTER_LEAF_PAIRS 4
#define COUNTER_ARGUMENTS 6
#define COUNTER_LEAF_ARGUMENTS 9
#define COUNTER_CHUNK_ARGUMENTS 12
// Lists that count the work groups of a dispatch over them (common/lists.glsl).
#define LIST_OPEN_SELF_PAIRS 16
#define LIST_OPEN_WORLD_PAIRS 20
#define LIST_FINE_PAIRS 24
#define LIST_OPEN_STATES 28
#define LIST_CANDIDATES 32
#define LIST_ROOT_PAIRS 36
#define LIST_SOLID_ENTRIES 40  // root pairs with a solid
#define LIST_MESH_ENTRIES 44   // root pairs whose shapes are both made of triangles
#define LIST_SOLID_REST 48     // work queues: node pairs for the last pass
#define LIST_MESH_REST 52
#define LIST_WORDS 4
#define LIST_LENGTH 3  // place of the length of a list
// Work queues: the counters of each pass.
#define PASS_SOLIDS 56
#define PASS_MESHES 58
#define PASS_SOLID_REST 60
#define PASS_MESH_REST 62
#define PASS_NEXT_ENTRY 0  // the next entry that no invocation has taken
#define PASS_ENDED 1       // invocations that reached their end
#define COUNTER_WORDS 64

// Breadth-first traversal: number of node pairs that one invocation handles in sequence.
#define LEVEL_CHUNK 8
#define LEVEL_GROUP (LEVEL_CHUNK * GROUP_SIZE)  // of a work group
// Number of leaf pairs whose triangles a work group distributes over its invocations at once.
#define LEAF_CHUNK 64
// Work queues.
#define QUEUE_INVOCATIONS 32  // invocations of a work group
#define QUEUE_STEPS 8         // most steps of an invocation between two barriers
#define QUEUE_STACK 48        // node pairs and leaf pairs that the memory of an invocation holds
#define QUEUE_LAST_ROUNDS 16  // rounds of a work group after one of its invocations found the entry list empty
#define QUEUE_FLUSH 32        // number of leaf pairs from which on the work group tests their triangles
// llvmpipe ends an invocation without an error after 65535 loop iterations. An invocation stops before that, and hands
// its remaining work on.
#define INVOCATION_ITERATIONS 50000
