// Single steps of the shaders, compared with C++ in double: proofs must be true, and undecided results must be rare.

#include <array>
#include <cmath>
#include <cstring>
#include <iostream>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "collision/geometry/cpu_box_pair.h"
#include "collision/geometry/primitive_solid.h"
#include "collision/geometry/triangle_pair.h"
#include "gpu/egl_context.h"
#include "gpu/program.h"
#include "shader_constants.h"
#include "support/seed.h"
#include "support/shader_folder.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

/// Declarations for tests of two nodes, each in a tree with a pose.
const char* const kPlacedNodes = R"(
#include "geometry/pose.glsl"
#include "traversal/root_pairs.glsl"
#include "problem/nodes.glsl"
#include "geometry/error_bounds.glsl"
#include "problem/instances.glsl"
#include "traversal/bounding_volume_overlap.glsl"
#include "traversal/solid_nodes.glsl"
OrientedNode node(vec3 center, vec3 extent, vec3 xyz, vec3 w)
{
  return OrientedNode(Box(center, extent), rotationOf(vec4(xyz, w.x)), 0u, 1u);
}
float errorOf(OrientedNode a, Pose pose_a, OrientedNode b, Pose pose_b, Pose pose)
{
  return positionError(pose_a, pose_b, pose, abs(a.box.center) + length(a.box.extent),
                       abs(b.box.center) + length(b.box.extent));
}
)";

std::string vectorAt(int place)
{
  return "at(" + std::to_string(place) + "u)";
}

/// GLSL of a node, or of a pose by its rows, from four vectors of the case's input that begin at `place`.
std::string nodeAt(int place)
{
  return "node(" + vectorAt(place) + ", " + vectorAt(place + 1) + ", " + vectorAt(place + 2) + ", " +
         vectorAt(place + 3) + ")";
}

std::string poseAt(int place)
{
  return "Pose(transpose(mat3(" + vectorAt(place) + ", " + vectorAt(place + 1) + ", " + vectorAt(place + 2) + ")), " +
         vectorAt(place + 3) + ")";
}

/// Runs one function of the shaders on floats, with one invocation for each case.
class GpuStep : public testing::Test
{
 protected:
  std::vector<std::uint32_t> run(const std::string& includes, const std::string& call, const std::vector<float>& input,
                                 std::size_t floats_per_case)
  {
    folder_.write("step.comp",
                  "#include \"shader_constants.h\"\nlayout(local_size_x = GROUP_SIZE) in;\n#include "
                  "\"common/invocation.glsl\"\n" +
                      includes +
                      "layout(location = LOCATION_CASE_COUNT) uniform uint case_count;\n"
                      "layout(std430, binding = 0) readonly buffer Input { float data[]; };\n"
                      "layout(std430, binding = 1) writeonly buffer Output { uint result[]; };\n"
                      "uint base = 0u;\n"
                      "vec3 at(uint i) { return vec3(data[base + 3u * i], data[base + 3u * i + 1u], data[base + 3u * i "
                      "+ 2u]); }\n"
                      "void main() { const uint i = invocationIndex(); if (i >= case_count) return; base = i * " +
                      std::to_string(floats_per_case) + "u; result[i] = " + call + "; }\n");
    const std::size_t cases = input.size() / floats_per_case;
    Buffer in(input.size() * sizeof(float));
    in.write(input);
    Buffer out(cases * sizeof(std::uint32_t));
    in.bindStorage(0);
    out.bindStorage(1);
    const Program program(folder_.path(), "step.comp");
    program.set(LOCATION_CASE_COUNT, static_cast<std::uint32_t>(cases));
    program.dispatch((cases + GROUP_SIZE - 1) / GROUP_SIZE);
    std::vector<std::uint32_t> result(cases);
    out.read(result.data(), cases * sizeof(std::uint32_t));
    return result;
  }

  Vector3d anyVector(double size)
  {
    return size * Vector3d(uniform_(generator_), uniform_(generator_), uniform_(generator_));
  }
  Eigen::Matrix3d anyRotation()
  {
    std::normal_distribution<double> normal;
    return Eigen::Quaterniond(normal(generator_), normal(generator_), normal(generator_), normal(generator_))
        .normalized()
        .toRotationMatrix();
  }
  /// Rounds a vector to float32, appends it to the input, and returns it.
  static Vector3d put(const Vector3d& v, std::vector<float>& into)
  {
    const Eigen::Vector3f rounded = v.cast<float>();
    into.insert(into.end(), rounded.data(), rounded.data() + 3);
    return rounded.cast<double>();
  }

