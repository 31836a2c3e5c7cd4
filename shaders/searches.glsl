// Searches of the broad phase, in the order in which they are to be made.
layout(location = 3) uniform uint first_search;
layout(location = 4) uniform uint search_count;
layout(binding = UNIT_SEARCHES) uniform usamplerBuffer searches;

// A robot instance; in a search for its like, six of these in 16 bits each.
uvec4 fetchSearch(uint number)
{
  return texelFetch(searches, int(first_search + number));
}
