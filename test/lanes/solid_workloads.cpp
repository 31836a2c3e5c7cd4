// Tasks for the shaders that place points against solids: the crossing of a ray and a triangle, the winding number of a
// point, which rests on such crossings, the distance of a triangle and a solid, and the heights of corners above a
// half-space.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <sstream>

#include "collision/exact/exact_checker.h"
#include "collision/gpu/gpu_checker.h"
#include "collision/trees/binned_sah.h"
#include "gpu/program.h"
#include "lanes/workloads.h"
#include "oracle/convex.h"
#include "oracle/quad.h"
#include "shader_constants.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::Quad;

constexpr std::size_t kTriangles = 256;
constexpr std::size_t kPoints = 256;
constexpr std::size_t kStates = 64;

using Texel = std::array<float, 4>;
using Corners = std::array<Texel, 3>;

class Random
{
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator_); }
  Vector3d vector() { return {uniform(-1.0, 1.0), uniform(-1.0, 1.0), uniform(-1.0, 1.0)}; }
  double sign() { return generator_() % 2 == 0 ? 1.0 : -1.0; }

 private:
  std::mt19937_64 generator_;
};

/// The plane or an edge of the triangle passes 1e-10 to 1e-1 of the triangle's size from the origin.
Corners nearOrigin(Random& random)
{
  const double size = std::pow(10.0, random.uniform(-2.0, 2.0));
  const double gap = random.sign() * std::pow(10.0, random.uniform(-10.0, -1.0));
  std::array<Vector3d, 3> corners = {random.vector(), random.vector(), random.vector()};
  const double first = random.uniform(-0.1, 1.0);
  const double second = random.uniform(0.0, 1.0) * (1.0 - first);
  Vector3d foot = corners[0] + first * (corners[1] - corners[0]) + second * (corners[2] - corners[0]);
  if (random.sign() > 0.0)
    foot = corners[0] + first * (corners[1] - corners[0]);
  foot += gap * random.vector();
  Corners rounded;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const Vector3d corner = size * (corners[i] - foot);
    rounded[i] = {static_cast<float>(corner.x()), static_cast<float>(corner.y()), static_cast<float>(corner.z()), 0.0F};
  }
  return rounded;
}

/// 1 or -1 if the ray from the origin along +z crosses the triangle, by its direction; 0 if it misses. `touches`: it
/// meets an edge, or begins on the triangle, so that both answers are right.
int exactCrossing(const Corners& c, bool& touches)
{
  Quad area[3];
  int positive = 0;
  int negative = 0;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const Texel& next = c[(i + 1) % 3];
    area[i] = Quad(c[i][0]) * next[1] - Quad(c[i][1]) * next[0];
    positive += area[i] > 0 ? 1 : 0;
    negative += area[i] < 0 ? 1 : 0;
  }
  const Quad height = area[1] * c[0][2] + area[2] * c[1][2] + area[0] * c[2][2];
  touches = (positive == 0 || negative == 0) && (positive + negative < 3 || height == 0);
  if (positive == 3)
    return height > 0 ? 1 : 0;
  return negative == 3 && height < 0 ? -1 : 0;
}

/// With g++ 12 -O3, a plain conversion of two neighbours to float and back does nothing.
float roundedNumber(double x)
{
  const volatile auto nearest = static_cast<float>(x);
  return nearest;
}

Texel rounded(const Vector3d& v)
{
  return {roundedNumber(v.x()), roundedNumber(v.y()), roundedNumber(v.z()), 0.0F};
}

