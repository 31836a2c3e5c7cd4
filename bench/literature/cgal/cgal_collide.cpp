// cgal_collide: the collision detection of CGAL for the program literature. CGAL's package is under the GPL, so this is
// a program of its own: nothing else of this project includes or links it. It talks to literature by pipes, in the byte
// order of the machine:
//   standard input: twice a mesh (number of vertices, number of triangles, coordinates, corners), then any number of
//     queries (number of poses, and for each pose the 3 x 4 matrix of b in the frame of a, row by row)
//   standard output: the byte 1 after the meshes, or 0 if CGAL cannot take one of them; then one byte a pose
// The use is that of the comments of CGAL/Rigid_triangle_mesh_collision_detection.h: add_mesh, set_transformation, and
// get_all_intersections_and_inclusions, which finds containment, too.

#include <array>
#include <cstdint>
#include <iostream>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Rigid_triangle_mesh_collision_detection.h>
#include <CGAL/Surface_mesh.h>

namespace
{
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Soup = std::vector<std::vector<std::size_t>>;

template <class Value>
bool read(Value& value)
{
  return static_cast<bool>(std::cin.read(reinterpret_cast<char*>(&value), sizeof value));
}

/// Returns false if the input ends.
bool readMesh(std::vector<Kernel::Point_3>& points, Soup& triangles)
{
  std::uint64_t vertex_count = 0;
  std::uint64_t triangle_count = 0;
  if (!read(vertex_count) || !read(triangle_count))
    return false;
  for (std::uint64_t i = 0; i < vertex_count; ++i)
  {
    std::array<double, 3> p{};
    if (!read(p))
      return false;
    points.emplace_back(p[0], p[1], p[2]);
  }
  for (std::uint64_t i = 0; i < triangle_count; ++i)
  {
    std::array<std::uint32_t, 3> t{};
    if (!read(t))
      return false;
    triangles.push_back({t[0], t[1], t[2]});
  }
  return true;
}

Kernel::Aff_transformation_3 transformation(const std::array<double, 12>& m)
{
  return {m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10], m[11]};
}

void answer(bool yes)
{
  std::cout.put(yes ? '\1' : '\0');
}
}  // namespace

int main()
{
  std::array<SurfaceMesh, 2> meshes;
  for (SurfaceMesh& mesh : meshes)
  {
    std::vector<Kernel::Point_3> points;
    Soup triangles;
    if (!readMesh(points, triangles))
      return 1;
    if (!CGAL::Polygon_mesh_processing::is_polygon_soup_a_polygon_mesh(triangles))
    {
      answer(false);
      return 0;
    }
    CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(points, triangles, mesh);
  }
  CGAL::Rigid_triangle_mesh_collision_detection<SurfaceMesh> detection;
  const std::size_t a = detection.add_mesh(meshes[0]);
  const std::size_t b = detection.add_mesh(meshes[1]);
  answer(true);
  std::cout.flush();
  for (std::uint64_t count = 0; read(count);)
  {
    for (std::uint64_t i = 0; i < count; ++i)
    {
      std::array<double, 12> pose{};
      if (!read(pose))
        return 1;
      detection.set_transformation(b, transformation(pose));
      answer(!detection.get_all_intersections_and_inclusions(a).empty());
    }
    std::cout.flush();
  }
  return 0;
}
