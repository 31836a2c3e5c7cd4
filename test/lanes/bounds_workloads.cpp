// Functions of the shaders, alone, with the arithmetic of the simulated device. Each input is exact, so that each error
// is one of the function. The bounds are those of docs/error_bounds.md.

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

#include "collision/gpu/problem/gpu_kinematics.h"
#include "gpu/program.h"
#include "lanes/workloads.h"
#include "oracle/triangle.h"
#include "shader_constants.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;
using oracle::Quad;

constexpr std::size_t kCases = 256;
constexpr double kU = UNIT_ROUNDOFF;

using Texel = std::array<float, 4>;

/// Random numbers, and vectors that are rounded to float.
class Random
{
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator_); }
  std::size_t below(std::size_t count) { return generator_() % count; }
  Vector3d vector(double size) { return rounded({uniform(-size, size), uniform(-size, size), uniform(-size, size)}); }
  Eigen::Matrix3d rotation()
  {
    std::normal_distribution<double> normal;
    const Eigen::Quaterniond q(normal(generator_), normal(generator_), normal(generator_), normal(generator_));
    return q.normalized().toRotationMatrix().unaryExpr(&Random::roundedNumber);
  }
  static Vector3d rounded(const Vector3d& v) { return v.unaryExpr(&Random::roundedNumber); }

 private:
  /// With g++ 12 -O3, a plain conversion of two neighbours to float and back does nothing.
  static double roundedNumber(double x)
  {
    const volatile auto nearest = static_cast<float>(x);
    return static_cast<double>(nearest);
  }

  std::mt19937_64 generator_;
};

Texel texel(const Vector3d& v, double w = 0.0)
{
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), static_cast<float>(w)};
}

/// Runs `body` for each case: it reads values[first] to values[first + in - 1], and writes results[to] to
/// results[to + out - 1].
std::vector<Texel> run(const std::string& shaders, const std::string& includes, const std::string& body,
                       const std::vector<Texel>& values, std::size_t in, std::size_t out)
{
  const std::string text = R"(// One invocation per case: gives the results of functions of the shaders.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
)" + includes + R"(
layout(std430, binding = 0) readonly buffer Values { vec4 values[]; };
layout(std430, binding = 1) writeonly buffer Results { vec4 results[]; };
void main()
{
  const uint first = invocationIndex() * )" +
                           std::to_string(in) + "u;\n  const uint to = invocationIndex() * " + std::to_string(out) +
                           "u;\n" + body + "}\n";
  const Program program = Program::fromText(shaders, "bounds", text);
  const std::size_t cases = values.size() / in;
  Buffer input(values.size() * sizeof(Texel));
  input.write(values);
  Buffer output(cases * out * sizeof(Texel));
  input.bindStorage(0);
  output.bindStorage(1);
  program.dispatch(groupsFor(cases));
  std::vector<Texel> results(cases * out);
  output.read(results.data(), results.size() * sizeof(Texel));
  return results;
}

Vector3d threeOf(const Texel& t)
{
  return {t[0], t[1], t[2]};
}

/// Adds a line if `found` is farther from `exact` than `bound`, in a coordinate.
void expectWithin(const std::string& what, const Vector3d& found, const oracle::Vector& exact, const Vector3d& bound,
                  std::vector<std::string>& wrong)
{
  const Vector3d error = (oracle::Vector(found) - exact).toDouble().cwiseAbs();
  if ((error.array() <= bound.array() * (1.0 + 8.0 * kU) + 1e-37).all())
    return;
  std::ostringstream line;
  line << what << " is off by " << error.transpose() << ", the bound is " << bound.transpose();
  wrong.push_back(line.str());
}

/// Two triangles, whose distance is small compared with their sizes.
struct Pair
{
  std::array<Vector3d, 3> a, b;
  Quad distance;
};

oracle::Triangle exactly(const std::array<Vector3d, 3>& corners)
{
  return oracle::Triangle({oracle::Vector(corners[0]), oracle::Vector(corners[1]), oracle::Vector(corners[2])});
}

