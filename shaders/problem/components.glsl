// The connected components of the shapes. Each has one of its points, in the frame of its shape, and the length of the
// longest edge of its bounding box, rounded down. Lengths are in metres.
layout(std430, binding = BINDING_C) readonly buffer Components { vec4 components[]; };

vec3 componentPoint(uint component)
{
  return components[component].xyz;
}

float componentSize(uint component)
{
  return components[component].w;
}
