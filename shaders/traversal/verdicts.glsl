// The verdict of each state (STATE_* bits), and a colliding pair of each state with a hit. The flags are coherent, so
// that all work groups see a hit while they run.
layout(std430, binding = BINDING_FLAGS) coherent buffer Flags { uint flags[]; };
layout(std430, binding = BINDING_HITS) buffer Hits { uint hits[]; };

bool isDecided(uint state)
{
  return (flags[state] & STATE_HIT) != 0u;
}

// Adds `found` (STATE_* bits) to the verdict of a state. If several pairs collide, any one of them may be kept.
void report(uint state, uint pair, uint found)
{
#if !FLOAT32_TRUSTED
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
