// The verdict of each state: VERDICT_* or a pair that collides. The words are coherent, so that all work groups see a
// hit while they run.
layout(std430, binding = BINDING_VERDICTS) coherent buffer Verdicts { uint verdicts[]; };

bool isDecided(uint state)
{
  const uint verdict = verdicts[state];
  return verdict != VERDICT_FREE && verdict < VERDICT_OPEN;
}

// Whether the proofs have nothing left to do for a state.
bool isSettled(uint state)
{
  const uint verdict = verdicts[state];
  return verdict != VERDICT_FREE && verdict != VERDICT_OPEN;
}

// A later hit still counts.
void reportUndecided(uint state)
{
  if (atomicCompSwap(verdicts[state], VERDICT_FREE, VERDICT_UNDECIDED) == VERDICT_OPEN)
    atomicCompSwap(verdicts[state], VERDICT_OPEN, VERDICT_UNDECIDED);
}

// Adds `found` (STATE_* bits) to the verdict of a state. If several pairs collide, any one of them may be kept.
void report(uint state, uint pair, uint found)
{
#if !FLOAT32_TRUSTED
  found = STATE_UNDECIDED;
#endif
  if ((found & STATE_HIT) != 0u)
    atomicExchange(verdicts[state], pair);
  else
    reportUndecided(state);
}
