// Bounds on what float32 makes of a pair of placed shapes; docs/error_bounds.md derives each. Lengths in metres.
// The relative error of one operation, whatever the rounding mode.
const float u = UNIT_ROUNDOFF;
// Products that are smaller than this may have lost all their digits to underflow.
const float TINY = 1e-30;
// What is larger than this has a square that is right to its last digits.
const float LEAST_SQUARED = 1e-18;
// What squares may lose of a vector's squared length, and what the length may so be short of, where they underflow.
const float LOST_SQUARE = 4e-38;
const float LOST_LENGTH = 2e-19;

// At least the length of an axis, however short it is.
float lengthAtMost(vec3 axis)
{
  return length(axis) + LOST_LENGTH;
}

// The corner of a box that is furthest from its shape's origin, mirrored to positive coordinates.
vec3 farCorner(Box box)
{
  return abs(box.center) + box.extent;
}

// How far the computed position of a point of b against a point of a may be off: poses a and b were rounded to float,
// `pose`, b's in a's frame, was computed from them, b's point was rounded and moved by it, a's point was rounded.
// `far_a`, `far_b`: farCorner of the shapes' boxes.
float positionError(Pose a, Pose b, Pose pose, vec3 far_a, vec3 far_b)
{
  const mat3 into_a = transpose(absolute(a.rotation));
  const vec3 between = abs(b.translation - a.translation);
  const vec3 turned = absolute(pose.rotation) * far_b;
  const vec3 parts = 0.5 * (into_a * (abs(a.translation) + abs(b.translation))) + 5.5 * (into_a * between) +
                     4.0 * (into_a * (absolute(b.rotation) * far_b)) + 4.5 * turned;
  return u * (length(parts) + length(far_a)) * (1.0 + 64.0 * u);
}

// What the place of b's box in a may be off by, and the depth of b's point in a's solid.
float boxError(float position_error)
{
  return 8.0 * position_error;
}

// How far boxes have to be apart for what they hold to be apart by more than `gap`, but for an error relative to the boxes' own
// sizes (sizeError).
float boxMargin(float gap, float position_error)
{
  return gap * (1.0 + 512.0 * u) + boxError(position_error);
}

// The same for the depth of a's point in b's solid, through the inverse pose.
float inverseError(float position_error, vec3 far_a)
{
  return 8.0 * position_error + 20.0 * u * length(far_a);
}

// How far two shapes have to be apart for their pair to be free: the required distance, what their true surfaces may
// exceed their triangles by, and the distance within which the contract leaves the answer to the CPU.
float requiredGap(float distance, float slack)
{
  return (distance + slack) * (1.0 + 16.0 * u) + CONTRACT_BAND;
}

// What the height of a robot's point above a plane of the world may be off by.
float planeError(Pose pose, vec3 far, float offset)
{
  return u * (10.0 * length(pose.translation) + 16.0 * length(far) + 4.0 * abs(offset));
}
