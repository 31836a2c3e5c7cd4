// The margins of a batch, in metres. In a batch with margins, a pair must be apart by its required distance plus its
// margin (src/collision/bounds/displacement_bounds.h). The buffer has three parts, in words: for each pair of robot
// instances, the number of its margin; for each state, the number of its row; then the rows. A row has one float for
// each robot instance (its margin against the world) and one for each checked pair of robot instances.
#if MARGINS
layout(location = LOCATION_MARGIN_COUNT) uniform uint margin_count;  // floats of a row
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

// The margin of a robot instance against the world.
float worldMargin(uint state, uint robot)
{
#if MARGINS
  return marginOf(state, robot);
#else
  return 0.0;
#endif
}

// The margin of two robot instances that are a checked pair.
float selfMargin(uint state, uint a, uint b)
{
#if MARGINS
  return marginOf(state, marginWord(a * robot_count + b));
#else
  return 0.0;
#endif
}
