#include "literature/image_space/triangle_survivors.h"

#include <algorithm>

#include "collision/geometry/triangle_pair.h"

// Sweep and prune along x finds the pairs of triangles whose boxes overlap (Cohen, Lin, Manocha, Ponamgi, "I-COLLIDE",
// 1995).
namespace gpu_planning_scene::core::literature
{
namespace
{
struct BoxedTriangle
{
  Triangle corners;
  Eigen::AlignedBox3d box;
};

std::vector<BoxedTriangle> boxedTriangles(const Mesh& mesh, const std::vector<std::uint32_t>& chosen,
                                          const Eigen::Isometry3d& pose)
{
  std::vector<BoxedTriangle> triangles;
  for (const std::uint32_t index : chosen)
  {
    BoxedTriangle triangle;
    for (std::size_t i = 0; i < 3; ++i)
    {
      triangle.corners[i] = pose * mesh.vertices[mesh.triangles[index][i]];
      triangle.box.extend(triangle.corners[i]);
    }
    triangle.box.min().array() -= kSlack;
    triangle.box.max().array() += kSlack;
    triangles.push_back(triangle);
  }
  std::sort(triangles.begin(), triangles.end(),
            [](const BoxedTriangle& first, const BoxedTriangle& second)
            { return first.box.min().x() < second.box.min().x(); });
  return triangles;
}
}  // namespace

bool TriangleSurvivors::collide(const Mesh& a, const std::vector<std::uint32_t>& in_a, const Mesh& b,
                                const std::vector<std::uint32_t>& in_b, const Eigen::Isometry3d& b_in_a)
{
  const std::vector<BoxedTriangle> first = boxedTriangles(a, in_a, Eigen::Isometry3d::Identity());
  const std::vector<BoxedTriangle> second = boxedTriangles(b, in_b, b_in_a);
  const auto meet = [this](const BoxedTriangle& p, const BoxedTriangle& q)
  {
    if (!p.box.intersects(q.box))
      return false;
    tests_ += 1.0;
    return trianglesWithin(p.corners, q.corners, 0.0);
  };
  // Of two boxes that overlap along x, one begins within the other. The box that begins later meets the earlier one
  // here.
  auto p = first.begin();
  auto q = second.begin();
  while (p != first.end() && q != second.end())
    if (p->box.min().x() <= q->box.min().x())
    {
      for (auto other = q; other != second.end() && other->box.min().x() <= p->box.max().x(); ++other)
        if (meet(*p, *other))
          return true;
      ++p;
    }
    else
    {
      for (auto other = p; other != first.end() && other->box.min().x() <= q->box.max().x(); ++other)
        if (meet(*other, *q))
          return true;
      ++q;
    }
  return false;
}
}  // namespace gpu_planning_scene::core::literature