/// A corner above a face, or an edge across an edge, 1e-1 to 1e-9 of the size away, up to 1000 sizes from the origin.
Pair nearPair(Random& random)
{
  Pair pair;
  const double size = std::pow(10.0, random.uniform(-2.0, 1.0));
  const Vector3d place = random.vector(size * std::pow(10.0, random.uniform(0.0, 3.0)));
  const double gap = size * std::pow(10.0, random.uniform(-9.0, -1.0));
  for (Vector3d& corner : pair.a)
    corner = place + random.vector(size);
  const Vector3d e1 = pair.a[1] - pair.a[0];
  const Vector3d e2 = pair.a[2] - pair.a[0];
  const bool edges = random.below(2) == 0;
  const double s = random.uniform(0.1, 0.8);
  const Vector3d other = random.vector(size);
  const Vector3d normal = (edges ? e1.cross(other) : e1.cross(e2)).normalized();
  const Vector3d foot = pair.a[0] + s * e1 + (edges ? 0.0 : random.uniform(0.1, 0.9) * (1.0 - s)) * e2;
  const double side = edges && normal.dot(e2) > 0.0 ? -1.0 : 1.0;
  const Vector3d nearest = foot + side * gap * normal;
  const auto above = [&](const Vector3d& v)
  { return Vector3d(v + side * (0.2 * size + std::abs(normal.dot(v))) * normal); };
  pair.b = {nearest + (edges ? Vector3d(-s * other) : Vector3d::Zero()),
            nearest + (edges ? Vector3d((1.0 - s) * other) : above(random.vector(size))),
            nearest + above(random.vector(size))};
  // One in eight is a segment or a point.
  if (random.below(8) == 0)
    pair.b[2] = pair.b[0];
  if (random.below(8) == 0)
    pair.a[1] = pair.a[0];
  if (random.below(32) == 0)
    pair.a = {pair.a[0], pair.a[0], pair.a[0]};
  for (auto* corners : {&pair.a, &pair.b})
  {
    for (Vector3d& corner : *corners)
      corner = Random::rounded(corner);
    std::rotate(corners->begin(), corners->begin() + static_cast<std::ptrdiff_t>(random.below(3)), corners->end());
  }
  pair.distance = oracle::distance(exactly(pair.a), exactly(pair.b), Quad(1e30));
  return pair;
}

/// Two triangles with nearly parallel edges, 30 to 3000 sizes apart. The product of these edges consists of rounding
/// errors for the most part.
Pair parallelPair(Random& random)
{
  Pair pair;
  const double size = std::pow(10.0, random.uniform(-2.0, 1.0));
  for (Vector3d& corner : pair.a)
    corner = random.vector(size);
  const Vector3d edge = pair.a[1] - pair.a[0];
  const Vector3d away = size * std::pow(10.0, random.uniform(1.5, 3.5)) * edge.cross(random.vector(1.0)).normalized();
  pair.b[0] = random.vector(size) + away;
  pair.b[1] =
      pair.b[0] + random.uniform(0.5, 2.0) * edge + random.vector(size) * std::pow(10.0, random.uniform(-7.5, -4.0));
  pair.b[2] = random.vector(size) + away;
  for (Vector3d& corner : pair.b)
    corner = Random::rounded(corner);
  pair.distance = oracle::distance(exactly(pair.a), exactly(pair.b), Quad(1e30));
  return pair;
}

const char* const kTriangleIncludes = R"(
#include "geometry/pose.glsl"
#include "problem/nodes.glsl"
#include "geometry/error_bounds.glsl"
#include "geometry/triangle_pair.glsl"
#include "geometry/triangle_distance.glsl"
)";
const char* const kTwoTriangles = R"(
  vec3 a[3];
  vec3 b[3];
  for (uint i = 0u; i < 3u; ++i)
  {
    a[i] = values[first + i].xyz;
    b[i] = values[first + 3u + i].xyz;
  }
  const vec4 lengths = values[first + 6u];
)";

std::vector<Texel> textOf(const std::vector<Pair>& pairs, const std::vector<Texel>& lengths)
{
  std::vector<Texel> values;
  for (std::size_t i = 0; i < pairs.size(); ++i)
  {
    for (const auto* corners : {&pairs[i].a, &pairs[i].b})
      for (const Vector3d& corner : *corners)
        values.push_back(texel(corner));
    values.push_back(lengths[i]);
  }
  return values;
}

std::string lineOf(std::size_t i, const Pair& pair, const std::string& what)
{
  std::ostringstream line;
  line << "pair " << i << " of triangles at a distance of " << static_cast<double>(pair.distance) << " m: " << what;
  return line.str();
}

/// The smallest float that is at least `x`, and the largest that is less.
float atLeast(Quad x)
{
  const auto nearest = static_cast<float>(x);
  return Quad(nearest) < x ? std::nextafter(nearest, INFINITY) : nearest;
}
float below(Quad x)
{
  return std::nextafter(atLeast(x), -INFINITY);
}
}  // namespace

