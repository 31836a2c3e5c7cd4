// The last step of the build, from the roots down: writes each node in its final form and gives each triangle its
// place. The triangles of a subtree are contiguous. A subtree of at most leaf_size triangles becomes a leaf, unless
// opening it is cheaper by the surface area heuristic (MacDonald and Booth 1990, see write.comp).
#include "tree_build/cluster.glsl"
layout(location = LOCATION_ROOT_BASE) uniform uint root_base;      // place of this forest's first root among the nodes
layout(location = LOCATION_LEAF_SIZE) uniform uint leaf_size;
layout(location = LOCATION_PRIMITIVE_BASE) uniform uint primitive_base;  // number of this forest's first triangle
// The first triangle below each pair.
layout(std430, binding = BINDING_PAIR_STARTS) buffer PairStarts { uint pair_starts[]; };
layout(std430, binding = BINDING_NODES) writeonly buffer Nodes { uvec4 nodes[]; };  // see problem/nodes.glsl
layout(std430, binding = BINDING_LEAF_ORDER) writeonly buffer LeafOrder { uint leaf_order[]; };

// Writes the subtree `c`, whose triangles begin at `start`, to node `at`. `first_pair_node`: the place of the first
// pair of children, after the roots.
void place(Cluster c, uint at, uint start, uint first_pair_node)
{
  const bool leaf = c.count == 1u || (c.count <= leaf_size && !c.opened);
  if (c.count == 1u)
    leaf_order[start] = primitive_base + c.reference;
  else
    pair_starts[c.reference] = start;
  precise const vec3 center = 0.5 * c.low + 0.5 * c.high;
  // Rounded outwards: the half extents cover both corners, whatever the rounding of the centre.
  precise const vec3 half_extent = max(c.high - center, center - c.low) * (1.0 + 4.0 * UNIT_ROUNDOFF) + 1e-37;
  nodes[NODE_TEXELS * at] = uvec4(floatBitsToUint(center), leaf ? start : first_pair_node + 2u * c.reference);
  nodes[NODE_TEXELS * at + 1u] = uvec4(floatBitsToUint(half_extent), leaf ? c.count : 0u);
}
