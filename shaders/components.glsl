// The connected components of the shapes: for each one a point of it, the centre and the half edge lengths of its box.
layout(std430, binding = BINDING_IN) readonly buffer Components { vec4 components[]; };  // three each

vec3 componentPoint(uint component)
{
  return components[3u * component].xyz;
}

Box componentBox(uint component)
{
  return Box(components[3u * component + 1u].xyz, components[3u * component + 2u].xyz);
}