std::vector<std::string> checkTransforms(const std::string& shaders, std::uint64_t seed)
{
  Random random(seed);
  struct Given
  {
    Eigen::Matrix3d a, b;
    Vector3d s, t, point, back;
  };
  std::vector<Given> given(kCases);
  std::vector<Texel> values;
  for (Given& g : given)
  {
    const double far = std::pow(10.0, random.uniform(-3.0, 3.0));
    g.a = random.rotation();
    g.b = random.rotation();
    g.s = random.vector(far);
    g.t = Random::rounded(g.s + random.vector(1.0));
    g.point = random.vector(1.0);
    g.back = Random::rounded(random.vector(0.001) - g.point);
    for (const auto& [rotation, translation] : {std::pair(g.a, g.s), std::pair(g.b, g.t)})
      for (Eigen::Index row = 0; row < 3; ++row)
        values.push_back(texel(rotation.row(row), translation[row]));
    values.push_back(texel(g.point));
    values.push_back(texel(g.back));
  }
  const std::vector<Texel> results = run(shaders, "#include \"geometry/pose.glsl\"\n", R"(
  const Pose a = poseFromRows(values[first], values[first + 1u], values[first + 2u]);
  const Pose b = poseFromRows(values[first + 3u], values[first + 4u], values[first + 5u]);
  results[to] = vec4(apply(a, values[first + 6u].xyz), 0.0);
  results[to + 1u] = vec4(relativePose(a, b).translation, 0.0);
  const Pose back = Pose(mat3(1.0), values[first + 7u].xyz);
  results[to + 2u] = vec4(dot(values[first + 3u].xyz, apply(back, values[first + 6u].xyz)));
)",
                                         values, 8, 3);
  std::vector<std::string> wrong;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    const Given& g = given[i];
    const auto turned = [](const Eigen::Matrix3d& rotation, const oracle::Vector& v)
    {
      const auto row = [&](Eigen::Index k) { return oracle::dot(oracle::Vector(Vector3d(rotation.row(k))), v); };
      return oracle::Vector(row(0), row(1), row(2));
    };
    // Rx: three products, two sums. Then the sum with t.
    expectWithin("a transformed point", threeOf(results[3 * i]),
                 turned(g.a, oracle::Vector(g.point)) + oracle::Vector(g.s),
                 kU * (4.0 * (g.a.cwiseAbs() * g.point.cwiseAbs()) + g.s.cwiseAbs()), wrong);
    // t - s, then three products and two sums.
    expectWithin("a relative translation", threeOf(results[3 * i + 1]),
                 turned(g.a.transpose(), oracle::Vector(g.t) - oracle::Vector(g.s)),
                 kU * 4.0 * (g.a.cwiseAbs().transpose() * (g.t - g.s).cwiseAbs()), wrong);
    // A translation that moves a point almost to the origin: one sum, then three products and two sums.
    const oracle::Vector moved = oracle::Vector(g.point) + oracle::Vector(g.back);
    const Vector3d normal = g.b.row(0);
    const Quad height = oracle::dot(oracle::Vector(normal), moved);
    expectWithin("the height of a moved point", threeOf(results[3 * i + 2]), oracle::Vector(height, height, height),
                 Vector3d::Constant(kU * 4.0 * normal.cwiseAbs().dot(moved.toDouble().cwiseAbs())), wrong);
  }
  return wrong;
}

std::vector<std::string> checkTriangles(const std::string& shaders, std::uint64_t seed)
{
  Random random(seed);
  std::vector<Pair> pairs;
  std::vector<Texel> lengths;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    pairs.push_back(i % 4 == 0 ? parallelPair(random) : nearPair(random));
    lengths.push_back({0.0F, atLeast(pairs.back().distance)});
  }
  const std::vector<Texel> results =
      run(shaders, kTriangleIncludes,
          std::string(kTwoTriangles) +
              "  results[to] = vec4(float(trianglePair(a, b, b[0], lengths.x, lengths.y)), 0.0, 0.0, 0.0);\n",
          textOf(pairs, lengths), 7, 1);
  std::vector<std::string> wrong;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    if (results[i][0] == STATE_HIT && pairs[i].distance > 0)
      wrong.push_back(lineOf(i, pairs[i], "trianglePair proves that they meet"));
    if (results[i][0] == 0)
      wrong.push_back(lineOf(i, pairs[i], "trianglePair proves that they are farther apart"));
  }
  return wrong;
}

std::vector<std::string> checkDistances(const std::string& shaders, std::uint64_t seed)
{
  Random random(seed);
  std::vector<Pair> pairs;
  std::vector<Texel> lengths;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    Pair pair = nearPair(random);
    while (pair.distance == 0)
      pair = nearPair(random);
    pairs.push_back(pair);
    lengths.push_back({0.0F, atLeast(pair.distance), below(pair.distance)});
  }
  const std::vector<Texel> results = run(shaders, kTriangleIncludes,
                                         std::string(kTwoTriangles) +
                                             "  results[to] = vec4(float(triangleDistance(a, b, lengths.x, lengths.z, "
                                             "lengths.y)), 0.0, 0.0, 0.0);\n",
                                         textOf(pairs, lengths), 7, 1);
  std::vector<std::string> wrong;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    if (results[i][0] == STATE_HIT)
      wrong.push_back(lineOf(i, pairs[i], "triangleDistance proves that they are nearer"));
    if (results[i][0] == 0)
      wrong.push_back(lineOf(i, pairs[i], "triangleDistance proves that they are farther apart"));
  }
  return wrong;
}

