// With a tolerance or a required distance above 0, a traversal may end early. All contents of a node are within half
// the diagonal of its box from the centre of the box. So the distance of the contents of two nodes is at most the
// distance of the centres plus both half diagonals. If that sum is at most the required distance plus the tolerance, a
// collision may be reported. Overlapping nodes satisfy this when the sum of their diagonals is at most the tolerance.
// Own method: it follows from the triangle inequality.
layout(location = LOCATION_TOLERANCE) uniform float tolerance;  // metres

bool isCloseEnough(uint root_pair_index, RootPair root_pair, OrientedNode a, OrientedNode b)
{
  const vec3 between = vectorBetween(a.box.center, apply(root_pair.pose, b.box.center));
#if SOLIDS
  // Only the solid of a box fills its node. Other solids do not end a traversal early.
  const bool a_is_box =
      isSolidLeaf(a.first) && a.count != 0u && fetchInstance(pairOther(root_pair.pair)).kind == SOLID_BOX;
  const bool b_is_box =
      isSolidLeaf(b.first) && b.count != 0u && fetchInstance(pairRobot(root_pair.pair)).kind == SOLID_BOX;
  const vec3 beyond_a = max(abs(between) - a.box.extent, 0.0);
  const vec3 beyond_b = max(abs(between * root_pair.pose.rotation) - b.box.extent, 0.0);
  const float reach = a_is_box ? length(beyond_a) + length(b.box.extent) :
                      b_is_box ? length(beyond_b) + length(a.box.extent) : 3.4e38;
#else
  const float reach = length(between) + length(a.box.extent) + length(b.box.extent);
#endif
  const float enough = tolerance + (1.0 - 4.0 * u) * fetchDistance(root_pair_index);
  return reach * (1.0 + 16.0 * u) + boxError(root_pair.error) <= enough;
}
