// What is known of each state. Coherent, so that a hit is seen by all workgroups while they run.
layout(std430, binding = BINDING_FLAGS) coherent buffer Flags { uint flags[]; };
layout(std430, binding = BINDING_HITS) buffer Hits { uint hits[]; };

bool isDecided(uint state)
{
  return (flags[state] & STATE_HIT) != 0u;
}

// `found`: STATE_* bits. Any hit may be the one that is reported.
void report(uint state, uint pair, uint found)
{
#if !FLOATS_DECIDE
  found = STATE_UNDECIDED;
#endif
  if ((found & STATE_HIT) != 0u)
    hits[state] = pair;
  atomicOr(flags[state], found);
}

void reportUndecided(uint state)
{
  atomicOr(flags[state], STATE_UNDECIDED);
}
