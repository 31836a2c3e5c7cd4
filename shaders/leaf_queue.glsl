// Leaf pairs that a workgroup shares, and the tests of their triangles. Most leaves hold fewer than LEAF_TRIANGLES
// triangles: so each lane takes a triangle of a pair's smaller leaf, and tests it against the larger one.
#include "leaf_pair.glsl"

shared uvec4 leaf_pairs[LEAF_QUEUE];  // item, then the leaves as leafReference() has them
shared uint row_count;
shared uint rows[LEAF_CHUNK * LEAF_TRIANGLES];  // place in leaf_pairs, and a triangle of the smaller leaf

// Loop iterations of a chunk of leaf pairs, and of a row.
#define CHUNK_ITERATIONS (4u + 2u * LEAF_TRIANGLES)
#define ROW_ITERATIONS ((24u + 20u * PADDED) * LEAF_TRIANGLES)

void spreadLeafPair(uint place)
{
  const uvec4 pair = leaf_pairs[place];
  const uint count = isDecided(fetchState(pair.x)) ? 0u : min(leafCount(pair.y), leafCount(pair.z));
  const uint at = atomicAdd(row_count, count);
  for (uint i = 0u; i < count; ++i)
    rows[at + i] = place * LEAF_TRIANGLES + i;
}

void testRow(uint row)
{
  const uvec4 pair = leaf_pairs[row / LEAF_TRIANGLES];
  const uint i = row % LEAF_TRIANGLES;
  const Item item = fetchItem(pair.x);
  const uint first_a = leafFirst(pair.y);
  const uint first_b = leafFirst(pair.z);
  const uint count_a = leafCount(pair.y);
  const uint count_b = leafCount(pair.z);
  const bool a_is_smaller = count_a <= count_b;
  const uint count = max(count_a, count_b);
  for (uint j = 0u; j < count; ++j)
    testTriangles(pair.x, item, first_a + (a_is_smaller ? i : j), first_b + (a_is_smaller ? j : i));
}

// The first `count` of leaf_pairs. Called by all lanes together; returns loop iterations, at most.
uint testLeafPairs(uint count)
{
  uint iterations = 0u;
  for (uint begin = 0u; begin < count; begin += LEAF_CHUNK)
  {
    if (gl_LocalInvocationID.x == 0u)
      row_count = 0u;
    barrier();
    const uint end = min(begin + LEAF_CHUNK, count);
    for (uint place = begin + gl_LocalInvocationID.x; place < end; place += gl_WorkGroupSize.x)
      spreadLeafPair(place);
    barrier();
    const uint todo = row_count;
    for (uint row = gl_LocalInvocationID.x; row < todo; row += gl_WorkGroupSize.x)
      testRow(rows[row]);
    iterations += CHUNK_ITERATIONS * (LEAF_CHUNK / gl_WorkGroupSize.x + 1u) + ROW_ITERATIONS * (todo / gl_WorkGroupSize.x + 1u);
    barrier();
  }
  return iterations;
}