/// A tetrahedron, and a point 1e-8 to 1e-1 of its size from one of its faces or edges. The distance of both from the
/// origin is 1 to 1e5 times the size.
struct Solid
{
  Corners face(std::size_t i) const
  {
    static constexpr std::size_t kFaces[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    return {corners[kFaces[i][0]], corners[kFaces[i][1]], corners[kFaces[i][2]]};
  }
  std::array<Texel, 4> corners;
  Texel point;
};

Solid farSolid(Random& random)
{
  const double size = std::pow(10.0, random.uniform(-2.0, 1.0));
  const Vector3d place = size * std::pow(10.0, random.uniform(0.0, 5.0)) * random.vector();
  std::array<Vector3d, 4> corners;
  for (Vector3d& corner : corners)
    corner = random.vector();
  const double first = random.uniform(0.0, 1.0);
  const double second = random.sign() > 0.0 ? random.uniform(0.0, 1.0 - first) : 0.0;
  const Vector3d foot = corners[0] + first * (corners[1] - corners[0]) + second * (corners[2] - corners[0]);
  Solid solid;
  for (std::size_t i = 0; i < 4; ++i)
    solid.corners[i] = rounded(place + size * corners[i]);
  solid.point = rounded(place + size * (foot + std::pow(10.0, random.uniform(-8.0, -1.0)) * random.vector()));
  return solid;
}

/// Six times the signed volume that a point spans with a triangle.
Quad volumeOf(const Corners& c, const Texel& point)
{
  const auto d = [&](std::size_t corner, std::size_t axis) { return Quad(c[corner][axis]) - point[axis]; };
  Quad sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    sum += d(0, i) * (d(1, j) * d(2, k) - d(1, k) * d(2, j));
  }
  return sum;
}

/// 1 if the point is in the solid, -1 if it is outside, 0 if it is in the plane of a face.
int exactPlace(const Solid& solid)
{
  int positive = 0;
  int negative = 0;
  for (std::size_t i = 0; i < 4; ++i)
  {
    const Quad volume = volumeOf(solid.face(i), solid.point);
    positive += volume > 0 ? 1 : 0;
    negative += volume < 0 ? 1 : 0;
  }
  if (positive + negative < 4)
    return 0;
  return positive == 4 || negative == 4 ? 1 : -1;
}
}  // namespace

std::vector<std::string> checkCrossings(const std::string& shaders, std::uint64_t seed)
{
  Random random(seed);
  std::vector<Corners> triangles;
  std::vector<Texel> values;
  for (std::size_t i = 0; i < kTriangles; ++i)
  {
    triangles.push_back(nearOrigin(random));
    values.insert(values.end(), triangles.back().begin(), triangles.back().end());
  }
  const Program program = Program::fromText(shaders, "crossings", R"(// One invocation per triangle: its crossing.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "geometry/pose.glsl"
#include "problem/nodes.glsl"
#include "problem/triangles.glsl"
#include "geometry/error_bounds.glsl"
#include "geometry/winding_number.glsl"
layout(std430, binding = BINDING_C) readonly buffer Values { vec4 values[]; };
layout(std430, binding = BINDING_D) writeonly buffer Results { vec4 results[]; };
void main()
{
  const uint first = 3u * invocationIndex();
  vec3 corners[3];
  for (uint i = 0u; i < 3u; ++i)
    corners[i] = values[first + i].xyz;
  results[invocationIndex()] = vec4(float(crossing(corners, 0.0)), 0.0, 0.0, 0.0);
}
)");
  Buffer input(values.size() * sizeof(Texel));
  input.write(values);
  Buffer output(kTriangles * sizeof(Texel));
  input.bindStorage(BINDING_C);
  output.bindStorage(BINDING_D);
  program.dispatch(groupsFor(kTriangles));
  std::vector<Texel> results(kTriangles);
  output.read(results.data(), results.size() * sizeof(Texel));
  constexpr float kUncertain = 1000.0F;  // UNCERTAIN_CROSSING
  std::vector<std::string> wrong;
  for (std::size_t i = 0; i < kTriangles; ++i)
  {
    bool touches = false;
    const int exact = exactCrossing(triangles[i], touches);
    const float found = results[i][0];
    if (found != kUncertain && !touches && found != static_cast<float>(exact))
    {
      std::ostringstream line;
      line << "triangle " << i << " has the crossing " << found << ", not " << exact;
      wrong.push_back(line.str());
    }
  }
  return wrong;
}

