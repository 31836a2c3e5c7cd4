// Two meshes with a required distance above 0 may end their traversal early. All contents of a node are within half the
// diagonal of its box from the centre of the box. So the distance of the contents of two nodes is at most the distance
// of the centres plus both half diagonals. If that sum is at most the required distance, the meshes collide.
// Own method: it follows from the triangle inequality.
bool isCloseEnough(uint root_pair_index, RootPair root_pair, OrientedNode a, OrientedNode b)
{
  const vec3 between = vectorBetween(a.box.center, apply(root_pair.pose, b.box.center));
  const float reach = length(between) + length(a.box.extent) + length(b.box.extent);
  const float enough = (1.0 - 4.0 * u) * fetchDistance(root_pair_index);
  return reach * (1.0 + 16.0 * u) + boxError(root_pair.error) <= enough;
}