  EglContext context_{"auto"};
  ShaderFolder folder_;
  std::mt19937_64 generator_{kSeed};
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
};

using Triangles = std::array<Triangle, 2>;

/// Appends error and slack to each pair of triangles.
std::vector<float> withBounds(const std::vector<float>& triangles, float error, float slack)
{
  std::vector<float> input;
  for (std::size_t at = 0; at < triangles.size(); at += 18)
  {
    input.insert(input.end(), triangles.begin() + static_cast<std::ptrdiff_t>(at),
                 triangles.begin() + static_cast<std::ptrdiff_t>(at) + 18);
    input.insert(input.end(), {error, slack, 0.0F});
  }
  return input;
}

const char* const kTriangleIncludes =
    "#include \"geometry/pose.glsl\"\n#include \"problem/nodes.glsl\"\n#include "
    "\"geometry/error_bounds.glsl\"\n#include \"geometry/triangle_pair.glsl\"\n"
    "#include \"geometry/triangle_distance.glsl\"\n";
const char* const kTriangleCall =
    "trianglePair(vec3[3](at(0u), at(1u), at(2u)), vec3[3](at(3u), at(4u), at(5u)), vec3(0.0), at(6u).x, at(6u).y)";

TEST_F(GpuStep, NanProvesNothing)
{
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float negative_nan = std::copysign(nan, -1.0F);
  const float smallest = std::numeric_limits<float>::denorm_min();
  const std::vector<float> values = {0.0F, smallest, 1e-30F, 1.0F, 2.0F, 3.4e38F, infinity, nan, negative_nan};
  std::vector<float> input;
  for (const float a : values)
    for (const float b : values)
      input.insert(input.end(), {a, b, 0.0F});
  const auto result =
      run("#include \"common/comparisons.glsl\"\n", "provenGreater(at(0u).x, at(0u).y) ? 1u : 0u", input, 3);
  for (std::size_t i = 0; i < result.size(); ++i)
  {
    const float a = input[3 * i];
    const float b = input[3 * i + 1];
    EXPECT_EQ(a > b ? 1u : 0u, result[i]) << a << " > " << b;
  }
}

TEST_F(GpuStep, TrianglePairsAreDecidedAsInDoubleOrLeftUndecided)
{
  constexpr std::size_t kCases = 60000;
  std::vector<float> floats;
  std::vector<Triangles> cases;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    // Sizes from 1 mm to 1 m, far from and near each other. Some are slivers or degenerate.
    const double size_a = std::pow(10.0, -1.5 + 1.5 * uniform_(generator_));
    const double size_b = std::pow(10.0, -1.5 + 1.5 * uniform_(generator_));
    const Vector3d center = anyVector(0.5);
    const Vector3d apart = anyVector(0.3 * (size_a + size_b));
    Triangles pair;
    for (int k = 0; k < 3; ++k)
    {
      pair[0][k] = center + anyVector(size_a);
      pair[1][k] = center + apart + anyVector(size_b);
    }
    if (i % 10 == 0)
      pair[0][2] = pair[0][0] + 0.5 * (pair[0][1] - pair[0][0]) + anyVector(1e-5 * size_a);
    if (i % 50 == 0)
      pair[1][2] = pair[1][1];
    for (Triangle& triangle : pair)
      for (Vector3d& corner : triangle)
        corner = put(corner, floats);
    cases.push_back(pair);
  }
  const auto result = run(kTriangleIncludes, kTriangleCall, withBounds(floats, 0.0F, 0.0F), 21);
  std::size_t hits = 0;
  std::size_t undecided = 0;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    const bool meet = trianglesWithin(cases[i][0], cases[i][1], 0.0);
    hits += meet ? 1 : 0;
    undecided += result[i] == STATE_UNDECIDED ? 1 : 0;
    EXPECT_TRUE(result[i] == (meet ? STATE_HIT : 0U) || result[i] == STATE_UNDECIDED)
        << "case " << i << " gives " << result[i] << ", seed " << kSeed;
  }
  std::cout << kCases << " pairs, " << hits << " meet, " << undecided << " undecided, seed " << kSeed << std::endl;
  EXPECT_GT(hits, kCases / 20);
  EXPECT_LT(undecided, kCases / 100);
}

