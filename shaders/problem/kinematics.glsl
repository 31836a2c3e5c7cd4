// Parts of the kinematics shader that the C++ code generates for a robot
// (src/collision/gpu/problem/kinematics_shader.cpp). It computes in double precision, so the link poses are as accurate
// as those of the CPU. The only loss is the rounding of the poses to float (docs/error_bounds.md). The method is that
// of src/model/kinematics.cpp, the sine and cosine those of src/base/sine.cpp. Lengths are in metres, angles in
// radians.
#include "problem/instances.glsl"
#include "problem/instance_lists.glsl"
#include "problem/states.glsl"
#include "common/lists.glsl"
layout(location = LOCATION_LISTED) uniform uint listed;  // 1: only the states of a list are placed
layout(std430, binding = BINDING_OPEN_STATES) readonly buffer OpenStates { uint open_states[]; };
// Texels 0 and 1: the origin of the poses, in the planning frame. Then one texel per link: the first of its records,
// the end of its records, and the texel at which the records begin. Then the records, one for each shape of a link: six
// texels with the rows of its pose in the frame of its link (two texels a row), and one with its robot instance.
layout(binding = UNIT_LINK_SHAPES) uniform usamplerBuffer link_shapes;
// Three rows of [rotation | translation] for each robot instance and state, see poseIndex.
layout(std430, binding = BINDING_A) writeonly buffer Poses { vec4 poses[]; };

struct DoublePose
{
  dmat3 rotation;
  dvec3 translation;
};

DoublePose compose(DoublePose a, DoublePose b)
{
  return DoublePose(a.rotation * b.rotation, a.rotation * b.translation + a.translation);
}

// Sine and cosine for |x| <= 2^20: argument reduction as in src/base/sine.cpp (Cody and Waite 1980), then Taylor
// series.
void sineCosine(double x, out double sine, out double cosine)
{
  const double quadrants = roundEven(x * 0.63661977236758134308lf);
  precise const double first = x - quadrants * 1.57079632673412561417lf;
  precise const double second = first - quadrants * 6.07710050630396597660e-11lf;
  precise const double r = second - quadrants * 2.02226624879595063154e-21lf;
  const double z = r * r;
  double s = 1.0lf / 355687428096000.0lf;
  s = s * z - 1.0lf / 1307674368000.0lf;
  s = s * z + 1.0lf / 6227020800.0lf;
  s = s * z - 1.0lf / 39916800.0lf;
  s = s * z + 1.0lf / 362880.0lf;
  s = s * z - 1.0lf / 5040.0lf;
  s = s * z + 1.0lf / 120.0lf;
  s = s * z - 1.0lf / 6.0lf;
  s = r + r * z * s;
  double c = -1.0lf / 6402373705728000.0lf;
  c = c * z + 1.0lf / 20922789888000.0lf;
  c = c * z - 1.0lf / 87178291200.0lf;
  c = c * z + 1.0lf / 479001600.0lf;
  c = c * z - 1.0lf / 3628800.0lf;
  c = c * z + 1.0lf / 40320.0lf;
  c = c * z - 1.0lf / 720.0lf;
  c = c * z + 1.0lf / 24.0lf;
  c = 1.0lf - 0.5lf * z + z * z * c;
  const int turn = int(quadrants) & 3;
  const bool odd = (turn & 1) != 0;
  sine = (odd ? c : s) * ((turn & 2) != 0 ? -1.0lf : 1.0lf);
  cosine = (odd ? s : c) * (turn == 1 || turn == 2 ? -1.0lf : 1.0lf);
}

// The rotation of a quaternion (x, y, z, w) of any length. A quaternion of length 0 gives the identity.
dmat3 quaternionRotation(dvec4 q)
{
  const double most = max(max(abs(q.x), abs(q.y)), max(abs(q.z), abs(q.w)));
  if (most == 0.0lf)
    return dmat3(1.0lf);
  q /= most;
  q /= sqrt(dot(q, q));
  const dvec3 d = 2.0lf * q.xyz;
  const dvec3 w = q.w * d;
  return dmat3(1.0lf - q.y * d.y - q.z * d.z, q.x * d.y + w.z, q.x * d.z - w.y,
               q.x * d.y - w.z, 1.0lf - q.x * d.x - q.z * d.z, q.y * d.z + w.x,
               q.x * d.z + w.y, q.y * d.z - w.x, 1.0lf - q.x * d.x - q.y * d.y);
}

// Writes the poses of all shapes that move with a link. Each pose is rounded to float once.
void placeShapes(uint state, uint link, DoublePose link_pose)
{
  const dvec3 origin = dvec3(twoDoubles(texelFetch(link_shapes, 0)), twoDoubles(texelFetch(link_shapes, 1)).x);
  const uvec4 range = texelFetch(link_shapes, int(LINK_SHAPES_HEADER + link));
  for (uint record = range.x; record < range.y; ++record)
  {
    const int at = int(range.z + LINK_SHAPE_TEXELS * record);
    dvec2 halves[6];
    for (int i = 0; i < 6; ++i)
      halves[i] = twoDoubles(texelFetch(link_shapes, at + i));
    const dmat3 rows =
        dmat3(dvec3(halves[0], halves[1].x), dvec3(halves[2], halves[3].x), dvec3(halves[4], halves[5].x));
    const DoublePose shape = DoublePose(transpose(rows), dvec3(halves[1].y, halves[3].y, halves[5].y));
    const DoublePose placed = compose(link_pose, shape);
    const mat3 rotation = mat3(transpose(placed.rotation));
    const vec3 translation = vec3(placed.translation - origin);
    const uint to = POSE_TEXELS * poseIndex(state, texelFetch(link_shapes, at + LINK_SHAPE_TEXELS - 1).x);
    for (uint row = 0u; row < 3u; ++row)
      poses[to + row] = vec4(rotation[row], translation[row]);
  }
}
