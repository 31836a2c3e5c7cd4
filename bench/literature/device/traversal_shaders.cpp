#include "literature/device/traversal_shaders.h"

// An entry of a list is a pose and two nodes. A node is four uvec4: centre and child, half size and triangle, and two
// of the three axes of the box. Marks: 0 apart, 1 the boxes overlap, 2 the triangles overlap.
namespace gpu_planning_scene::core::literature
{
const char* const kTraversalDeclarations = R"(
layout(local_size_x = 64) in;
#include "common/invocation.glsl"
layout(location = 0) uniform uint count;
layout(std430, binding = 0) readonly buffer NodesA { uvec4 nodes_a[]; };
layout(std430, binding = 1) readonly buffer NodesB { uvec4 nodes_b[]; };
layout(std430, binding = 2) readonly buffer List { uint list[]; };
)";

const char* const kTestShader = R"(
layout(std430, binding = 3) writeonly buffer Marks { uint marks[]; };
layout(std430, binding = 4) readonly buffer TrianglesA { float triangles_a[]; };
layout(std430, binding = 5) readonly buffer TrianglesB { float triangles_b[]; };
layout(std430, binding = 6) readonly buffer Poses { vec4 poses[]; };  // three rows of a 3 x 4 matrix each

const float EPSILON = 1e-6;

mat3 axesOf(uvec4 x, uvec4 y)
{
  vec3 first = uintBitsToFloat(x.xyz);
  vec3 second = uintBitsToFloat(y.xyz);
  return mat3(first, second, cross(first, second));
}

// Whether one of 15 axes separates two boxes. r, t: the frame of b in the frame of a.
bool boxesApart(mat3 r, vec3 t, vec3 half_a, vec3 half_b)
{
  mat3 absolute = mat3(abs(r[0]) + EPSILON, abs(r[1]) + EPSILON, abs(r[2]) + EPSILON);
  if (any(greaterThan(abs(t), half_a + absolute * half_b)) || any(greaterThan(abs(t * r), half_b + half_a * absolute)))
    return true;
  for (int i = 0; i < 3; ++i)
  {
    int i1 = (i + 1) % 3;
    int i2 = (i + 2) % 3;
    for (int k = 0; k < 3; ++k)
    {
      int k1 = (k + 1) % 3;
      int k2 = (k + 2) % 3;
      float reach = half_a[i1] * absolute[k][i2] + half_a[i2] * absolute[k][i1] + half_b[k1] * absolute[k2][i] +
                    half_b[k2] * absolute[k1][i];
      if (abs(t[i2] * r[k][i1] - t[i1] * r[k][i2]) > reach)
        return true;
    }
  }
  return false;
}

bool separates(vec3 axis, vec3 a[3], vec3 b[3])
{
  vec3 along_a = vec3(dot(axis, a[0]), dot(axis, a[1]), dot(axis, a[2]));
  vec3 along_b = vec3(dot(axis, b[0]), dot(axis, b[1]), dot(axis, b[2]));
  return max(along_a.x, max(along_a.y, along_a.z)) < min(along_b.x, min(along_b.y, along_b.z)) ||
         max(along_b.x, max(along_b.y, along_b.z)) < min(along_a.x, min(along_a.y, along_a.z));
}

// Coordinates are relative to the first corner of a.
bool trianglesOverlap(vec3 a[3], vec3 b[3])
{
  vec3 edges_a[3] = vec3[3](a[1] - a[0], a[2] - a[1], a[0] - a[2]);
  vec3 edges_b[3] = vec3[3](b[1] - b[0], b[2] - b[1], b[0] - b[2]);
  vec3 normal_a = cross(edges_a[0], edges_a[1]);
  vec3 normal_b = cross(edges_b[0], edges_b[1]);
  bool apart = separates(normal_a, a, b) || separates(normal_b, a, b);
  for (int i = 0; i < 3 && !apart; ++i)
  {
    apart = separates(cross(normal_a, edges_a[i]), a, b) || separates(cross(normal_b, edges_b[i]), a, b);
    for (int k = 0; k < 3; ++k)
      apart = apart || separates(cross(edges_a[i], edges_b[k]), a, b);
  }
  return !apart;
}

