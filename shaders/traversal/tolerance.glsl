// Where a traversal may end, with a tolerance above 0. All that a node holds is within half its box's diagonal of the box's
// centre, so two nodes hold points of the two shapes that are no further apart than their centres and those two halves: if
// that is at most the required distance and the tolerance, a collision is no false one. Nodes that overlap are that close
// where their diagonals add up to the tolerance.
layout(location = LOCATION_TOLERANCE) uniform float tolerance;  // metres

bool isCloseEnough(uint root_pair_index, RootPair root_pair, OrientedNode a, OrientedNode b)
{
  const vec3 between = apply(root_pair.pose, b.box.center) - a.box.center;
#if SOLIDS
  // A solid is all that its box is, or it has no such nodes.
  const bool a_is_box = isSolidLeaf(a.first) && a.count != 0u && fetchInstance(pairOther(root_pair.pair)).kind == SOLID_BOX;
  const bool b_is_box = isSolidLeaf(b.first) && b.count != 0u && fetchInstance(pairRobot(root_pair.pair)).kind == SOLID_BOX;
  const vec3 beyond_a = max(abs(between) - a.box.extent, 0.0);
  const vec3 beyond_b = max(abs(between * root_pair.pose.rotation) - b.box.extent, 0.0);
  const float reach = a_is_box ? length(beyond_a) + length(b.box.extent) :
                      b_is_box ? length(beyond_b) + length(a.box.extent) : 3.4e38;
#else
  const float reach = length(between) + length(a.box.extent) + length(b.box.extent);
#endif
  return reach * (1.0 + 16.0 * u) + boxError(root_pair.error) <= tolerance + fetchDistance(root_pair_index);
}
