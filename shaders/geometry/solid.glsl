// Primitives as solids, in their own frames: cores, nearest points and extents of a box, sphere, cylinder or cone.
// Nearest points as in Ericson 2005, "Real-Time Collision Detection", 5.1. Cores are our own method: they make a hit
// provable in float32, because a point of a core lies a known depth inside. Lengths are in metres.

// The sizes of the core at `depth`, for projectToCore. The core is a solid of the same kind whose points all lie at
// least `depth` below the surface of this solid. The core of a cone is the cone whose base and side have moved inwards:
// x is the radius of its base, y the height of its base, z the height of its apex.
vec3 coreSize(Instance solid, float depth)
{
  const vec3 size = solid.size;
  // The radial component of the outward normal of the side.
  const float slope = 2.0 * size.z * inversesqrt(size.x * size.x + 4.0 * size.z * size.z);
  const float base = size.x * (2.0 * size.z - depth) / (2.0 * size.z) - depth / slope;
  const vec3 cone = vec3(base, depth - size.z, depth - size.z + 2.0 * size.z * base / size.x);
  return solid.kind == SOLID_CONE ? cone : size - depth;
}

// The depth at which the core has no volume left: the radius of the largest sphere inside the solid.
float innerRadius(Instance solid)
{
  const vec3 size = solid.size;
  const float side = sqrt(size.x * size.x + 4.0 * size.z * size.z);
  const float cone = 2.0 * size.z * size.x / (size.x + side);
  return solid.kind == SOLID_CONE ? cone : min(size.x, min(size.y, size.z));
}

// The point of the core that is nearest to p, up to rounding.
vec3 projectToCore(uint kind, vec3 core, vec3 p)
{
  if (kind == SOLID_BOX)
    return clamp(p, -core, core);
  if (kind == SOLID_SPHERE)
    return p * min(1.0, core.x * inversesqrt(max(dot(p, p), TINY)));
  const float radius = sqrt(dot(p.xy, p.xy));
  const vec2 outward = radius > 0.0 ? p.xy / radius : vec2(0.0);
  if (kind == SOLID_CYLINDER)
    return vec3(outward * min(radius, core.x), clamp(p.z, -core.z, core.z));
  // A cone: in the plane through its axis and p it is a triangle, whose side runs from (core.x, core.y) to (0, core.z).
  const vec2 side = vec2(-core.x, core.z - core.y);
  const vec2 to = vec2(radius - core.x, p.z - core.y);
  const bool inside = p.z >= core.y && to.x * side.y - to.y * side.x <= 0.0;
  const vec2 on_side = vec2(core.x, core.y) + side * clamp(dot(to, side) / dot(side, side), 0.0, 1.0);
  const vec2 on_base = vec2(min(radius, core.x), core.y);
  const vec2 from_side = vec2(radius, p.z) - on_side;
  const vec2 from_base = vec2(radius, p.z) - on_base;
  const vec2 nearest = dot(from_side, from_side) < dot(from_base, from_base) ? on_side : on_base;
  return inside ? p : vec3(outward * nearest.x, nearest.y);
}

// The extent of the solid along a direction (support function): the largest n . x of its points x.
float extentAlong(Instance solid, vec3 n)
{
  const vec3 size = solid.size;
  if (solid.kind == SOLID_BOX)
    return dot(abs(n), size);
  if (solid.kind == SOLID_SPHERE)
    return size.x * length(n);
  const float across = size.x * length(n.xy);
  if (solid.kind == SOLID_CYLINDER)
    return across + size.z * abs(n.z);
  return max(size.z * n.z, across - size.z * n.z);
}
