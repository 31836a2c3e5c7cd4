// The verdicts of pairs of robot instances whose relative pose depends on one or two variables
// (src/collision/filter/proofs/joint_table.h). A table has a verdict for each box of these variables.
#include "problem/states.glsl"
layout(location = LOCATION_VARIABLE_COUNT) uniform uint variable_count;  // of a state
// First the tables of the pairs, in words: [robot][robot], the first texel of the table, or 0. Then the tables. Two
// texels for each of two variables: the first value and the number of cells a unit (two doubles); the variable, whether
// the angle counts modulo 2 pi, the number of cells, and the stride of the cells. Then the cells, 16 a word:
// TABLE_APART, TABLE_COLLIDING or TABLE_NONE.
layout(binding = UNIT_TABLES) uniform usamplerBuffer table_texels;

// A larger angle modulo 2 pi is not accurate enough.
#define LARGEST_TABLE_ANGLE 1e4lf

// STATE_HIT, 0 if the pair is apart, or STATE_UNDECIDED if there is no proof.
uint proveByTable(uint state, uint a, uint b)
{
  const uint pair = a * robot_count + b;
  const uint first = texelFetch(table_texels, int(pair >> 2u))[pair & 3u];
  if (first == 0u)
    return STATE_UNDECIDED;
  uint cell = 0u;
  for (uint k = 0u; k < 2u; ++k)
  {
    const dvec2 range = twoDoubles(texelFetch(table_texels, int(first + TABLE_AXIS_TEXELS * k)));
    const uvec4 axis = texelFetch(table_texels, int(first + TABLE_AXIS_TEXELS * k + 1u));
    double value = variable(state, variable_count, axis.x);
    if (axis.y != 0u && abs(value) > LARGEST_TABLE_ANGLE)
      return STATE_UNDECIDED;
    if (axis.y != 0u)
      value -= 6.283185307179586lf * roundEven(value / 6.283185307179586lf);
    const double place = (value - range.x) * range.y;
    if (!(place >= 0.0lf && place < double(axis.z)))
      return STATE_UNDECIDED;
    cell += uint(int(place)) * axis.w;
  }
  const uint texel = first + 2u * TABLE_AXIS_TEXELS + cell / (TABLE_CELLS_A_WORD * TEXEL_WORDS);
  const uint word = texelFetch(table_texels, int(texel))[cell / TABLE_CELLS_A_WORD % TEXEL_WORDS];
  const uint proof = word >> TABLE_CELL_BITS * (cell % TABLE_CELLS_A_WORD) & 3u;
  return proof == TABLE_APART ? 0u : proof == TABLE_COLLIDING ? STATE_HIT : STATE_UNDECIDED;
}
