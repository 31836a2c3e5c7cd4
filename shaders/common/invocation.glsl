// The place of an invocation in its dispatch. A dispatch of more than MAX_GROUPS work groups is spread over y. Include
// this file after the declaration of local_size_x.
#include "shader_constants.h"

uint groupIndex()
{
  return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

uint invocationIndex()
{
  return groupIndex() * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}
