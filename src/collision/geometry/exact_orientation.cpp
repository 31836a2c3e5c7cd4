// The only file that sees CGAL, of which it takes the kernel (LGPL, headers only). It is compiled with -frounding-math,
// which the kernel's interval arithmetic needs.
#include "collision/geometry/exact_orientation.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace gpu_planning_scene::core
{
int exactOrientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                     const Eigen::Vector3d& d)
{
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  const auto point = [](const Eigen::Vector3d& p) { return Point(p.x(), p.y(), p.z()); };
  return static_cast<int>(CGAL::orientation(point(a), point(b), point(c), point(d)));
}
}  // namespace gpu_planning_scene::core
