// Squared distances of a point from the objects of the proofs (src/collision/cpu/lanes/lane_distances.h). Lengths
// are in metres.

// In a plane, from a segment that begins at the origin and runs along `along`.
float squaredDistanceFromSegment(vec2 point, vec2 along)
{
  const float share = clamp(dot(point, along) / dot(along, along), 0.0, 1.0);
  precise const vec2 beside = point - share * along;
  return dot(beside, beside);
}

// In the half plane through the axis and the point, a cone is a triangle.
float squaredDistanceFromCone(float from_axis, float z, float radius, float half_length)
{
  const float to_base = squaredDistanceFromSegment(vec2(from_axis, z + half_length), vec2(radius, 0.0));
  const float to_side =
      squaredDistanceFromSegment(vec2(from_axis - radius, z + half_length), vec2(-radius, 2.0 * half_length));
  const bool inside =
      z >= -half_length && 2.0 * half_length * (from_axis - radius) + radius * (z + half_length) <= 0.0;
  return inside ? 0.0 : min(to_base, to_side);
}

// From an object, of a point in its frame; 0 inside.
float squaredDistanceFrom(ProofObject object, vec3 point)
{
  const vec3 size = object.kind == OBJECT_HALF_SPACE ? point : abs(point);
  const vec3 beyond = max(size - object.half_lengths, vec3(0.0));
  float squared = dot(beyond, beyond);
  // The loop runs at most once. It stands for a branch: on llvmpipe, a branch costs all invocations time, but a loop
  // only those that enter it.
  for (bool is_round = object.kind >= OBJECT_SPHERE && object.kind <= OBJECT_CONE; is_round; is_round = false)
  {
    const float from_axis = length(point.xy);
    const float beyond_ball = max(length(point) - object.half_lengths.x, 0.0);
    const vec2 beyond_ends = max(vec2(from_axis, abs(point.z)) - object.half_lengths.xz, vec2(0.0));
    squared = object.kind == OBJECT_SPHERE ? beyond_ball * beyond_ball
              : object.kind == OBJECT_CYLINDER
                  ? dot(beyond_ends, beyond_ends)
                  : squaredDistanceFromCone(from_axis, point.z, object.half_lengths.x, object.half_lengths.z);
  }
  return squared;
}
