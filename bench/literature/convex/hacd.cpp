#include "literature/convex/hacd.h"

#include <HACD/hacdHACD.h>

#include "gpu_planning_scene/error.h"
#include "literature/convex/hull_method.h"
#include "literature/shared_tree.h"

// K. Mamou, F. Ghorbel: A simple and efficient approach for 3D mesh approximate convex decomposition, 2009; the library
// HACD of Bullet's extras. The use is that of the comments of HACD/hacdHACD.h: points and triangles are set, then the
// weights, the least number of clusters, the largest concavity and the number of vertices of a hull; Compute; and GetCH
// for each cluster. The points are scaled to a cube of 1000, so a concavity of kConcavity is 1 % of the size. The
// weights are those of Bullet's demo. Domain: closed meshes, up to the concavity. A hull fills hollows of its piece, so
// there are false hits. Containment is found, because the hulls are solids.
namespace gpu_planning_scene::core::literature
{
namespace
{
constexpr std::size_t kMostTriangles = 5000;
constexpr double kConcavity = 10.0;

class HacdTree : public HullTree
{
 public:
  explicit HacdTree(const Mesh& mesh) : HullTree(piecesOf(mesh)) {}

 private:
  static std::vector<Piece> piecesOf(const Mesh& mesh)
  {
    if (mesh.triangles.size() > kMostTriangles)
      throw Error("HACD's decomposition of " + std::to_string(mesh.triangles.size()) +
                  " triangles takes too long; use at most " + std::to_string(kMostTriangles));
    std::vector<HACD::Vec3<HACD::Real>> points;
    for (const Eigen::Vector3d& vertex : mesh.vertices)
      points.emplace_back(vertex.x(), vertex.y(), vertex.z());
    std::vector<HACD::Vec3<long>> triangles;
    for (const auto& t : mesh.triangles)
      triangles.emplace_back(t[0], t[1], t[2]);
    HACD::HACD hacd;
    hacd.SetPoints(points.data());
    hacd.SetNPoints(points.size());
    hacd.SetTriangles(triangles.data());
    hacd.SetNTriangles(triangles.size());
    hacd.SetCompacityWeight(0.1);
    hacd.SetVolumeWeight(0.0);
    hacd.SetNClusters(1);
    hacd.SetNVerticesPerCH(100);
    hacd.SetConcavity(kConcavity);
    if (!hacd.Compute())
      throw Error("HACD cannot decompose the mesh '" + mesh.name + "'");
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i < hacd.GetNClusters(); ++i)
    {
      std::vector<HACD::Vec3<HACD::Real>> corners(hacd.GetNPointsCH(i));
      std::vector<HACD::Vec3<long>> faces(hacd.GetNTrianglesCH(i));
      hacd.GetCH(i, corners.data(), faces.data());
      pieces.emplace_back();
      for (const auto& corner : corners)
        pieces.back().emplace_back(corner.X(), corner.Y(), corner.Z());
    }
    return pieces;
  }
};
}  // namespace

MethodInfo hacdMethod()
{
  Domain closed;
  closed.open = false;
  closed.containment = true;
  return {"hacd_hulls",
          "HACD's hulls, GJK",
          "Mamou, Ghorbel 2009; Bullet's extras",
          "library",
          closed,
          [](const MeshPtr& a, const MeshPtr& b)
          { return makeHullMethod(sharedTree<HacdTree>(a), sharedTree<HacdTree>(b)); }};
}
}  // namespace gpu_planning_scene::core::literature
