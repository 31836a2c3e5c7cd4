#include "oracle/prepared_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gpu_planning_scene::core::oracle
{
namespace
{
constexpr double kSlack = 1e-14;  // relative error bound for about 50 roundings
constexpr double kPi = 3.14159265358979323846;

BoundingBox outwardBox(const Eigen::AlignedBox3d& box)
{
  const Eigen::Vector3d center = box.center();
  const Eigen::Vector3d half = (box.max() - center).cwiseMax(center - box.min());
  return {center, half + kSlack * (half + center.cwiseAbs())};
}

/// Numbers the positions of the vertices. Vertices at equal positions have equal numbers.
std::vector<std::uint32_t> placesOf(const std::vector<Eigen::Vector3d>& vertices)
{
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto before = [&](std::uint32_t a, std::uint32_t b)
  {
    return std::lexicographical_compare(vertices[a].data(), vertices[a].data() + 3, vertices[b].data(),
                                        vertices[b].data() + 3);
  };
  std::sort(order.begin(), order.end(), before);
  std::vector<std::uint32_t> places(vertices.size());
  std::uint32_t place = 0;
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    if (i > 0 && before(order[i - 1], order[i]))
      ++place;
    places[order[i]] = place;
  }
  return places;
}

/// The solid angle that a triangle subtends at the origin, after van Oosterom and Strackee (1983). It is twice the
/// angle of the vector (denominator, numerator).
struct HalfAngle
{
  double numerator;
  double denominator;
};

HalfAngle solidAngle(const Vector& a, const Vector& b, const Vector& c)
{
  const Quad length_a = length(a);
  const Quad length_b = length(b);
  const Quad length_c = length(c);
  const Quad numerator = dot(a, cross(b, c));
  const Quad denominator =
      length_a * length_b * length_c + dot(a, b) * length_c + dot(b, c) * length_a + dot(c, a) * length_b;
  return {static_cast<double>(numerator), static_cast<double>(denominator)};
}
/// The sum of the solid angles of triangles around a point.
double angleOf(const std::vector<TriangleCorners>& triangles, const Vector& point)
{
  double angle = 0.0;
  for (const TriangleCorners& corners : triangles)
  {
    std::array<Eigen::Vector3d, 3> d;
    for (int i = 0; i < 3; ++i)
      d[i] = (Vector(corners[i]) - point).toDouble();
    const double a = d[0].norm();
    const double b = d[1].norm();
    const double c = d[2].norm();
    HalfAngle half = {d[0].dot(d[1].cross(d[2])),
                      a * b * c + d[0].dot(d[1]) * c + d[1].dot(d[2]) * a + d[2].dot(d[0]) * b};
    // Near the triangle both terms cancel. The sign of the numerator then decides between two angles 4 pi apart, so
    // both terms are computed in quadruple precision.
    if (std::abs(half.numerator) <= 1e-8 * a * b * c && half.denominator <= 1e-8 * a * b * c)
      half = solidAngle(Vector(corners[0]) - point, Vector(corners[1]) - point, Vector(corners[2]) - point);
    angle += 2.0 * std::atan2(half.numerator, half.denominator);
  }
  return angle;
}

/// Whether most of several rays from a point cross an odd number of triangles.
bool crossesAnOddNumber(const std::vector<TriangleCorners>& triangles, const Eigen::Vector3d& point)
{
  constexpr int kRays = 9;
  int odd = 0;
  for (int ray = 0; ray < kRays && !triangles.empty(); ++ray)
  {
    const Eigen::Vector3d along(std::cos(1.7 + 2.3 * ray), std::sin(0.4 + 1.9 * ray), std::cos(0.3 + 1.1 * ray));
    bool is_odd = false;
    for (const TriangleCorners& t : triangles)
    {
      Eigen::Matrix3d columns;
      columns << t[1] - t[0], t[2] - t[0], -along;
      const Eigen::Vector3d at = columns.fullPivLu().solve(point - t[0]);
      is_odd = is_odd != (at.x() >= 0.0 && at.y() >= 0.0 && at.x() + at.y() <= 1.0 && at.z() > 0.0);
    }
    odd += is_odd ? 1 : 0;
  }
  return 2 * odd > kRays;
}
}  // namespace

