// One invocation per corner of a triangle of a picture: projects the corner and passes its colour and normal on.
// src/render/renderer.cpp sets the inputs.

layout(location = 0) uniform mat4 to_clip_space;

layout(location = 0) in vec3 position;  // metres, in the planning frame
layout(location = 1) in vec3 normal;    // of the corner's triangle, of unit length
layout(location = 2) in vec4 color;

out gl_PerVertex
{
  vec4 gl_Position;
};
layout(location = 0) out vec3 place;
layout(location = 1) flat out vec3 facing;
layout(location = 2) flat out vec4 paint;

void main()
{
  gl_Position = to_clip_space * vec4(position, 1.0);
  place = position;
  facing = normal;
  paint = color;
}
