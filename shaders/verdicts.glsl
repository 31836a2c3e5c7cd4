// What is known of each state.
layout(std430, binding = BINDING_FLAGS) buffer Flags { uint flags[]; };
layout(std430, binding = BINDING_HITS) buffer Hits { uint hits[]; };

bool isDecided(uint state)
{
  return (flags[state] & STATE_HIT) != 0u;
}

void reportHit(uint state, uint pair)
{
  atomicOr(flags[state], STATE_HIT);
  atomicExchange(hits[state], pair);
}

void reportUndecided(uint state)
{
  atomicOr(flags[state], STATE_UNDECIDED);
}
