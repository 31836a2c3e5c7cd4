// The contract on the GPU with both traversals: required distances, half-spaces and solids. The poses are farther from
// the thresholds than the errors of float32, so the GPU itself must decide.

#include <map>

#include <gtest/gtest.h>

#include "collision/gpu/gpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "support/shader_folder.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d at(double x, double y = 0.0, double z = 0.0)
{
  return Isometry3d(Eigen::Translation3d(x, y, z));
}

/// Adds a shape at `pose` to a mesh; `inverted`: with the triangles' orientation reversed.
void append(Mesh& mesh, const Shape& shape, const Isometry3d& pose, bool inverted = false)
{
  const auto part = tessellate(shape).mesh;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vector3d& vertex : part->vertices)
    mesh.vertices.push_back(pose * vertex);
  for (auto t : part->triangles)
  {
    if (inverted)
      std::swap(t[0], t[1]);
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
}

std::shared_ptr<const Mesh> meshOf(const Shape& shape, bool inverted = false)
{
  auto mesh = std::make_shared<Mesh>();
  append(*mesh, shape, Isometry3d::Identity(), inverted);
  return mesh;
}

class GpuContract : public testing::TestWithParam<Traversal>
{
 protected:
  BatchCheckerOptions options() const
  {
    BatchCheckerOptions options;
    options.traversal = GetParam();
    return options;
  }

  /// A problem with a robot of one link with one shape, and an empty world.
  static CollisionProblem problemOf(const Shape& moving)
  {
    CollisionProblem problem;
    problem.shapes = {moving};
    problem.tessellations = {tessellate(moving)};
    problem.robot = {{0, 0, 0, Isometry3d::Identity()}};
    return problem;
  }
  static void addObject(CollisionProblem& problem, const Shape& shape, const Isometry3d& pose, double padding = 0.0)
  {
    problem.shapes.push_back(shape);
    problem.tessellations.push_back(tessellate(shape));
    const auto number = static_cast<std::uint32_t>(problem.world.size() + 1);
    problem.world.push_back({number, static_cast<std::int32_t>(number), -1, pose, padding});
    problem.world_pairs.push_back(1);
  }

  static void TearDownTestSuite() { checkers().clear(); }

  /// The suite's checker for this traversal. To start one takes longer than most tests.
  GpuChecker& checker() const { return checkers().try_emplace(GetParam(), options()).first->second; }

  BatchResult check(const CollisionProblem& problem, const std::vector<Isometry3d>& poses)
  {
    GpuChecker& checker = this->checker();
    checker.setProblem(std::make_shared<const CollisionProblem>(problem));
    BatchResult result;
    checker.checkPoses(
        poses.size(), 1, [&](std::size_t row, Isometry3d* pose) { *pose = poses[row]; }, result);
    return result;
  }
  /// 1 for each pose in which the moving shape is free. Expects that no state is undecided.
  std::vector<int> freeAt(const CollisionProblem& problem, const std::vector<Isometry3d>& poses)
  {
    const BatchResult result = check(problem, poses);
    EXPECT_EQ(result.undecided_states, 0U);
    return {result.valid.begin(), result.valid.end()};
  }

 private:
  static std::map<Traversal, GpuChecker>& checkers()
  {
    static std::map<Traversal, GpuChecker> checkers;
    return checkers;
  }
};

TEST_P(GpuContract, PaddingIsATrueDistanceOfBothBodies)
{
  CollisionProblem problem = problemOf(Box{{0.2, 0.2, 0.2}});
  problem.robot[0].padding = 0.03;
  addObject(problem, Box{{0.2, 0.2, 0.2}}, at(1.0), 0.02);
  // Face to face, the distance is along x. Corner to corner, boxes with faces moved outwards by the padding would
  // collide too early.
  const double diagonal = 0.2 + 0.05 / std::sqrt(3.0);
  const auto beside = [](double offset) { return at(1.0 - offset, -offset, -offset); };
  EXPECT_EQ(freeAt(problem, {at(0.7499), at(0.7501), at(1.2501), at(1.2499), beside(diagonal - 1e-4),
                             beside(diagonal + 1e-4), at(1.01)}),
            (std::vector<int>{1, 0, 1, 0, 0, 1, 0}));
}

