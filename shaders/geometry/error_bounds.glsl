// Error bounds of float32 computations that several tests of two placed shapes share: poses, boxes, planes. The bounds
// of two triangles are in triangle_error_bounds.glsl. All other bounds are in the file of their test. In geometry/:
// triangle_distance.glsl and winding_number.glsl. In traversal/: solid_leaf.glsl, solid_nodes.glsl, close_enough.glsl
// and bounding_volume_overlap.glsl (sizeError). docs/error_bounds.md derives each bound. Lengths are in metres.

// The relative error of one operation, in every rounding mode.
const float u = UNIT_ROUNDOFF;
// A product smaller than this may have lost all its digits to underflow.
const float TINY = 1e-30;
// The square of a larger number than this loses no digits to underflow.
const float LEAST_SQUARED = 1e-18;
// Underflow of squares may make the computed squared length of a vector too small by LOST_SQUARE, and its computed
// length too small by LOST_LENGTH.
const float LOST_SQUARE = 4e-38;
const float LOST_LENGTH = 2e-19;

// An upper bound on the length of an axis, however short it is.
float lengthAtMost(vec3 axis)
{
  return length(axis) + LOST_LENGTH;
}

// The corner of a box that is farthest from its shape's origin, mirrored to positive coordinates.
vec3 farCorner(Box box)
{
  return abs(box.center) + box.extent;
}

// Upper bound on the error of the computed position of a point of b relative to a point of a. The poses a and b were
// rounded to float, and `pose`, the pose of b in the frame of a, was computed from them. The point of b was rounded and
// transformed by `pose`. The point of a was rounded. `far_a`, `far_b`: farCorner of the boxes of the shapes.
float positionError(Pose a, Pose b, Pose pose, vec3 far_a, vec3 far_b)
{
  const mat3 into_a = transpose(absolute(a.rotation));
  const vec3 between = abs(b.translation - a.translation);
  const vec3 turned = absolute(pose.rotation) * far_b;
  const vec3 parts = 0.5 * (into_a * (abs(a.translation) + abs(b.translation))) + 5.5 * (into_a * between) +
                     4.0 * (into_a * (absolute(b.rotation) * far_b)) + 4.5 * turned;
  return u * (length(parts) + length(far_a)) * (1.0 + 64.0 * u);
}

// Upper bound on the error of the position of b's box in the frame of a, and of the depth of a point of b
// in the solid a.
float boxError(float position_error)
{
  return 8.0 * position_error;
}

// The gap that two boxes must have so that their contents are more than `gap` apart. A further error grows with the
// sizes of the boxes (sizeError).
float boxMargin(float gap, float position_error)
{
  return gap * (1.0 + 512.0 * u) + boxError(position_error);
}

// The same for the line of the centres, whose length is known better than those of the other axes.
float centersMargin(float gap, float position_error)
{
  return gap * (1.0 + 16.0 * u) + boxError(position_error);
}

// Upper bound on the error of the depth of a point of a in the solid b. This point is transformed by the inverse pose.
float inverseError(float position_error, vec3 far_a)
{
  return 8.0 * position_error + 20.0 * u * length(far_a);
}

// The gap above which the pair of two shapes is free: the required distance, plus the slack (how far their true
// surfaces may lie outside their triangles), plus the band within which the contract leaves the verdict to the CPU.
float requiredGap(float distance, float slack)
{
  return (distance + slack) * (1.0 + 16.0 * u) + CONTRACT_BAND;
}

// Upper bound on the error of the height of a robot's point above a plane of the world.
float planeError(Pose pose, vec3 far, float offset)
{
  return u * (10.0 * length(pose.translation) + 16.0 * length(far) + 4.0 * abs(offset));
}
