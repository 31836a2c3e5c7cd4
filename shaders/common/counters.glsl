// The counters of a part: COUNTER_* in shader_constants.h are their places.
layout(std430, binding = BINDING_COUNTERS) buffer Counters { uint counters[]; };