TEST_P(GpuContract, PaddingDoesNotCountBetweenLinks)
{
  CollisionProblem problem = problemOf(Box{{0.2, 0.2, 0.2}});
  problem.robot[0].padding = 0.05;
  problem.robot.push_back({0, 1, 1, at(0.0), 0.05});
  problem.self_pairs = {{0, 1}};
  GpuChecker& checker = this->checker();
  checker.setProblem(std::make_shared<const CollisionProblem>(problem));
  BatchResult result;
  checker.checkPoses(
      2, 2,
      [](std::size_t row, Isometry3d* poses)
      {
        poses[0] = at(0.0);
        poses[1] = at(row == 0 ? 0.2001 : 0.1999);
      },
      result);
  EXPECT_EQ(result.valid, (std::vector<std::uint8_t>{1, 0}));
}

TEST_P(GpuContract, AHalfSpaceHoldsAllBelowItsPlane)
{
  CollisionProblem problem = problemOf(Sphere{0.1});
  problem.robot[0].padding = 0.01;
  const Vector3d normal = Vector3d(1.0, 2.0, 2.0) / 3.0;
  problem.half_spaces = {{1, normal, 0.5, 0.02}, {2, Vector3d::UnitZ(), 100.0}};
  problem.half_space_pairs = {1, 0};
  problem.origin = {0.3, -0.2, 0.1};
  const auto height = [&](double above) { return Isometry3d(Eigen::Translation3d((0.5 + above) * normal)); };
  EXPECT_EQ(freeAt(problem, {height(0.1303), height(0.1297), height(0.0), height(-5.0)}),
            (std::vector<int>{1, 0, 0, 0}));
  EXPECT_EQ(check(problem, {height(0.0)}).colliding[0], (BodyPair{0, 1}));
}

TEST_P(GpuContract, NoneOfManyHalfSpacesIsForgotten)
{
  // A sheet just above most of the planes. Each plane makes the traversal as long as possible, and a device may limit
  // the total iterations of an invocation.
  auto sheet = std::make_shared<Mesh>();
  constexpr int kCells = 50;
  for (int i = 0; i <= kCells; ++i)
    for (int j = 0; j <= kCells; ++j)
      sheet->vertices.emplace_back(0.02 * i - 0.5, 0.02 * j - 0.5, -(0.02 * i - 0.5) - (0.02 * j - 0.5));
  for (std::uint32_t i = 0; i < kCells; ++i)
    for (std::uint32_t j = 0; j < kCells; ++j)
    {
      const std::uint32_t corner = i * (kCells + 1) + j;
      sheet->triangles.push_back({corner, corner + kCells + 1, corner + 1});
      sheet->triangles.push_back({corner + 1, corner + kCells + 1, corner + kCells + 2});
    }
  CollisionProblem problem = problemOf(Shape(std::shared_ptr<const Mesh>(sheet)));
  const Vector3d parallel = Vector3d::Ones().normalized();
  for (std::int32_t k = 0; k < 40; ++k)
    problem.half_spaces.push_back({k + 1, parallel, -1e-4});
  problem.half_spaces.push_back({41, Vector3d::UnitZ(), 0.0});
  problem.half_space_pairs.assign(problem.half_spaces.size(), 1);
  EXPECT_EQ(check(problem, {at(0.0)}).valid, (std::vector<std::uint8_t>{0}));
}

