// The queries of the broad phase in the order in which they run (BroadPhaseQueries in
// src/collision/gpu/broad_phase/broad_phase_order.h).
layout(location = LOCATION_FIRST_QUERY) uniform uint first_query;
layout(location = LOCATION_QUERY_COUNT) uniform uint query_count;
layout(binding = UNIT_QUERIES) uniform usamplerBuffer queries;

// x: a robot instance. y, z, w, in the queries among links: six other robot instances of 16 bits each, or NO_PARTNER.
uvec4 fetchQuery(uint number)
{
  return texelFetch(queries, int(first_query + number));
}
