// The shape instances: the robot's first, then the world's. Lengths are in metres.
struct Instance
{
  uint root;             // root node of its tree
  float slack;           // the true surface lies at most this far outside the triangles
  uint first_component;  // first component of its shape, see components.glsl
  uint component_count;  // 0: more than MAX_COMPONENTS
  vec3 core;             // half edge lengths of a box around the shape's origin, inside its solid; negative: none
  uint kind;             // SOLID_*
  vec3 size;             // box: half edge lengths; cylinder and cone: radius, radius, half length; sphere: its radius
  float padding;
};

layout(binding = UNIT_INSTANCES) uniform usamplerBuffer instance_texels;

Instance fetchInstance(uint index)
{
  const int at = int(INSTANCE_TEXELS * index);
  const uvec4 a = texelFetch(instance_texels, at);
  const uvec4 b = texelFetch(instance_texels, at + 1);
  const uvec4 c = texelFetch(instance_texels, at + 2);
  return Instance(a.x, uintBitsToFloat(a.y), a.z, a.w, uintBitsToFloat(b.xyz), b.w, uintBitsToFloat(c.xyz),
                  uintBitsToFloat(c.w));
}

bool isPrimitive(Instance instance)
{
  return instance.kind != SOLID_NONE && instance.kind != SOLID_MESH;
}

uint packPair(uint robot, uint other)
{
  return (robot << PAIR_OTHER_BITS) | other;
}

uint pairRobot(uint pair)
{
  return pair >> PAIR_OTHER_BITS;
}

uint pairOther(uint pair)
{
  return pair & ((1u << PAIR_OTHER_BITS) - 1u);
}
