// By how much more than their required distance pairs have to be apart, in metres, where a batch has margins (see
// src/collision/bounds/displacement_bounds.h). Words: for two robot instances the number of their pair's margin; for each state the row of its
// margins; the rows, of a float for each robot instance and each self pair.
#if MARGINS
layout(location = LOCATION_MARGIN_COUNT) uniform uint margin_count;  // of a row
layout(binding = UNIT_MARGINS) uniform usamplerBuffer margin_words;

uint marginWord(uint index)
{
  return texelFetch(margin_words, int(index >> 2u))[index & 3u];
}

float marginOf(uint state, uint number)
{
  const uint rows = robot_count * robot_count;
  return uintBitsToFloat(marginWord(rows + state_count + marginWord(rows + state) * margin_count + number));
}
#endif

// Of a robot instance against the world.
float worldMargin(uint state, uint robot)
{
#if MARGINS
  return marginOf(state, robot);
#else
  return 0.0;
#endif
}

// Of two robot instances that are a pair.
float selfMargin(uint state, uint a, uint b)
{
#if MARGINS
  return marginOf(state, marginWord(a * robot_count + b));
#else
  return 0.0;
#endif
}