std::vector<std::string> checkContainment(const std::string& shaders, std::uint64_t seed)
{
  Random random(seed);
  std::vector<Solid> solids;
  std::vector<Texel> points;
  std::vector<Texel> triangles;
  std::vector<std::array<std::uint32_t, 4>> nodes;
  std::vector<std::uint32_t> leaf_order;
  for (std::uint32_t i = 0; i < kPoints; ++i)
  {
    const Solid solid = farSolid(random);
    solids.push_back(solid);
    points.push_back(solid.point);
    // The tree of the solid is one leaf, whose box is larger than needed.
    std::array<std::uint32_t, 4> texels[2] = {{0, 0, 0, 4 * i}, {0, 0, 0, 4}};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const auto [low, high] =
          std::minmax({solid.corners[0][axis], solid.corners[1][axis], solid.corners[2][axis], solid.corners[3][axis]});
      const float center = (low + high) / 2.0F;
      const float extent = (high - low) * 0.6F + std::abs(center) * 1e-6F;
      std::memcpy(&texels[0][axis], &center, sizeof(center));
      std::memcpy(&texels[1][axis], &extent, sizeof(extent));
    }
    nodes.insert(nodes.end(), texels, texels + 2);
    for (std::uint32_t face = 0; face < 4; ++face)
    {
      const Corners corners = solid.face(face);
      triangles.insert(triangles.end(), corners.begin(), corners.end());
      leaf_order.push_back(4 * i + face);
    }
  }
  const Program program = Program::fromText(shaders, "containment", R"(// One invocation per solid: a point's place.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "geometry/pose.glsl"
#include "problem/nodes.glsl"
#include "problem/triangles.glsl"
#include "geometry/error_bounds.glsl"
#include "geometry/winding_number.glsl"
layout(std430, binding = BINDING_C) readonly buffer Values { vec4 values[]; };
layout(std430, binding = BINDING_D) writeonly buffer Results { uint results[]; };
void main()
{
  uint iterations = 100u;
  const uint i = invocationIndex();
  results[i] = insideMesh(i, values[i].xyz, 0.0, iterations);
}
)");
  const auto fill = [](TexelBuffer& buffer, const auto& texels)
  {
    buffer.reserve(texels.size() * TexelBuffer::kTexelBytes);
    buffer.buffer().write(texels);
  };
  TexelBuffer node_texels;
  TexelBuffer triangle_texels;
  fill(node_texels, nodes);
  fill(triangle_texels, triangles);
  node_texels.bindTexture(UNIT_NODES);
  triangle_texels.bindTexture(UNIT_TRIANGLES);
  const auto bound = [](const auto& values, std::uint32_t binding)
  {
    Buffer buffer(values.size() * sizeof(values.front()));
    buffer.write(values);
    buffer.bindStorage(binding);
    return buffer;
  };
  const Buffer order = bound(leaf_order, BINDING_A);
  const Buffer all_count = bound(std::vector<std::uint32_t>(4 * kPoints / ROLES_PER_WORD, 0x55555555U), BINDING_B);
  const Buffer input = bound(points, BINDING_C);
  Buffer output(kPoints * sizeof(std::uint32_t));
  output.bindStorage(BINDING_D);
  program.dispatch(groupsFor(kPoints));
  std::vector<std::uint32_t> results(kPoints);
  output.read(results.data(), results.size() * sizeof(std::uint32_t));
  std::vector<std::string> wrong;
  for (std::size_t i = 0; i < kPoints; ++i)
  {
    const int exact = exactPlace(solids[i]);
    if ((results[i] == STATE_HIT && exact < 0) || (results[i] == 0 && exact > 0))
      wrong.push_back("point " + std::to_string(i) + " is called " + (exact < 0 ? "inside" : "outside"));
  }
  return wrong;
}

