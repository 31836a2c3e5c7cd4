// The connected components of the shapes: for each one a point of it, and the longest edge of its box, rounded down.
layout(std430, binding = BINDING_C) readonly buffer Components { vec4 components[]; };

vec3 componentPoint(uint component)
{
  return components[component].xyz;
}

float componentSize(uint component)
{
  return components[component].w;
}