TEST_F(GpuStep, TrianglesWithinTheErrorOrTheSlackAreUndecided)
{
  std::vector<float> floats;
  constexpr std::size_t kCases = 2000;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    // A corner of b is 50 micrometres above the interior of a.
    const Eigen::Matrix3d rotation = anyRotation();
    const Vector3d offset = anyVector(0.3);
    const double height = 5e-5;
    for (const Vector3d& corner : {Vector3d(-0.1, -0.1, 0), Vector3d(0.2, 0, 0), Vector3d(0, 0.2, 0),
                                   Vector3d(0, 0, height), Vector3d(0.05, 0, 0.1), Vector3d(0, 0.05, 0.1)})
      put(rotation * corner + offset, floats);
  }
  for (const auto& [error, slack, expected] :
       {std::tuple(0.0F, 0.0F, 0U), std::tuple(1e-4F, 0.0F, STATE_UNDECIDED), std::tuple(0.0F, 1e-4F, STATE_UNDECIDED)})
    for (const std::uint32_t found : run(kTriangleIncludes, kTriangleCall, withBounds(floats, error, slack), 21))
      ASSERT_EQ(found, expected) << "error " << error << ", slack " << slack;
}

TEST_F(GpuStep, DistancesOfTrianglesAreBoundedOrLeftUndecided)
{
  constexpr std::size_t kCases = 20000;
  std::vector<float> floats;
  std::vector<Triangles> cases;
  std::vector<double> required;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    const Vector3d center = anyVector(0.5);
    Triangles pair;
    for (int k = 0; k < 3; ++k)
    {
      pair[0][k] = center + anyVector(0.1);
      pair[1][k] = center + Vector3d(0.15, 0.05, 0.0) + anyVector(0.1);
    }
    if (i % 10 == 0)
      pair[0][2] = pair[0][0] + 0.5 * (pair[0][1] - pair[0][0]) + anyVector(1e-6);
    if (i % 50 == 0)
      pair[1][2] = pair[1][1];
    for (Triangle& triangle : pair)
      for (Vector3d& corner : triangle)
        corner = put(corner, floats);
    // Half of the pairs have distances near the required distance.
    double low = 0.0;
    double high = 1.0;
    for (int step = 0; step < 40 && i % 2 == 0; ++step)
      (trianglesWithin(pair[0], pair[1], (low + high) / 2.0) ? high : low) = (low + high) / 2.0;
    const double distance = i % 2 == 0 ? high + 1e-5 * uniform_(generator_) : 0.05 + 0.04 * uniform_(generator_);
    required.push_back(put(Vector3d(1e-6, std::abs(distance), 0.0), floats).y());
    cases.push_back(pair);
  }
  const auto result =
      run(kTriangleIncludes,
          "triangleDistance(vec3[3](at(0u), at(1u), at(2u)), vec3[3](at(3u), at(4u), at(5u)), at(6u).x, "
          "at(6u).y, at(6u).y + 1e-9)",
          floats, 21);
  std::size_t undecided = 0;
  std::size_t hits = 0;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    // A proof must hold for triangles that are displaced by up to a micrometre.
    const bool within = trianglesWithin(cases[i][0], cases[i][1], required[i] - 0.9e-6);
    const bool beyond = !trianglesWithin(cases[i][0], cases[i][1], required[i] + 0.9e-6);
    EXPECT_FALSE(result[i] == STATE_HIT && !within) << "case " << i << ", seed " << kSeed;
    EXPECT_FALSE(result[i] == 0U && !beyond) << "case " << i << ", seed " << kSeed;
    hits += result[i] == STATE_HIT ? 1 : 0;
    undecided += result[i] == STATE_UNDECIDED ? 1 : 0;
  }
  std::cout << kCases << " pairs, " << hits << " too near, " << undecided << " undecided, seed " << kSeed << std::endl;
  EXPECT_GT(hits, kCases / 10);
  EXPECT_LT(undecided, kCases / 5);
}

/// A solid in the shaders' form and as a Shape.
struct TestSolid
{
  std::uint32_t kind;
  Vector3d size;
  Shape shape;
};

TestSolid solidOf(std::uint32_t kind, const Vector3d& size)
{
  if (kind == SOLID_BOX)
    return {kind, size, Box{2.0 * size}};
  if (kind == SOLID_SPHERE)
    return {kind, Vector3d::Constant(size.x()), Sphere{size.x()}};
  const Vector3d round(size.x(), size.x(), size.z());
  if (kind == SOLID_CYLINDER)
    return {kind, round, Cylinder{size.x(), 2.0 * size.z()}};
  return {kind, round, Cone{size.x(), 2.0 * size.z()}};
}

