#include "collision/geometry/exact_orientation.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

// The only file that includes CGAL. It uses CGAL's kernel (LGPL, headers only), which filters by interval arithmetic
// (H. Broennimann, C. Burnikel, S. Pion: Interval arithmetic yields efficient dynamic filters for computational
// geometry, 2001). This arithmetic needs the option -frounding-math.
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
