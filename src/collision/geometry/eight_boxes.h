#pragma once

#include "collision/geometry/eight_floats.h"

// The 15 possible separating axes of two oriented boxes, for eight pairs of boxes side by side (S. Gottschalk, M. Lin,
// D. Manocha: OBBTree. SIGGRAPH 1996). The half extents of one side may be equal in all pairs: a float each.
namespace gpu_planning_scene::core
{
namespace
{
/// The second boxes in the frames of the first ones.
struct EightBoxPairs
{
  Floats axes[3][3];        // [i][j]: component i of axis j
  Floats magnitudes[3][3];  // of the components, with an allowance for edges that are nearly parallel
  Floats between[3];        // from the first centres to the second ones

  /// The pairs that an axis of a first box separates, or one of a second box. A comparison with NaN separates nothing.
  template <class HalfA, class HalfB>
  Ints apartByFaces(const HalfA* a, const HalfB* b) const
  {
    Ints apart = {};
    for (int i = 0; i < 3; ++i)
      apart |=
          magnitude(between[i]) > a[i] + (magnitudes[i][0] * b[0] + magnitudes[i][1] * b[1] + magnitudes[i][2] * b[2]);
    for (int j = 0; j < 3; ++j)
      apart |= magnitude(along(j)) > a[0] * magnitudes[0][j] + a[1] * magnitudes[1][j] + a[2] * magnitudes[2][j] + b[j];
    return apart;
  }

  /// The pairs that the cross product of two edges separates.
  template <class HalfA, class HalfB>
  Ints apartByEdges(const HalfA* a, const HalfB* b) const
  {
    Ints apart = {};
    for (int i = 0; i < 3; ++i)
    {
      const int i1 = (i + 1) % 3;
      const int i2 = (i + 2) % 3;
      for (int j = 0; j < 3; ++j)
      {
        const int j1 = (j + 1) % 3;
        const int j2 = (j + 2) % 3;
        apart |= magnitude(between[i2] * axes[i1][j] - between[i1] * axes[i2][j]) >
                 a[i1] * magnitudes[i2][j] + a[i2] * magnitudes[i1][j] + b[j1] * magnitudes[i][j2] +
                     b[j2] * magnitudes[i][j1];
      }
    }
    return apart;
  }

  /// The vectors between the centres along axis j of the second boxes.
  Floats along(int j) const { return between[0] * axes[0][j] + between[1] * axes[1][j] + between[2] * axes[2][j]; }
};
}  // namespace
}  // namespace gpu_planning_scene::core