namespace
{
/// A triangle and a cube 1e-8 m to 0.1 m from a solid of 0.1 m to 1 m. One triangle in four is a sliver.
struct NearSolid
{
  std::uint32_t kind;
  Texel size;  // as in problem/instances.glsl
  Corners corners;
  oracle::Bounds distance;
  Texel cube;  // its centre, and half its edge length
  oracle::Bounds cube_distance;
};

oracle::Convex convexOf(std::uint32_t kind, const Texel& size)
{
  if (kind == SOLID_BOX)
    return Box{2.0 * Vector3d(size[0], size[1], size[2])};
  if (kind == SOLID_SPHERE)
    return Sphere{size[0]};
  if (kind == SOLID_CYLINDER)
    return Cylinder{size[0], 2.0 * size[2]};
  return Cone{size[0], 2.0 * size[2]};
}

NearSolid nearSolid(Random& random)
{
  NearSolid near;
  near.kind = SOLID_BOX + static_cast<std::uint32_t>(random.uniform(0.0, 4.0));
  near.size = rounded({random.uniform(0.1, 1.0), random.uniform(0.1, 1.0), random.uniform(0.1, 1.0)});
  if (near.kind != SOLID_BOX)
    near.size[1] = near.size[0];
  if (near.kind == SOLID_SPHERE)
    near.size[2] = near.size[0];
  const oracle::Convex solid = convexOf(near.kind, near.size);
  const Vector3d out = random.vector().normalized();
  const Vector3d foot = oracle::farthestPoint(solid, oracle::Vector(out)).toDouble();
  const double gap = std::pow(10.0, random.uniform(-8.0, -1.0));
  const Vector3d first = foot + gap * out;
  near.corners[0] = rounded(first);
  for (std::size_t i = 1; i < 3; ++i)
  {
    const Vector3d edge = random.vector();
    near.corners[i] = rounded(first + edge + (std::abs(edge.dot(out)) - edge.dot(out) + 0.05) * out);
  }
  const auto share = static_cast<float>(std::pow(10.0, random.uniform(-6.0, -0.3)));
  if (random.uniform(0.0, 1.0) < 0.25)
    for (std::size_t axis = 0; axis < 3; ++axis)
      near.corners[2][axis] = near.corners[0][axis] + share * (near.corners[1][axis] - near.corners[0][axis]);
  oracle::Corners corners;
  for (std::size_t i = 0; i < 3; ++i)
    corners.corners[i] = oracle::Vector(Vector3d(near.corners[i][0], near.corners[i][1], near.corners[i][2]));
  near.distance = oracle::convexDistance(corners, {}, solid, {}, Quad(-1), Quad(1e30));
  const auto half = static_cast<float>(std::pow(10.0, random.uniform(-6.0, -2.0)));
  near.cube = rounded(foot + (gap + 2.0 * static_cast<double>(half)) * out);
  near.cube[3] = half;
  oracle::Motion cube_pose;
  cube_pose.translation = oracle::Vector(Vector3d(near.cube[0], near.cube[1], near.cube[2]));
  near.cube_distance = oracle::convexDistance(Box{Vector3d::Constant(2.0 * static_cast<double>(half))}, cube_pose,
                                              solid, {}, Quad(-1), Quad(1e30));
  return near;
}
}  // namespace

std::vector<std::string> checkSolids(const std::string& shaders, std::uint64_t seed)
{
  Random random(seed);
  std::vector<NearSolid> cases;
  std::vector<Texel> values;
  while (cases.size() < kTriangles)
  {
    const NearSolid near = nearSolid(random);
    if (near.distance.lower <= 0 || near.cube_distance.lower <= 0)
      continue;
    cases.push_back(near);
    values.insert(values.end(), near.corners.begin(), near.corners.end());
    values.push_back({near.size[0], near.size[1], near.size[2], static_cast<float>(near.kind)});
    // The required distance is less than the distance of the two, and the gap is not.
    values.push_back({std::nextafter(static_cast<float>(near.distance.lower), 0.0F),
                      std::nextafter(static_cast<float>(near.distance.upper), INFINITY),
                      std::nextafter(static_cast<float>(near.cube_distance.upper), INFINITY), 0.0F});
    values.push_back(near.cube);
  }
  const Program program =
      Program::fromText(shaders, "solids", R"(// One invocation per triangle and box: their verdicts.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "traversal/root_pairs.glsl"
#include "problem/nodes.glsl"
#include "common/counters.glsl"
#include "traversal/verdicts.glsl"
#include "problem/instances.glsl"
#include "traversal/solid_leaf.glsl"
#include "traversal/bounding_volume_overlap.glsl"
#include "traversal/solid_nodes.glsl"
layout(std430, binding = BINDING_C) readonly buffer Values { vec4 values[]; };
layout(std430, binding = BINDING_D) writeonly buffer Results { uvec2 results[]; };
void main()
{
  const uint first = 6u * invocationIndex();
  vec3 corners[3];
  for (uint i = 0u; i < 3u; ++i)
    corners[i] = values[first + i].xyz;
  const vec4 size = values[first + 3u];
  const vec4 lengths = values[first + 4u];
  const Instance solid = Instance(0u, 0.0, 0u, 0u, vec3(0.0), uint(size.w), size.xyz, 0.0);
  const Box box = Box(values[first + 5u].xyz, vec3(values[first + 5u].w));
  const float margin = lengths.z + sizeError(box, Box(vec3(0.0), solid.size));
  const bool beyond = boxBeyondSolid(solid, box.center, mat3(1.0), box.extent, margin);
  results[invocationIndex()] = uvec2(triangleSolid(corners, solid, 0.0, lengths.x, lengths.y), beyond ? 1u : 0u);
}
)");
  Buffer input(values.size() * sizeof(Texel));
  input.write(values);
  std::vector<std::array<std::uint32_t, 2>> results(kTriangles);
  Buffer output(kTriangles * sizeof(results[0]));
  input.bindStorage(BINDING_C);
  output.bindStorage(BINDING_D);
  program.dispatch(groupsFor(kTriangles));
  output.read(results.data(), kTriangles * sizeof(results[0]));
  std::vector<std::string> wrong;
  const auto add = [&](std::size_t i, const char* what, const oracle::Bounds& distance, const char* proven)
  {
    std::ostringstream line;
    line << what << " " << i << " at a distance of " << static_cast<double>(distance.lower)
         << " m from a solid of kind " << cases[i].kind << " is proven to be " << proven;
    wrong.push_back(line.str());
  };
  for (std::size_t i = 0; i < kTriangles; ++i)
  {
    if (results[i][0] == STATE_HIT || results[i][0] == 0)
      add(i, "triangle", cases[i].distance, results[i][0] == 0 ? "farther apart" : "nearer");
    if (results[i][1] != 0)
      add(i, "cube", cases[i].cube_distance, "farther apart");
  }
  return wrong;
}

