// One invocation per drawn pixel of a picture: diffuse light from the eye and a little more light from above. Both
// faces of a triangle are lit alike, because meshes may be open or inside out.

layout(location = 0) uniform vec3 eye;  // metres, in the planning frame
layout(location = 1) uniform vec3 up;   // of unit length

layout(location = 0) in vec3 place;        // metres, in the planning frame
layout(location = 1) flat in vec3 facing;  // the triangle's normal, of unit length
layout(location = 2) flat in vec4 paint;   // the triangle's colour

layout(location = 0) out vec4 color;

void main()
{
  vec3 towards_eye = normalize(eye - place);
  vec3 outward = dot(facing, towards_eye) < 0.0 ? -facing : facing;
  float light = 0.42 + 0.42 * dot(outward, towards_eye) + 0.26 * max(0.0, dot(outward, up));
  color = vec4(paint.rgb * min(light, 1.0), 1.0);
}