TEST_F(GpuStep, TrianglesAndSolidsAreDecidedAsTheExactCheckerDoesOrLeftUndecided)
{
  constexpr std::size_t kCases = 40000;
  constexpr float kError = 1e-6F;
  std::vector<float> floats;
  std::vector<Triangle> triangles;
  std::vector<TestSolid> solids;
  std::vector<double> required;
  const auto size = [&] { return std::pow(10.0, -1.5 + 1.5 * uniform_(generator_)); };
  for (std::size_t i = 0; i < kCases; ++i)
  {
    // Sizes from 1 mm to 1 m, with plates, rods, needles and discs among the solids and slivers among the triangles.
    const std::uint32_t kind = SOLID_BOX + static_cast<std::uint32_t>(i % 4);
    const Vector3d half = Vector3d(size(), size(), size()).cast<float>().cast<double>();
    const TestSolid solid = solidOf(kind, half);
    const double length = size();
    const Vector3d center = anyVector(1.0).cwiseProduct(solid.size + Vector3d::Constant(0.7 * length));
    Triangle triangle;
    for (Vector3d& corner : triangle)
      corner = center + anyVector(length);
    if (i % 10 == 0)
      triangle[2] = triangle[0] + 0.4 * (triangle[1] - triangle[0]) + anyVector(1e-5 * length);
    const double distance =
        i / 4 % 2 == 0 ? 0.0 : static_cast<double>(static_cast<float>(0.02 + 0.01 * uniform_(generator_)));
    // A third of the pairs are near contact or near the required distance.
    if (i % 3 == 0)
    {
      const Vector3d out = 10.0 * anyVector(1.0).normalized();
      double low = 0.0;
      double high = 1.0;
      for (int step = 0; step < 40; ++step)
      {
        const double middle = (low + high) / 2.0;
        Triangle moved = triangle;
        for (Vector3d& corner : moved)
          corner += middle * out;
        (triangleWithinSolid(moved, solid.shape, distance) ? low : high) = middle;
      }
      for (Vector3d& corner : triangle)
        corner += high * out + anyVector(1e-5);
    }
    for (Vector3d& corner : triangle)
      corner = put(corner, floats);
    put(solid.size, floats);
    put(Vector3d(kind, kError, distance), floats);
    triangles.push_back(triangle);
    solids.push_back(solid);
    required.push_back(distance);
  }
  const auto result =
      run("#include \"geometry/pose.glsl\"\n#include \"traversal/root_pairs.glsl\"\n#include "
          "\"problem/nodes.glsl\"\n#include \"problem/instances.glsl\"\n"
          "#include \"common/counters.glsl\"\n#include \"traversal/verdicts.glsl\"\n#include "
          "\"traversal/leaf_pair.glsl\"\n#include "
          "\"traversal/solid_leaf.glsl\"\n",
          "triangleSolid(vec3[3](at(0u), at(1u), at(2u)), Instance(0u, 0.0, 0u, 0u, vec3(0.0), uint(at(4u).x), "
          "at(3u), 0.0), at(4u).y, at(4u).z, requiredGap(at(4u).z, 0.0))",
          floats, 15);
  std::array<std::size_t, 3> counts = {};
  for (std::size_t i = 0; i < kCases; ++i)
  {
    // A proof must hold for triangles that are displaced by up to a micrometre.
    const bool within = triangleWithinSolid(triangles[i], solids[i].shape, std::max(0.0, required[i] - 0.9 * kError));
    const bool beyond = !triangleWithinSolid(triangles[i], solids[i].shape, required[i] + 0.9 * kError);
    EXPECT_FALSE(result[i] == STATE_HIT && !within) << "case " << i << ", seed " << kSeed;
    EXPECT_FALSE(result[i] == 0U && !beyond) << "case " << i << ", seed " << kSeed;
    ++counts[result[i] == STATE_HIT ? 0 : (result[i] == 0U ? 1 : 2)];
  }
  std::cout << counts[0] << " hits, " << counts[1] << " apart, " << counts[2] << " undecided, seed " << kSeed
            << std::endl;
  EXPECT_GT(counts[0], kCases / 10);
  EXPECT_GT(counts[1], kCases / 10);
  EXPECT_LT(counts[2], kCases / 5);  // a third of the cases are within 0.02 mm of contact
}