void main()
{
  uint i = invocationIndex();
  if (i >= count)
    return;
  uint pose = 3u * list[3u * i];
  uint a = 4u * list[3u * i + 1u];
  uint b = 4u * list[3u * i + 2u];
  mat3 rotation = transpose(mat3(poses[pose].xyz, poses[pose + 1u].xyz, poses[pose + 2u].xyz));
  vec3 translation = vec3(poses[pose].w, poses[pose + 1u].w, poses[pose + 2u].w);
  mat3 axes_a = axesOf(nodes_a[a + 2u], nodes_a[a + 3u]);
  vec3 between = rotation * uintBitsToFloat(nodes_b[b].xyz) + translation - uintBitsToFloat(nodes_a[a].xyz);
  if (boxesApart(transpose(axes_a) * (rotation * axesOf(nodes_b[b + 2u], nodes_b[b + 3u])), between * axes_a,
                 uintBitsToFloat(nodes_a[a + 1u].xyz), uintBitsToFloat(nodes_b[b + 1u].xyz)))
  {
    marks[i] = 0u;
    return;
  }
  if (nodes_a[a].w != 0u || nodes_b[b].w != 0u)
  {
    marks[i] = 1u;
    return;
  }
  uint triangle_a = 9u * nodes_a[a + 1u].w;
  uint triangle_b = 9u * nodes_b[b + 1u].w;
  vec3 corners_a[3];
  vec3 corners_b[3];
  for (uint k = 0u; k < 3u; ++k)
  {
    corners_a[k] = vec3(triangles_a[triangle_a + 3u * k], triangles_a[triangle_a + 3u * k + 1u],
                        triangles_a[triangle_a + 3u * k + 2u]);
    vec3 corner = vec3(triangles_b[triangle_b + 3u * k], triangles_b[triangle_b + 3u * k + 1u],
                       triangles_b[triangle_b + 3u * k + 2u]);
    corners_b[k] = rotation * corner + translation;
  }
  vec3 origin = corners_a[0];
  for (int k = 0; k < 3; ++k)
  {
    corners_a[k] -= origin;
    corners_b[k] -= origin;
  }
  marks[i] = trianglesOverlap(corners_a, corners_b) ? 2u : 0u;
}
)";

const char* const kListShader = R"(
layout(location = 1) uniform uint next_capacity;
layout(location = 2) uniform uint found_capacity;
layout(std430, binding = 3) readonly buffer Marks { uint marks[]; };
layout(std430, binding = 4) writeonly buffer Next { uint next[]; };
layout(std430, binding = 5) writeonly buffer Found { uint found[]; };  // pose and two triangles
layout(std430, binding = 6) buffer Counters { uint next_count; uint found_count; };

void main()
{
  uint i = invocationIndex();
  if (i >= count || marks[i] == 0u)
    return;
  uint pose = list[3u * i];
  uint a = list[3u * i + 1u];
  uint b = list[3u * i + 2u];
  if (marks[i] == 2u)
  {
    uint place = atomicAdd(found_count, 1u);
    if (place < found_capacity)
    {
      found[3u * place] = pose;
      found[3u * place + 1u] = nodes_a[4u * a + 1u].w;
      found[3u * place + 2u] = nodes_b[4u * b + 1u].w;
    }
    return;
  }
  uint child_a = nodes_a[4u * a].w;
  uint child_b = nodes_b[4u * b].w;
  uint count_a = child_a == 0u ? 1u : 2u;
  uint count_b = child_b == 0u ? 1u : 2u;
  uint place = atomicAdd(next_count, count_a * count_b);
  if (place + count_a * count_b > next_capacity)
    return;
  for (uint k = 0u; k < count_a; ++k)
    for (uint l = 0u; l < count_b; ++l)
    {
      next[3u * place] = pose;
      next[3u * place + 1u] = child_a == 0u ? a : child_a + k;
      next[3u * place + 2u] = child_b == 0u ? b : child_b + l;
      ++place;
    }
}
)";
}  // namespace gpu_planning_scene::core::literature