/// A box on a lift that moves it along the normal of a half-space, up to 300 m from the origin. Its lowest corner is
/// 3e-9 m to 1e-3 m above or below the plane.
std::vector<std::string> checkHalfSpaces(const std::string& shaders, std::uint64_t seed)
{
  Random random(seed);
  const Vector3d normal = random.vector().normalized();
  const Vector3d place = std::pow(10.0, random.uniform(-1.0, 2.5)) * random.vector();
  const double offset = normal.dot(place);
  std::ostringstream xml;
  xml.precision(17);
  xml << R"(<robot name="lift"><link name="base"/><link name="box"/><joint name="rise" type="prismatic">)"
      << R"(<parent link="base"/><child link="box"/><limit lower="-9" upper="9" effort="1" velocity="1"/><axis xyz=")"
      << normal.x() << " " << normal.y() << " " << normal.z() << R"("/><origin xyz=")" << place.x() << " " << place.y()
      << " " << place.z() << R"("/></joint></robot>)";
  const auto robot = RobotModel::fromXml(xml.str(), "", {});
  const auto problem = std::make_shared<CollisionProblem>();
  const Shape box = tessellate(Box{{0.5, 0.4, 0.3}}).mesh;
  problem->tessellations.push_back(tessellate(box));
  problem->shapes.insert(problem->shapes.end(), 1, box);
  const Isometry3d pose(Eigen::AngleAxisd(random.uniform(0.0, 3.0), random.vector().normalized()));
  problem->robot = {{0, 1, 1, pose}};
  problem->half_spaces = {{2, normal, offset, 0.0}};
  problem->half_space_pairs = {1};
  BatchCheckerOptions options;
  options.shader_folder = shaders;
  options.max_batch = kStates;
  GpuChecker checker(options);
  checker.setProblem(problem, robot);

  Isometry3d links[2];
  const double zero = 0.0;
  robot->linkPoses(&zero, links);
  double lowest = INFINITY;
  for (const Vector3d& vertex : problem->tessellations[0].mesh->vertices)
    lowest = std::min(lowest, normal.dot(links[1] * pose * vertex) - offset);
  std::vector<double> states;
  for (std::size_t i = 0; i < kStates; ++i)
    states.push_back(random.sign() * std::pow(10.0, random.uniform(-8.5, -3.0)) - lowest);
  BatchResult result;
  checker.check(states.data(), kStates, result);
  const ExactChecker exact(problem, std::make_shared<const Forest>(buildBinnedSah(problem->tessellations)));
  ExactChecker::Scratch scratch;
  std::vector<std::string> wrong;
  for (std::size_t i = 0; i < kStates; ++i)
  {
    robot->linkPoses(&states[i], links);
    if ((result.valid[i] != 0) == !exact.firstCollision(links, scratch))
      continue;
    std::ostringstream line;
    line << "a box " << states[i] + lowest << " m above a half-space is called "
         << (result.valid[i] != 0 ? "free" : "a collision");
    wrong.push_back(line.str());
  }
  return wrong;
}
}  // namespace gpu_planning_scene::core
