layout(std430, binding = BINDING_COUNTERS) buffer Counters { uint counters[]; };