namespace
{
/// The sine and the cosine of angles up to 2^20, in double precision.
void checkSines(const std::string& shaders, Random& random, std::vector<std::string>& wrong)
{
  const Program program = Program::fromText(shaders, "sines", R"(// One invocation per angle: its sine and its cosine.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "problem/kinematics.glsl"
layout(std430, binding = BINDING_C) readonly buffer Angles { double angles[]; };
layout(std430, binding = BINDING_D) writeonly buffer Results { dvec2 results[]; };
void main()
{
  const uint i = invocationIndex();
  double sine, cosine;
  sineCosine(angles[i], sine, cosine);
  results[i] = dvec2(sine, cosine);
}
)");
  std::vector<double> angles(kCases);
  for (double& angle : angles)
    angle = random.uniform(-1.0, 1.0) * std::pow(2.0, random.uniform(0.0, 20.0));
  Buffer input(kCases * sizeof(double));
  input.write(angles);
  std::vector<std::array<double, 2>> results(kCases);
  Buffer output(kCases * sizeof(results[0]));
  input.bindStorage(BINDING_C);
  output.bindStorage(BINDING_D);
  program.dispatch(groupsFor(kCases));
  output.read(results.data(), kCases * sizeof(results[0]));
  for (std::size_t i = 0; i < kCases; ++i)
  {
    const auto angle = static_cast<long double>(angles[i]);
    const auto off = static_cast<double>(
        std::max(std::abs(results[i][0] - std::sin(angle)), std::abs(results[i][1] - std::cos(angle))));
    // The part of a rotation in the bound of link poses, for operations that are rounded in any direction.
    if (!(off <= 30.0 * 0x1p-52))
      wrong.push_back("the sine or cosine of " + std::to_string(angles[i]) + " is off by " +
                      std::to_string(off * 1e15) + "e-15");
  }
}
}  // namespace

std::vector<std::string> checkKinematics(const std::string& shaders, std::uint64_t seed)
{
  const auto robot = RobotModel::fromXml(R"(<robot name="turning"><link name="base"/><link name="a"/><link name="b"/>
      <joint name="first" type="continuous"><parent link="base"/><child link="a"/><axis xyz="0.6 0 0.8"/>
        <origin xyz="0.1 0.2 0.3" rpy="0.3 -0.2 0.9"/></joint>
      <joint name="second" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
        <origin xyz="0.3 0 0.1" rpy="1.1 0.4 0"/></joint></robot>)",
                                         "", {});
  CollisionProblem problem;
  for (std::int32_t link = 0; link < 3; ++link)
    problem.robot.push_back({0, link, link, Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.2, 0.3))});
  Random random(seed);
  std::vector<double> states;
  for (std::size_t i = 0; i < 2 * kCases; ++i)
    states.push_back(random.uniform(-1.0, 1.0) * std::pow(10.0, random.uniform(0.0, 6.0)));
  GpuKinematics kinematics(shaders, robot);
  kinematics.setInstances(problem);
  kinematics.setStates(states.data());
  TexelBuffer poses;
  poses.reserve(kCases * problem.robot.size() * POSE_FLOATS * sizeof(float));
  const Buffer no_list(COUNTER_WORDS * sizeof(std::uint32_t));
  no_list.bindStorage(BINDING_COUNTERS);
  no_list.bindStorage(BINDING_OPEN_STATES);
  kinematics.begin(0, kCases);
  kinematics.place(poses);
  std::vector<float> found(kCases * problem.robot.size() * POSE_FLOATS);
  poses.buffer().read(found.data(), found.size() * sizeof(float));
  std::vector<std::string> wrong;
  checkSines(shaders, random, wrong);
  std::vector<Eigen::Isometry3d> links(3);
  for (std::size_t i = 0; i < kCases; ++i)
  {
    robot->linkPoses(&states[2 * i], links.data());
    for (std::size_t k = 0; k < problem.robot.size(); ++k)
    {
      const Eigen::Isometry3d pose = links[k] * problem.robot[k].pose;
      for (int entry = 0; entry < POSE_FLOATS; ++entry)
      {
        const double expected = pose(entry / 4, entry % 4);
        const double value = found[(k * kCases + i) * POSE_FLOATS + static_cast<std::size_t>(entry)];
        // Half a unit in the last place of a float, and the error of a pose.
        if (!(std::abs(value - expected) <= 0x1p-24 * std::abs(expected) + 1e-12))
          wrong.push_back("an entry of a pose is " + std::to_string(value) + ", off by " +
                          std::to_string(std::abs(value - expected) * 1e12) + "e-12");
      }
    }
  }
  return wrong;
}
}  // namespace gpu_planning_scene::core