TEST_F(GpuStep, PointsLieWithinTheirBoundOfWhereExactPosesPutThem)
{
  constexpr std::size_t kCases = 20000;
  std::vector<float> floats;
  std::vector<Vector3d> exact;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    // Translations of 1 cm to 10 m. Every fifth pose of a is not rotated.
    const double size = std::pow(10.0, -0.5 + 1.5 * uniform_(generator_));
    std::array<Eigen::Isometry3d, 2> poses;
    for (Eigen::Isometry3d& pose : poses)
    {
      pose.linear() = i % 5 == 0 && &pose == &poses[0] ? Eigen::Matrix3d::Identity() : anyRotation();
      pose.translation() = anyVector(size);
      for (int row = 0; row < 3; ++row)
        put(pose.linear().row(row).transpose(), floats);
      put(pose.translation(), floats);
    }
    const Vector3d point = anyVector(0.3 * size);
    put(point, floats);
    exact.push_back(poses[0].inverse() * (poses[1] * point));
  }
  const std::string pose_a = "Pose(transpose(mat3(at(0u), at(1u), at(2u))), at(3u))";
  const std::string pose_b = "Pose(transpose(mat3(at(4u), at(5u), at(6u))), at(7u))";
  const std::string relative = "relativePose(" + pose_a + ", " + pose_b + ")";
  const auto number = [&](const std::string& expression)
  { return run(kTriangleIncludes, "floatBitsToUint(" + expression + ")", floats, 27); };
  const auto value = [](std::uint32_t bits)
  {
    float result;
    std::memcpy(&result, &bits, sizeof(result));
    return static_cast<double>(result);
  };
  std::array<std::vector<std::uint32_t>, 3> found;
  for (std::size_t axis = 0; axis < 3; ++axis)
    found[axis] = number("apply(" + relative + ", at(8u))." + std::string(1, "xyz"[axis]));
  const auto bound = number("positionError(" + pose_a + ", " + pose_b + ", " + relative + ", vec3(0.0), abs(at(8u)))");
  double largest = 0.0;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    const Vector3d point(value(found[0][i]), value(found[1][i]), value(found[2][i]));
    const double share = (point - exact[i]).norm() / value(bound[i]);
    largest = std::max(largest, share);
    EXPECT_LT(share, 1.0) << "case " << i << ", seed " << kSeed;
  }
  std::cout << "at most " << largest << " of the bound, seed " << kSeed << std::endl;
  EXPECT_GT(largest, 0.02);  // a bound that is much too wide would cost undecided states
}

TEST_F(GpuStep, ProofsOfPlacedTrianglesHoldForTheExactPoses)
{
  constexpr std::size_t kCases = 3000;
  std::vector<float> floats;
  std::vector<bool> meet;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    // Triangles of 1 mm to 1 m in frames near and far, between nanometres and micrometres from contact.
    const double arm = std::pow(10.0, 0.75 + 0.75 * uniform_(generator_));
    std::array<Triangle, 2> triangles;
    std::array<Eigen::Isometry3d, 2> poses;
    for (int k = 0; k < 2; ++k)
    {
      const double size = std::pow(10.0, -1.5 + 1.5 * uniform_(generator_));
      const Vector3d center = anyVector(0.3);
      for (Vector3d& corner : triangles[k])
        corner = center + anyVector(size);
      poses[k].linear() = anyRotation();
      poses[k].translation() = anyVector(arm);
    }
    const auto placed = [&](int k) {
      return Triangle{poses[k] * triangles[k][0], poses[k] * triangles[k][1], poses[k] * triangles[k][2]};
    };
    const Triangle a = placed(0);
    const auto center = [](const Triangle& t) { return Vector3d((t[0] + t[1] + t[2]) / 3.0); };
    const Vector3d from = poses[1].translation() + center(a) - center(placed(1));  // here they meet, or nearly
    const Vector3d direction = anyVector(1.0).normalized();
    double low = 0.0;
    double high = 3.0;
    for (int step = 0; step < 45; ++step)
    {
      const double middle = (low + high) / 2.0;
      poses[1].translation() = from + middle * direction;
      (trianglesWithin(a, placed(1), 0.0) ? low : high) = middle;
    }
    poses[1].translation() =
        from + (high + std::pow(10.0, -6.5 + 2.0 * uniform_(generator_)) * (i % 2 == 0 ? 1 : -1)) * direction;
    meet.push_back(trianglesWithin(a, placed(1), 0.0));
    for (const Triangle& triangle : triangles)
      for (const Vector3d& corner : triangle)
        put(corner, floats);
    for (const Eigen::Isometry3d& pose : poses)
    {
      for (int row = 0; row < 3; ++row)
        put(pose.linear().row(row).transpose(), floats);
      put(pose.translation(), floats);
    }
  }
  const std::string includes = std::string(kTriangleIncludes) + R"(
    uint placedPair(vec3 a[3], vec3 b[3], Pose pose_a, Pose pose_b)
    {
      const Pose pose = relativePose(pose_a, pose_b);
      const vec3 far_a = max(max(abs(a[0]), abs(a[1])), abs(a[2]));
      const vec3 far_b = max(max(abs(b[0]), abs(b[1])), abs(b[2]));
      vec3 moved[3];
      for (int i = 0; i < 3; ++i)
        moved[i] = apply(pose, b[i]);
      return trianglePair(a, moved, pose.translation, positionError(pose_a, pose_b, pose, far_a, far_b), 1e-9);
    }
)";
  const auto result = run(includes,
                          "placedPair(vec3[3](at(0u), at(1u), at(2u)), vec3[3](at(3u), at(4u), at(5u)), "
                          "Pose(transpose(mat3(at(6u), at(7u), at(8u))), at(9u)), "
                          "Pose(transpose(mat3(at(10u), at(11u), at(12u))), at(13u)))",
                          floats, 42);
  std::array<std::size_t, 3> count{};
  for (std::size_t i = 0; i < kCases; ++i)
  {
    EXPECT_FALSE(result[i] == STATE_HIT && !meet[i]) << "case " << i << ", seed " << kSeed;
    EXPECT_FALSE(result[i] == 0U && meet[i]) << "case " << i << ", seed " << kSeed;
    ++count[result[i]];
  }
  std::cout << count[STATE_HIT] << " hit, " << count[0] << " apart, " << count[STATE_UNDECIDED] << " undecided, seed "
            << kSeed << std::endl;
  EXPECT_GT(count[STATE_HIT], kCases / 50);
  EXPECT_GT(count[0], kCases / 50);
  EXPECT_GT(count[STATE_UNDECIDED], kCases / 10);
}

