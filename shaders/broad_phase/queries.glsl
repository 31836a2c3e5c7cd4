// BroadPhaseQueries of the broad phase, in the order in which they are to be made.
layout(location = LOCATION_FIRST_QUERY) uniform uint first_query;
layout(location = LOCATION_QUERY_COUNT) uniform uint query_count;
layout(binding = UNIT_QUERIES) uniform usamplerBuffer queries;

// A robot instance; in a query for its like, six of these in 16 bits each.
uvec4 fetchQuery(uint number)
{
  return texelFetch(queries, int(first_query + number));
}
