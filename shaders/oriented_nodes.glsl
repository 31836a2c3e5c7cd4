// Nodes with their oriented boxes (OBB), which traversals of pairs test: three texels a node, in the order of the nodes.
#include "quaternion.glsl"

struct OrientedNode
{
  Box box;     // in its own frame but for the centre, which is in the tree's
  mat3 axes;   // of the box, in the tree's frame
  uint first;  // as TreeNode has them
  uint count;
};

layout(binding = UNIT_ORIENTED_NODES) uniform usamplerBuffer oriented_texels;

OrientedNode fetchOrientedNode(uint index)
{
  const uvec4 a = texelFetch(oriented_texels, int(3u * index));
  const uvec4 b = texelFetch(oriented_texels, int(3u * index + 1u));
  const vec4 q = uintBitsToFloat(texelFetch(oriented_texels, int(3u * index + 2u)));
  return OrientedNode(Box(uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz)), rotationOf(q), a.w, b.w);
}

// What a test of two boxes may be off by, relative to their half edge lengths.
float sizeError(Box a, Box b)
{
  return 512.0 * u * dot(a.extent + b.extent, vec3(1.0));
}

// Whether node b, whose tree is placed by `pose` in a's tree's frame, is apart from node a by more than `margin`, or nothing.
bool nodesApart(OrientedNode a, OrientedNode b, Pose pose, float margin)
{
  const vec3 between = (apply(pose, b.box.center) - a.box.center) * a.axes;
  const mat3 turned = transpose(a.axes) * (pose.rotation * b.axes);
  return boxGap(a.box.extent, b.box.extent, between, turned) > margin + sizeError(a.box, b.box);
}

// Whether a node's box lies within the core of the other tree's solid by more than `margin`: then what it holds is inside.
// A core that is not there has negative extents, and nothing lies within it.
bool nodeInCore(OrientedNode a, OrientedNode b, vec3 core_a, vec3 core_b, Pose pose, float margin)
{
  const mat3 b_axes = pose.rotation * b.axes;
  const mat3 a_axes = transpose(pose.rotation) * a.axes;
  const float off = margin + sizeError(a.box, b.box);
  const vec3 b_in_a = abs(apply(pose, b.box.center)) + absolute(b_axes) * b.box.extent + off;
  const vec3 a_in_b = abs((a.box.center - pose.translation) * pose.rotation) + absolute(a_axes) * a.box.extent + off;
  return all(lessThan(b_in_a, core_a)) || all(lessThan(a_in_b, core_b));
}

// Which of two overlapping nodes is taken apart: an inner node beats a leaf, of two inner nodes the larger one goes.
bool descendsIntoA(OrientedNode a, OrientedNode b)
{
  return a.count == 0u && (b.count != 0u || dot(a.box.extent, a.box.extent) >= dot(b.box.extent, b.box.extent));
}

// A leaf in one word: its first triangle, and how many less one.
uint leafReference(OrientedNode leaf)
{
  return leaf.first | ((leaf.count - 1u) << LEAF_COUNT_SHIFT);
}
