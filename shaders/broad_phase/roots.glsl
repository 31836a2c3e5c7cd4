// The nodes with which the traversal of a pair of instances begins. At most one of the two shapes is tested as a solid.
// The other one is tested by its triangles.

// First node of the primitives, one node an instance. 0: primitives are tested by their triangles.
layout(location = LOCATION_SOLID_NODES) uniform uint solid_nodes;

struct Roots
{
  uint a;
  uint b;
  bool a_is_solid;
  bool b_is_solid;
};

// `other` and `robot`: the numbers of the instances a and b.
Roots rootsOf(uint other, Instance a, uint robot, Instance b)
{
  const bool a_is_solid = solid_nodes != 0u && isPrimitive(a);
  const bool b_is_solid = solid_nodes != 0u && !a_is_solid && isPrimitive(b);
  return Roots(a_is_solid ? solid_nodes + other : a.root, b_is_solid ? solid_nodes + robot : b.root, a_is_solid,
               b_is_solid);
}