/// An oriented box in a shape's frame. `pose`: pose of the shape.
struct PlacedBox
{
  Vector3d center;
  Vector3d half;
  Eigen::Matrix3d axes;
  Eigen::Isometry3d pose;

  /// Appends centre, half edge lengths, quaternion and the rows of the pose as float32. Rounds the box's own values
  /// accordingly.
  void put(std::vector<float>& into)
  {
    const Eigen::Quaternionf q(Eigen::Quaterniond(axes).cast<float>());
    axes = q.cast<double>().normalized().toRotationMatrix();
    center = center.cast<float>().cast<double>();
    half = half.cast<float>().cast<double>();
    const Eigen::Matrix4f rows = pose.matrix().cast<float>();
    into.insert(into.end(), {float(center.x()), float(center.y()), float(center.z())});
    into.insert(into.end(), {float(half.x()), float(half.y()), float(half.z())});
    into.insert(into.end(), {q.x(), q.y(), q.z(), q.w(), 0.0F, 0.0F});
    for (int row = 0; row < 3; ++row)
      into.insert(into.end(), {rows(row, 0), rows(row, 1), rows(row, 2)});
    into.insert(into.end(), {rows(0, 3), rows(1, 3), rows(2, 3)});
  }
};

bool overlap(const PlacedBox& a, const PlacedBox& b)
{
  const Eigen::Matrix3d turn_a = a.pose.linear() * a.axes;
  const Eigen::Matrix3d turn_b = b.pose.linear() * b.axes;
  return BoxPairTest(turn_a.transpose() * turn_b)
      .overlap(a.half, b.half, turn_a.transpose() * (b.pose * b.center - a.pose * a.center));
}

