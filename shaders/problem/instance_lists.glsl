// The numbers of states and robot instances of a batch, and the row and state for which an invocation works.
#include "problem/instances.glsl"
layout(location = LOCATION_STATE_COUNT) uniform uint state_count;
layout(location = LOCATION_ROBOT_COUNT) uniform uint robot_count;

// A row is a robot instance or a query. The invocations of the broad phase go through all states for one row before the
// next row. So a state with a hit in an early row skips the later rows, and the pairs of one state are spread over the
// lists.
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
