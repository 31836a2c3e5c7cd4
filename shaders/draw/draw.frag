// A pixel of a picture: diffuse light from the eye and a little more from above, the same on both faces of a triangle, as
// meshes may be open or inside out.

layout(location = 0) uniform vec3 eye;  // metres, in the planning frame
layout(location = 1) uniform vec3 up;   // of unit length

layout(location = 0) in vec3 place;
layout(location = 1) flat in vec3 facing;
layout(location = 2) flat in vec4 paint;

layout(location = 0) out vec4 color;

void main()
{
  vec3 towards_eye = normalize(eye - place);
  vec3 outward = dot(facing, towards_eye) < 0.0 ? -facing : facing;
  float light = 0.42 + 0.42 * dot(outward, towards_eye) + 0.26 * max(0.0, dot(outward, up));
  color = vec4(paint.rgb * min(light, 1.0), 1.0);
}