TEST_F(GpuStep, OrientedBoxesThatOverlapAreNeverApart)
{
  constexpr std::size_t kCases = 20000;
  std::vector<float> input;
  std::vector<bool> overlapping;
  std::vector<bool> clearly_apart;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    std::array<PlacedBox, 2> boxes;
    for (PlacedBox& box : boxes)
    {
      const double size = std::pow(10.0, -1.5 + 1.5 * uniform_(generator_));
      const Vector3d shape = anyVector(1.0).cwiseAbs().cwiseProduct(Vector3d(1.0, i % 3 == 0 ? 1e-3 : 1.0, 1.0));
      box = {anyVector(0.3), size * shape, anyRotation(), Eigen::Isometry3d(Eigen::Translation3d(anyVector(2.0)))};
      box.pose.linear() = anyRotation();
    }
    auto& [a, b] = boxes;
    // Some boxes are parallel, so that cross products of axes vanish.
    if (i % 5 == 0)
      b.axes = b.pose.linear().transpose() * a.pose.linear() * a.axes;
    std::vector<float> placed;
    a.put(placed);
    b.put(placed);
    // The boxes are placed at, shortly before or shortly after their first contact along a line from a's centre.
    const Vector3d to = anyVector(1.0).normalized();
    const Vector3d together = a.pose * a.center - b.pose.linear() * b.center;
    double low = 0.0;
    double high = 2.0 * (a.half.norm() + b.half.norm());
    for (int step = 0; step < 50; ++step)
    {
      const double middle = 0.5 * (low + high);
      b.pose.translation() = together + middle * to;
      (overlap(a, b) ? low : high) = middle;
    }
    const double off = uniform_(generator_) * std::pow(10.0, -4.0 + 3.0 * uniform_(generator_)) * low;
    b.pose.translation() = together + (low + off) * to;
    a.put(input);
    b.put(input);
    overlapping.push_back(overlap(a, b));
    // Whether the boxes are apart even if b is larger by a thousandth of the sizes.
    PlacedBox larger = b;
    larger.half += Vector3d::Constant(1e-3 * (a.half.norm() + b.half.norm()) + 1e-4);
    clearly_apart.push_back(!overlap(a, larger));
  }
  const auto apart = run(
      kPlacedNodes + std::string(R"(
bool placedApart(OrientedNode a, Pose pose_a, OrientedNode b, Pose pose_b)
{
  const Pose pose = relativePose(pose_a, pose_b);
  return nodesApart(a, b, pose, 0.0, errorOf(a, pose_a, b, pose_b, pose));
}
)"),
      "placedApart(" + nodeAt(0) + ", " + poseAt(4) + ", " + nodeAt(8) + ", " + poseAt(12) + ") ? 1u : 0u", input, 48);
  std::size_t meeting = 0;
  std::size_t missed = 0;
  std::size_t clear = 0;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    EXPECT_FALSE(overlapping[i] && apart[i] != 0U) << "case " << i << ", seed " << kSeed;
    meeting += overlapping[i] ? 1 : 0;
    clear += clearly_apart[i] ? 1 : 0;
    missed += clearly_apart[i] && apart[i] == 0U ? 1 : 0;
  }
  EXPECT_GT(meeting, kCases / 10);
  EXPECT_GT(clear, kCases / 50);
  // The test uses all 15 axes, so it finds all pairs that are clearly apart.
  EXPECT_EQ(missed, 0U) << "of " << clear << ", seed " << kSeed;
}

/// Small boxes that are farther apart than a long required distance, along the line of their centres.
TEST_F(GpuStep, BoxesAreApartAlongTheirCentersOnlyBeyondTheRequiredDistance)
{
  constexpr std::size_t kCases = 10000;
  constexpr double kClear = 8e-6;  // metres; the bound for the other axes, 512 u of the distance, is larger
  std::vector<float> input;
  std::vector<double> beyond;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    std::array<PlacedBox, 2> boxes;
    for (PlacedBox& box : boxes)
    {
      const double size = std::pow(10.0, -3.0 + uniform_(generator_));
      box = {anyVector(0.01), size * anyVector(1.0).cwiseAbs(), anyRotation(), Eigen::Isometry3d::Identity()};
      box.pose.linear() = anyRotation();
      std::vector<float> rounded;
      box.put(rounded);
    }
    auto& [a, b] = boxes;
    const double required = static_cast<float>(0.5 * std::abs(uniform_(generator_)));
    const Vector3d to = anyVector(1.0).normalized();
    const auto reach = [&to](const PlacedBox& box)
    { return ((box.pose.linear() * box.axes).transpose() * to).cwiseAbs().dot(box.half); };
    beyond.push_back(uniform_(generator_) * std::pow(10.0, -6.0 + 2.0 * uniform_(generator_)));
    b.pose.translation() =
        a.pose * a.center - b.pose.linear() * b.center + (required + reach(a) + reach(b) + beyond.back()) * to;
    a.put(input);
    b.put(input);
    input.insert(input.end(), {float(required), 0.0F, 0.0F});
  }
  const auto apart = run(
      kPlacedNodes + std::string(R"(
bool placedApart(OrientedNode a, Pose pose_a, OrientedNode b, Pose pose_b, float gap)
{
  const Pose pose = relativePose(pose_a, pose_b);
  const float needed = centersMargin(gap, errorOf(a, pose_a, b, pose_b, pose)) + sizeError(a.box, b.box);
  return apartAlongCenters(a, b, pose, needed);
}
)"),
      "placedApart(" + nodeAt(0) + ", " + poseAt(4) + ", " + nodeAt(8) + ", " + poseAt(12) + ", at(16u).x) ? 1u : 0u",
      input, 51);
  std::size_t missed = 0;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    EXPECT_FALSE(beyond[i] <= 0.0 && apart[i] != 0U) << "case " << i << ", seed " << kSeed;
    missed += beyond[i] > kClear && apart[i] == 0U ? 1 : 0;
  }
  EXPECT_EQ(missed, 0U) << "seed " << kSeed;
}