TEST_P(GpuContract, ShapesInsideAClosedMeshCollideForBothOrientations)
{
  for (const bool inverted : {false, true})
    for (const Shape& inner : {Shape(Box{{0.05, 0.06, 0.07}}), Shape(meshOf(Box{{0.05, 0.06, 0.07}})),
                               Shape(Sphere{0.03}), Shape(meshOf(Sphere{0.03}))})
    {
      CollisionProblem problem = problemOf(inner);
      addObject(problem, meshOf(Box{{0.4, 0.4, 0.4}}, inverted), at(0.5, 0.011, 0.013));
      EXPECT_EQ(freeAt(problem, {at(0.5), at(0.41), at(0.9), at(0.5, 0.0, 0.35)}), (std::vector<int>{0, 0, 1, 1}));
      // The shapes exchanged: the shell moves.
      CollisionProblem swapped = problemOf(meshOf(Box{{0.4, 0.4, 0.4}}, inverted));
      addObject(swapped, inner, at(0.5, 0.011, 0.013));
      EXPECT_EQ(freeAt(swapped, {at(0.5), at(0.41), at(0.9)}), (std::vector<int>{0, 0, 1}));
    }
}

TEST_P(GpuContract, ACavityIsFreeAndAnOpenMeshHoldsNothing)
{
  auto hollow = std::make_shared<Mesh>();
  append(*hollow, Box{{0.6, 0.6, 0.6}}, at(0.0));
  append(*hollow, Box{{0.4, 0.4, 0.4}}, at(0.0), true);
  auto open = std::make_shared<Mesh>(*meshOf(Box{{0.6, 0.6, 0.6}}));
  open->triangles.resize(10);  // a box without one of its faces
  auto beside_a_closed_one = std::make_shared<Mesh>(*open);
  append(*beside_a_closed_one, Box{{0.1, 0.1, 0.1}}, at(2.0, 0.01, 0.01));
  for (const auto& [shell, expected] :
       {std::pair(hollow, std::vector<int>{1, 0, 1}), std::pair(open, std::vector<int>{1, 1, 1}),
        std::pair(beside_a_closed_one, std::vector<int>{1, 1, 1})})
  {
    CollisionProblem problem = problemOf(meshOf(Sphere{0.02}));
    addObject(problem, Shape(std::shared_ptr<const Mesh>(shell)), at(0.0));
    EXPECT_EQ(freeAt(problem, {at(0.011, 0.012, 0.013), at(0.251, 0.012, 0.013), at(0.011, -0.012, -0.013)}), expected);
  }
}

std::shared_ptr<const Mesh> triangleMesh(const Vector3d& a, const Vector3d& b, const Vector3d& c)
{
  auto mesh = std::make_shared<Mesh>();
  mesh->vertices = {a, b, c};
  mesh->triangles = {{0, 1, 2}};
  return mesh;
}

/// Very short axes have squares that underflow, and thus length 0 in float32. The required distance must still count
/// along such axes.
TEST_P(GpuContract, AxesTooShortForFloatsProveNothing)
{
  for (const double width : {1e-18, 1e-20, 1e-23, 1e-26, 1e-28})
  {
    const auto nearly_along_x = triangleMesh({-0.1, 0.0, 0.0}, {0.1, width, 0.0}, {0.0, 0.1, 0.0});
    for (const Shape& solid : {Shape(Box{{0.1, 0.1, 0.1}}), Shape(Cylinder{0.05, 0.1}), Shape(Sphere{0.05})})
    {
      CollisionProblem problem = problemOf(nearly_along_x);
      addObject(problem, solid, at(0.0), 0.08);
      EXPECT_EQ(check(problem, {at(0.0, 0.0, 0.1)}).valid[0], 0) << width;
      problem = problemOf(solid);
      addObject(problem, nearly_along_x, at(0.0, 0.0, 0.1), 0.08);
      EXPECT_EQ(check(problem, {at(0.0)}).valid[0], 0) << width;
    }
    CollisionProblem problem = problemOf(triangleMesh({-0.1, -0.1, 0.0}, {0.1, -0.1, 0.0}, {0.0, 0.1, 0.0}));
    addObject(problem, triangleMesh({0.0, 0.0, 0.0}, {1e-8, 0.0, 0.0}, {0.0, width * 1e8, 0.0}), at(0.0), 0.15);
    EXPECT_EQ(check(problem, {at(0.0, 0.0, 0.1)}).valid[0], 0) << width;
  }
}

