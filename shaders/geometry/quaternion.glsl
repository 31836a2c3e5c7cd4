// Rotations as quaternions (x, y, z, w). Their length is 1 up to rounding. The entries of rotationOf's matrix are then
// off by at most 25 u.
mat3 rotationOf(vec4 q)
{
  const vec3 twice = 2.0 * q.xyz;
  const vec3 squares = q.xyz * twice;
  const vec3 mixed = q.yzx * twice.zxy;  // yz, zx, xy
  const vec3 turned = q.w * twice;
  return mat3(1.0 - squares.y - squares.z, mixed.z + turned.z, mixed.y - turned.y,
              mixed.z - turned.z, 1.0 - squares.z - squares.x, mixed.x + turned.x,
              mixed.y + turned.y, mixed.x - turned.x, 1.0 - squares.x - squares.y);
}

vec4 product(vec4 a, vec4 b)
{
  return vec4(a.w * b.xyz + b.w * a.xyz + cross(a.xyz, b.xyz), a.w * b.w - dot(a.xyz, b.xyz));
}

// The quaternion of a rotation matrix (Shepperd 1978, "Quaternion from Rotation Matrix"). It is computed from the
// largest of the quaternion's four entries, so that no digits cancel.
vec4 quaternionOf(mat3 m)
{
  const vec4 squares = vec4(1.0 + m[0].x - m[1].y - m[2].z, 1.0 - m[0].x + m[1].y - m[2].z,
                            1.0 - m[0].x - m[1].y + m[2].z, 1.0 + m[0].x + m[1].y + m[2].z);
  const float xy = m[1].x + m[0].y;
  const float yz = m[2].y + m[1].z;
  const float zx = m[0].z + m[2].x;
  const vec3 turned = vec3(m[1].z - m[2].y, m[2].x - m[0].z, m[0].y - m[1].x);
  const float most = max(max(squares.x, squares.y), max(squares.z, squares.w));
  const vec4 q = most == squares.w ? vec4(turned, squares.w) : most == squares.x ? vec4(squares.x, xy, zx, turned.x) :
                 most == squares.y ? vec4(xy, squares.y, yz, turned.y) : vec4(zx, yz, squares.z, turned.z);
  return normalize(q);
}
