// Tests whether a point is inside the solid of a mesh. The signed crossings of a ray along a coordinate axis add up to
// the winding number of the point, which is 0 outside (Jacobson, Kavan and Sorkine-Hornung 2013, "Robust Inside-Outside
// Segmentation using Generalized Winding Numbers"). For triangles that cannot be oriented, an odd number of crossings
// means inside. A ray that passes too near to an edge, or begins too near to the surface, decides nothing.
layout(std430, binding = BINDING_A) readonly buffer LeafOrder { uint leaf_order[]; };
layout(std430, binding = BINDING_B) readonly buffer TriangleRoles { uint triangle_roles[]; };  // ROLE_BITS each

// Returns the role (ROLE_*) of the triangle at this place of the leaf order.
uint roleOf(uint primitive)
{
  const uint triangle = leaf_order[primitive];
  const uint word = triangle_roles[triangle / ROLES_PER_WORD];
  return word >> (ROLE_BITS * (triangle % ROLES_PER_WORD)) & ((1u << ROLE_BITS) - 1u);
}

// The crossing of a triangle by the ray from the origin along +z: +1 or -1 by the direction of the triangle, 0 if the
// ray misses it, UNCERTAIN_CROSSING if rounding leaves this open. The corners are off by at most `error`.
#define UNCERTAIN_CROSSING 1000

int crossing(vec3 c[3], float error)
{
  vec3 lowest = c[0];
  vec3 highest = c[0];
  float size = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    lowest = min(lowest, c[i]);
    highest = max(highest, c[i]);
    size = max(size, length(c[i]));
  }
  const float off = error + 2.0 * u * size;
  if (any(greaterThan(lowest.xy, vec2(off))) || any(lessThan(highest, vec3(-off))))
    return 0;
  size += error;
  const float area_error = size * (3.0 * error + 6.0 * u * size) + TINY;
  precise float area[3];  // twice the signed area of the triangle between the origin and each edge
  bool above = true;
  bool below = true;
  bool some_above = false;
  bool some_below = false;
  for (int i = 0; i < 3; ++i)
  {
    const vec3 next = c[(i + 1) % 3];
    area[i] = c[i].x * next.y - c[i].y * next.x;
    above = above && area[i] > area_error;
    below = below && area[i] < -area_error;
    some_above = some_above || area[i] > area_error;
    some_below = some_below || area[i] < -area_error;
  }
  if (some_above && some_below)
    return 0;
  if (!above && !below)
    return UNCERTAIN_CROSSING;
  // The height at which the z axis meets the plane of the triangle, times the sum of the areas.
  precise const float height = area[1] * c[0].z + area[2] * c[1].z + area[0] * c[2].z;
  const float height_error =
      3.0 * (area_error * size + (abs(area[0]) + abs(area[1]) + abs(area[2])) * (error + 4.0 * u * size)) + TINY;
  const int direction = above ? 1 : -1;
  const float along = above ? height : -height;
  return along > height_error ? direction : (along < -height_error ? 0 : UNCERTAIN_CROSSING);
}

// Returns STATE_HIT if `point` is inside, 0 if it is outside. The point is off by at most `error`. Returns
// STATE_UNDECIDED if none of the three rays decides, or if the iterations run out: each step decrements `iterations`.
uint insideMesh(uint root, vec3 point, float error, inout uint iterations)
{
  for (int axis = 0; axis < 3 * FLOAT32_TRUSTED; ++axis)
  {
    uint stack[BUILD_ROUNDS + 2];
    stack[0] = root;
    int top = 1;
    int winding = 0;
    uint crossings = 0u;  // of the triangles that count by parity
    bool certain = true;
    for (; top > 0 && certain && iterations > 0u; --iterations)
    {
      const TreeNode node = fetchNode(stack[--top]);
      const vec3 to = vectorBetween(point, node.box.center);
      const vec3 reach = node.box.extent + error + 8.0 * u * (node.box.extent + abs(to));
      bvec3 misses = greaterThan(abs(to), reach);
      misses[axis] = to[axis] < -reach[axis];
      if (any(misses))
        continue;
      if (node.count == 0u)
      {
        stack[top] = node.first;
        stack[top + 1] = node.first + 1u;
        top += 2;
        continue;
      }
      for (uint i = node.first; i < node.first + node.count; ++i)
      {
        vec3 corners[3];
        fetchTriangle(i, corners);
        precise vec3 c[3];
        for (int k = 0; k < 3; ++k)
        {
          // Permutes the coordinates so that the axis of the ray becomes z.
          c[k] = corners[k] - point;
          c[k] = vec3(c[k][(axis + 1) % 3], c[k][(axis + 2) % 3], c[k][axis]);
        }
        const uint role = roleOf(i);
        const int crossed = role == ROLE_SURFACE ? 0 : crossing(c, error);
        certain = certain && crossed != UNCERTAIN_CROSSING;
        winding += role == ROLE_WINDING ? crossed : 0;
        crossings += role == ROLE_PARITY && crossed != 0 ? 1u : 0u;
      }
    }
    if (certain && top > 0)
      return STATE_UNDECIDED;
    if (certain)
      return winding != 0 || (crossings & 1u) != 0u ? STATE_HIT : 0u;
  }
  return STATE_UNDECIDED;
}
