// The states of a batch: the variables of a robot in double precision.
#include "shader_constants.h"
// Two doubles a texel, state after state.
layout(binding = UNIT_STATES) uniform usamplerBuffer state_texels;

dvec2 twoDoubles(uvec4 texel)
{
  return dvec2(packDouble2x32(texel.xy), packDouble2x32(texel.zw));
}

double variable(uint state, uint variable_count, uint index)
{
  const uint at = state * variable_count + index;
  return twoDoubles(texelFetch(state_texels, int(at / 2u)))[at % 2u];
}
