// Rigid transforms: x -> rotation * x + translation. Lengths are in metres.
struct Pose
{
  mat3 rotation;
  vec3 translation;
};

// Three texels hold the rows of [rotation | translation].
Pose poseFromRows(vec4 x, vec4 y, vec4 z)
{
  return Pose(transpose(mat3(x.xyz, y.xyz, z.xyz)), vec3(x.w, y.w, z.w));
}

Pose fetchPose(usamplerBuffer poses, uint index)
{
  const int at = int(POSE_TEXELS * index);
  return poseFromRows(uintBitsToFloat(texelFetch(poses, at)), uintBitsToFloat(texelFetch(poses, at + 1)),
                      uintBitsToFloat(texelFetch(poses, at + 2)));
}

mat3 absolute(mat3 m)
{
  return mat3(abs(m[0]), abs(m[1]), abs(m[2]));
}

// The vector between two points, rounded once. A compiler must not multiply the two points in its place: their products
// may be much larger than those of the vector. It is a function of its own because glslang 12 does not terminate when
// `precise` reaches back through a long loop.
vec3 vectorBetween(vec3 from, vec3 to)
{
  precise const vec3 between = to - from;
  return between;
}

vec3 apply(Pose pose, vec3 point)
{
  precise const vec3 turned = pose.rotation * point;
  precise const vec3 moved = turned + pose.translation;
  return moved;
}

// The pose of b in the frame of a. The poses a and b are given in one common frame.
Pose relativePose(Pose a, Pose b)
{
  const mat3 inverse = transpose(a.rotation);
  precise const vec3 between = b.translation - a.translation;
  return Pose(inverse * b.rotation, inverse * between);
}

Pose inversePose(Pose pose)
{
  const mat3 inverse = transpose(pose.rotation);
  return Pose(inverse, -(inverse * pose.translation));
}
