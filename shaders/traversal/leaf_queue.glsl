// A list of leaf pairs that a work group shares, and the tests of their triangles. Most leaves hold fewer than
// LEAF_TRIANGLES triangles. Each invocation therefore takes one triangle of a pair's smaller leaf and tests it against
// the larger leaf. In the programs for solids, it takes one triangle and tests it against the solid. Own method: an
// invocation that tested its own leaves would leave the others waiting.
#include "traversal/leaf_pair.glsl"
#if SOLIDS
#include "traversal/solid_leaf.glsl"
#endif

shared uvec4 leaf_pairs[LEAF_QUEUE];  // x: the root pair; y, z: the two leaves, as leafReference() packs them
shared uint leaf_pair_count;
shared uint row_count;
shared uint rows[LEAF_CHUNK * LEAF_TRIANGLES];  // LEAF_TRIANGLES * place in leaf_pairs + triangle of one leaf

// Upper bounds on the loop iterations for a chunk of leaf pairs, and for a row.
#define CHUNK_ITERATIONS (4u + 2u * LEAF_TRIANGLES)
#if SOLIDS
#define ROW_ITERATIONS (2u * SOLID_ITERATIONS)
#else
#define ROW_ITERATIONS ((32u + 20u * PADDED) * LEAF_TRIANGLES)
#endif

void addRows(uint place)
{
  const uvec4 pair = leaf_pairs[place];
  const uint count_a = leafCount(pair.y);
  const uint count_b = leafCount(pair.z);
  const uint most = SOLIDS != 0 ? max(count_a, count_b) : min(count_a, count_b);
  const uint count = isDecided(fetchState(pair.x)) ? 0u : most;
  const uint at = atomicAdd(row_count, count);
  for (uint i = 0u; i < count; ++i)
    rows[at + i] = place * LEAF_TRIANGLES + i;
}

// Tests the first `count` of leaf_pairs. All invocations of the work group call it together. Returns an upper bound on
// its loop iterations.
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
      addRows(place);
    barrier();
    const uint todo = row_count;
    for (uint k = gl_LocalInvocationID.x; k < todo; k += gl_WorkGroupSize.x)
    {
      const uint row = rows[k];
#if SOLIDS
      testSolidRow(leaf_pairs[row / LEAF_TRIANGLES], row % LEAF_TRIANGLES);
#else
      testLeafRow(leaf_pairs[row / LEAF_TRIANGLES], row % LEAF_TRIANGLES);
#endif
    }
    iterations += CHUNK_ITERATIONS * (LEAF_CHUNK / gl_WorkGroupSize.x + 1u) +
                  ROW_ITERATIONS * (todo / gl_WorkGroupSize.x + 1u);
    barrier();
  }
  return iterations;
}
