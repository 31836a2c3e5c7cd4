// Which of two overlapping nodes is taken apart: an inner node beats a leaf, of two inner nodes the larger one goes.
bool descendsIntoA(TreeNode a, TreeNode b)
{
  return a.count == 0u && (b.count != 0u || boxSize(a.box) >= boxSize(b.box));
}
