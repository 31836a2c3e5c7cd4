// The states and instances of a batch, and which of them an invocation works for.
#include "problem/instances.glsl"
layout(location = LOCATION_STATE_COUNT) uniform uint state_count;
layout(location = LOCATION_ROBOT_COUNT) uniform uint robot_count;

// Invocations of the broad phase go through all states for one row, a robot instance or a search, before the next one: what
// hits early in the lists then spares its state the rest, and a state's pairs do not wait side by side.
uint rowOf(uint invocation)
{
  return invocation / state_count;
}

uint stateOf(uint invocation)
{
  return invocation % state_count;
}

uint poseIndex(uint state, uint robot)
{
  return robot * state_count + state;
}