TEST_P(GpuContract, TheOriginChangesNoAnswerFarFromTheWorlds)
{
  CollisionProblem problem = problemOf(meshOf(Box{{0.2, 0.2, 0.2}}));
  addObject(problem, meshOf(Box{{0.2, 0.2, 0.2}}), at(1e5 + 0.5, 2e5, 0.0));
  problem.origin = {1e5, 2e5, 0.0};
  EXPECT_EQ(freeAt(problem, {at(1e5 + 0.2999, 2e5), at(1e5 + 0.3001, 2e5 + 0.01, 0.02)}), (std::vector<int>{1, 0}));
}

/// In float32, the slope of the first cone is infinite, and that of the second one is 0.
TEST_P(GpuContract, AVeryFlatOrThinConeHasTheVerdictsOfItsTriangles)
{
  const auto triangle = std::make_shared<Mesh>();
  triangle->vertices = {{0.0, 0.0, 0.0}, {0.001, 0.0, 0.0}, {0.0, 0.001, 0.001}};
  triangle->triangles = {{0, 1, 2}};
  CollisionProblem flat = problemOf(triangle);
  addObject(flat, Cone{0.1, 1e-46}, at(0.0), 0.01);
  EXPECT_EQ(freeAt(flat, {at(0.1, 0.1, 0.005), at(0.0, 0.0, 0.02), at(0.05, 0.0, 0.005)}), (std::vector<int>{1, 1, 0}));
  CollisionProblem thin = problemOf(triangle);
  addObject(thin, Cone{1e-46, 0.2}, at(0.0), 0.01);
  EXPECT_EQ(freeAt(thin, {at(0.02, 0.0, 0.05), at(0.0, 0.0, -0.12), at(0.005, 0.0, -0.05)}),
            (std::vector<int>{1, 1, 0}));
}

TEST_P(GpuContract, ADeviceWhoseDotProductsAreNotNumbersIsReported)
{
  ShaderFolder folder;
  folder.replace("self_test/float_arithmetic.comp", "dot(vec3(x, y, x), vec3(y, y, x))", "sqrt(-1.0 - x * x)");
  BatchCheckerOptions other = options();
  other.shader_folder = folder.path();
  EXPECT_NE(GpuChecker(other).fault().find("dot product"), std::string::npos);
}

TEST_P(GpuContract, ADeviceWithOtherArithmeticIsReportedAndAnswersAreRightAllTheSame)
{
  ShaderFolder folder;
  folder.replace("self_test/float_arithmetic.comp", "4097.0 * x", "1.0 * x");
  BatchCheckerOptions other = options();
  other.shader_folder = folder.path();
  GpuChecker checker(other);
  EXPECT_NE(checker.fault().find("two-product"), std::string::npos) << checker.fault();
  CollisionProblem problem = problemOf(meshOf(Sphere{0.1}));
  addObject(problem, meshOf(Box{{0.2, 0.2, 0.2}}), at(0.5));
  checker.setProblem(std::make_shared<const CollisionProblem>(problem));
  BatchResult result;
  checker.checkPoses(
      3, 1, [](std::size_t row, Isometry3d* pose) { *pose = at(row == 0   ? 0.1
                                                               : row == 1 ? 0.29
                                                                          : 0.35); }, result);
  EXPECT_EQ(result.valid, (std::vector<std::uint8_t>{1, 1, 0}));
  EXPECT_GE(result.undecided_states, 1U);  // at least the last state
  EXPECT_EQ(GpuChecker(options()).fault(), "");
}

INSTANTIATE_TEST_SUITE_P(Traversals, GpuContract, testing::Values(Traversal::BreadthFirst, Traversal::WorkQueue),
                         [](const auto& tested)
                         { return tested.param == Traversal::BreadthFirst ? "BreadthFirst" : "WorkQueue"; });
}  // namespace
}  // namespace gpu_planning_scene::core
