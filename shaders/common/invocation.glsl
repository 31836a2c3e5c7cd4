// What every kernel needs: its place in the dispatch. Dispatches of more than 65535 workgroups are spread over y.
// Include it after the declaration of local_size_x.
#include "shader_constants.h"

uint groupIndex()
{
  return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

uint invocationIndex()
{
  return groupIndex() * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}
