// Parts of the forward kinematics in float that the C++ code generates for a robot
// (src/collision/gpu/proofs/frames_text.cpp), as in src/collision/cpu/lanes/lane_kinematics.h. Lengths are in
// metres, angles in radians.

// Angles modulo 2 pi, in [-pi, pi].
double turned(double angle)
{
  return angle - 6.283185307179586lf * roundEven(angle * (1.0lf / 6.283185307179586lf));
}

// Sine and cosine of |x| <= pi, within 1e-6. Taylor polynomials after a reduction to [-pi/4, pi/4].
void sineCosine(float x, out float sine, out float cosine)
{
  const int quarter = int(x * 0.63661977 + (x < 0.0 ? -0.5 : 0.5));
  const float whole = float(quarter);
  // pi / 2 = 1.5707964 - 4.371139e-8
  precise const float first = x - whole * 1.57079637;
  precise const float r = first + whole * 4.37113883e-8;
  const float s = r * r;
  const float sine_of_r =
      r + r * s * (-1.66666667e-1 + s * (8.33333333e-3 + s * (-1.98412698e-4 + s * 2.75573e-6)));
  const float cosine_of_r = 1.0 + s * (-0.5 + s * (4.16666667e-2 + s * (-1.38888889e-3 + s * 2.48015873e-5)));
  const bool odd = (quarter & 1) != 0;
  sine = (odd ? cosine_of_r : sine_of_r) * ((quarter & 2) != 0 ? -1.0 : 1.0);
  cosine = (odd ? sine_of_r : cosine_of_r) * (((quarter + 1) & 2) != 0 ? -1.0 : 1.0);
}

// Writes the rotation of a quaternion (x, y, z, w). Returns false if it is too short for float arithmetic.
bool turnedBy(vec4 q, out mat3 rotation)
{
  const float squared = dot(q, q);
  const vec3 d = 2.0 / max(squared, LEAST_SQUARED_QUATERNION) * q.xyz;
  rotation = mat3(1.0 - (q.y * d.y + q.z * d.z), q.x * d.y + q.w * d.z, q.x * d.z - q.w * d.y,
                  q.x * d.y - q.w * d.z, 1.0 - (q.x * d.x + q.z * d.z), q.y * d.z + q.w * d.x,
                  q.x * d.z + q.w * d.y, q.y * d.z - q.w * d.x, 1.0 - (q.x * d.x + q.y * d.y));
  return squared > LEAST_SQUARED_QUATERNION;
}
