// One invocation per corner of a triangle of a picture: projects the corner and passes its colour and normal on.
// src/render/gl_painter.cpp sets the inputs.

#include "shader_constants.h"

layout(location = LOCATION_TO_CLIP_SPACE) uniform mat4 to_clip_space;
// The eye, and a distance in metres. The depth of each corner is that of a point nearer to the eye by this distance.
layout(location = LOCATION_PULL) uniform vec4 pull;

layout(location = ATTRIBUTE_POSITION) in vec3 position;  // metres, in the planning frame
layout(location = ATTRIBUTE_NORMAL) in vec3 normal;      // of the corner's triangle, of unit length
layout(location = ATTRIBUTE_COLOR) in vec4 color;

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
  if (pull.w > 0.0)
  {
    vec4 nearer = to_clip_space * vec4(position + pull.w * normalize(pull.xyz - position), 1.0);
    gl_Position.z = nearer.z / nearer.w * gl_Position.w;
  }
  place = position;
  facing = normal;
  paint = color;
}
