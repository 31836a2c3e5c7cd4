#include "gpu_planning_scene/error.h"
#include "literature/convex/hull_method.h"
#include "literature/convex/surface_patches.h"
#include "literature/shared_tree.h"

// S. A. Ehmann, M. C. Lin: Accurate and fast proximity queries between polyhedra using convex surface decomposition,
// 2001.
//
// Idea: the surface is divided into patches, each of which lies on its own convex hull. Two surfaces collide if two
// of these hulls collide. A binary tree of hulls over the patches leads to the hulls that may collide. Pairs of hulls
// are tested by GJK (hull_method.cpp), in place of the paper's Lin-Canny.
//
// Domain: closed 2-manifolds. The hull of a patch is then a part of the solid.
//
// Failures: at saddles and at the edges of holes, the patches are small, and the tree may have as many leaves as one
// over triangles. Where a mesh is open, the hull of a patch is no part of a solid, so there are false hits. A shape
// deep inside another one touches no hull, so containment is missed, unless the outer shape is one patch. The epsilon
// of libccd, 1e-10, is absolute, so shapes of a micrometre collide too early.
namespace gpu_planning_scene::core::literature
{
namespace
{
constexpr std::size_t kMostTriangles = 100000;

class PatchTree : public HullTree
{
 public:
  explicit PatchTree(const Mesh& mesh) : HullTree(piecesOf(mesh)) {}

 private:
  static std::vector<Piece> piecesOf(const Mesh& mesh)
  {
    if (mesh.triangles.size() > kMostTriangles)
      throw Error("the convex surface decomposition of " + std::to_string(mesh.triangles.size()) +
                  " triangles takes too long; use at most " + std::to_string(kMostTriangles));
    std::vector<Piece> pieces;
    for (const SurfacePatch& patch : convexPatches(mesh))
    {
      pieces.emplace_back();
      for (const std::uint32_t triangle : patch)
        for (const std::uint32_t vertex : mesh.triangles[triangle])
          pieces.back().push_back(mesh.vertices[vertex]);
    }
    return pieces;
  }
};
}  // namespace

std::vector<MethodInfo> convexMethods()
{
  Domain closed;
  closed.open = false;
  return {{"convex_patches", "convex patches, GJK", "Ehmann, Lin 2001", "convex", closed,
           [](const MeshPtr& a, const MeshPtr& b)
           { return makeHullMethod(sharedTree<PatchTree>(a), sharedTree<PatchTree>(b)); }}};
}
}  // namespace gpu_planning_scene::core::literature