double leastDistance(const BoundingBox& a, const BoundingBox& b, const Eigen::Isometry3d& b_in_a)
{
  const Eigen::Matrix3d& rotation = b_in_a.linear();
  const Eigen::Vector3d between = b_in_a * b.center - a.center;
  const Eigen::Vector3d in_a = between.cwiseAbs() - a.half - rotation.cwiseAbs() * b.half;
  const Eigen::Vector3d in_b =
      (rotation.transpose() * between).cwiseAbs() - b.half - rotation.cwiseAbs().transpose() * a.half;
  const double slack =
      kSlack * (a.center.norm() + b.center.norm() + b_in_a.translation().norm() + a.half.norm() + b.half.norm());
  return std::max(in_a.cwiseMax(0.0).norm(), in_b.cwiseMax(0.0).norm()) - slack;
}

PreparedMesh::PreparedMesh(const SolidMesh& solid)
{
  const Mesh& mesh = *solid.mesh;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const auto& t : mesh.triangles)
  {
    const auto corner = [&](int i) { return mesh.vertices[t[i]]; };
    triangles_.emplace_back(std::array<Vector, 3>{Vector(corner(0)), Vector(corner(1)), Vector(corner(2))});
    corners_.push_back({corner(0), corner(1), corner(2)});
    Eigen::AlignedBox3d box(corner(0));
    boxes.push_back(box.extend(corner(1)).extend(corner(2)));
  }
  std::vector<std::uint32_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0U);
  nodes_.reserve(2 * order.size());
  nodes_.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(order.size()), order, boxes);
  findComponents(solid);
}

void PreparedMesh::build(std::uint32_t node, std::uint32_t begin, std::uint32_t end, std::vector<std::uint32_t>& order,
                         const std::vector<Eigen::AlignedBox3d>& boxes)
{
  Eigen::AlignedBox3d whole;
  Eigen::AlignedBox3d centers;
  for (std::uint32_t i = begin; i < end; ++i)
  {
    whole.extend(boxes[order[i]]);
    centers.extend(boxes[order[i]].center());
  }
  nodes_[node].box = outwardBox(whole);
  if (end - begin == 1)
  {
    nodes_[node].triangle = order[begin];
    return;
  }
  int axis;
  centers.sizes().maxCoeff(&axis);
  const std::uint32_t middle = (begin + end) / 2;
  std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) { return boxes[a].center()[axis] < boxes[b].center()[axis]; });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].child = child;
  nodes_.emplace_back();
  nodes_.emplace_back();
  build(child, begin, middle, order, boxes);
  build(child + 1, middle, end, order, boxes);
}

void PreparedMesh::findComponents(const SolidMesh& solid)
{
  const Mesh& mesh = *solid.mesh;
  const std::vector<std::uint32_t> places = placesOf(mesh.vertices);
  const std::size_t count = mesh.triangles.size();
  std::vector<std::vector<std::uint32_t>> triangles_at(mesh.vertices.size());
  for (std::size_t t = 0; t < count; ++t)
    for (const std::uint32_t vertex : mesh.triangles[t])
      triangles_at[places[vertex]].push_back(static_cast<std::uint32_t>(t));
  std::vector<bool> seen(count, false);
  for (std::size_t start = 0; start < count; ++start)
  {
    if (seen[start])
      continue;
    component_points_.push_back(mesh.vertices[mesh.triangles[start][0]]);
    std::vector<std::uint32_t> component = {static_cast<std::uint32_t>(start)};
    seen[start] = true;
    for (std::size_t next = 0; next < component.size(); ++next)
      for (const std::uint32_t vertex : mesh.triangles[component[next]])
        for (const std::uint32_t t : triangles_at[places[vertex]])
        {
          if (!seen[t])
            component.push_back(t);
          seen[t] = true;
        }
  }
  for (std::size_t t = 0; t < count; ++t)
  {
    if (solid.roles[t] == TriangleRole::Surface)
      continue;
    const auto& vertices = mesh.triangles[t];
    std::vector<TriangleCorners>& corners =
        solid.roles[t] == TriangleRole::Winding ? winding_triangles_ : parity_triangles_;
    corners.push_back({mesh.vertices[vertices[0]], mesh.vertices[vertices[1]], mesh.vertices[vertices[2]]});
    for (const Eigen::Vector3d& corner : corners.back())
      solid_box_.extend(corner);
  }
}

bool PreparedMesh::solidContains(const Vector& point) const
{
  const Eigen::Vector3d rounded = point.toDouble();
  if (!hasSolid() || solid_box_.exteriorDistance(rounded) > kSlack * rounded.norm())
    return false;
  return std::abs(angleOf(winding_triangles_, point)) > 2.0 * kPi ||  // each winding adds 4 pi
         crossesAnOddNumber(parity_triangles_, rounded);
}
}  // namespace gpu_planning_scene::core::oracle