/// A box that overlaps a curved solid's bounding box need not be near the solid.
TEST_F(GpuStep, BoxesThatMeetASolidAreNeverBeyondIt)
{
  constexpr std::size_t kCases = 3000;
  std::vector<float> input;
  std::vector<bool> meets;
  std::vector<bool> clearly_apart;
  const auto size = [&] { return std::pow(10.0, -1.5 + uniform_(generator_)); };
  for (std::size_t i = 0; i < kCases; ++i)
  {
    const std::uint32_t kind = SOLID_BOX + static_cast<std::uint32_t>(i % 4);
    const TestSolid solid = solidOf(kind, Vector3d(size(), size(), size()).cast<float>().cast<double>());
    const bool solid_is_a = i / 4 % 2 == 0;
    const double distance =
        i / 8 % 2 == 0 ? 0.0 : static_cast<double>(static_cast<float>(0.02 * std::abs(anyVector(1.0).x())));
    PlacedBox of_solid = {Vector3d::Zero(), solid.size, Eigen::Matrix3d::Identity(),
                          Eigen::Isometry3d(Eigen::Translation3d(anyVector(1.0)))};
    of_solid.pose.linear() = anyRotation();
    PlacedBox box = {anyVector(0.2), Vector3d(size(), size(), size()), anyRotation(), Eigen::Isometry3d::Identity()};
    box.pose.linear() = anyRotation();
    std::vector<float> rounded;
    box.put(rounded);
    // The shapes are placed at, shortly before or shortly after their contact along a line.
    const auto meet = [&](double grown)
    {
      const Eigen::Isometry3d into = of_solid.pose.inverse(Eigen::Isometry) * box.pose *
                                     Eigen::Translation3d(box.center) *
                                     Eigen::Isometry3d(Eigen::Affine3d(box.axes).matrix());
      return solidsWithin(solid.shape, Box{2.0 * (box.half + Vector3d::Constant(grown))}, into, distance);
    };
    const Vector3d to = anyVector(1.0).normalized();
    const Vector3d together = of_solid.pose.translation() - box.pose.linear() * box.center;
    double low = 0.0;
    double high = 5.0;
    for (int step = 0; step < 40; ++step)
    {
      const double middle = 0.5 * (low + high);
      box.pose.translation() = together + middle * to;
      (meet(0.0) ? low : high) = middle;
    }
    box.pose.translation() =
        together + (low + uniform_(generator_) * std::pow(10.0, -4.0 + 3.0 * uniform_(generator_))) * to;
    (solid_is_a ? of_solid : box).put(input);
    (solid_is_a ? box : of_solid).put(input);
    put(solid.size, input);
    put(Vector3d(kind, solid_is_a ? 1.0 : 0.0, distance), input);
    meets.push_back(meet(0.0));
    clearly_apart.push_back(!meet(5e-3));
  }
  const auto beyond = run(kPlacedNodes + std::string(R"(
bool placedBeyond(OrientedNode a, Pose pose_a, OrientedNode b, Pose pose_b, vec3 size, vec3 what)
{
  RootPair root_pair;
  root_pair.pose = relativePose(pose_a, pose_b);
  root_pair.error = errorOf(a, pose_a, b, pose_b, root_pair.pose);
  root_pair.gap = requiredGap(what.z, 0.0);
  const Instance solid = Instance(0u, 0.0, 0u, 0u, vec3(0.0), uint(what.x), size, 0.0);
  const Instance mesh = Instance(0u, 0.0, 0u, 0u, vec3(0.0), SOLID_NONE, vec3(0.0), 0.0);
  if (what.y > 0.5)
    return nodeBeyondSolid(a, b, solid, mesh, root_pair);
  return nodeBeyondSolid(a, b, mesh, solid, root_pair);
}
)"),
                          "placedBeyond(" + nodeAt(0) + ", " + poseAt(4) + ", " + nodeAt(8) + ", " + poseAt(12) +
                              ", at(16u), at(17u)) ? 1u : 0u",
                          input, 54);
  std::size_t meeting = 0;
  std::size_t clear = 0;
  std::size_t found = 0;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    EXPECT_FALSE(meets[i] && beyond[i] != 0U) << "case " << i << ", seed " << kSeed;
    meeting += meets[i] ? 1 : 0;
    clear += clearly_apart[i] ? 1 : 0;
    found += clearly_apart[i] && beyond[i] != 0U ? 1 : 0;
  }
  std::cout << meeting << " meet, " << clear << " apart by 5 mm, " << found << " of these found, seed " << kSeed
            << std::endl;
  EXPECT_GT(meeting, kCases / 4);
  // The test of one line does not find all pairs that are apart.
  EXPECT_GT(found, clear / 3);
}
}  // namespace
}  // namespace gpu_planning_scene::core
