// Overflowing lists and stacks and exhausted iterations cost time, but change no answer. The problem has one mesh, as a
// link and as three objects.

#include <algorithm>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "collision/exact/exact_checker.h"
#include "collision/gpu/gpu_checker.h"
#include "collision/gpu/gpu_pair_checker.h"
#include "collision/gpu/problem/uploaded_poses.h"
#include "collision/gpu/recorded_verdicts.h"
#include "gpu/egl_context.h"
#include "shader_constants.h"
#include "support/seed.h"
#include "support/shader_folder.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kStates = 300;

/// A wavy closed surface that is not convex, so that answers depend on triangles.
std::shared_ptr<const Mesh> wavySphere()
{
  auto mesh = std::make_shared<Mesh>(*tessellate(Sphere{0.05}).mesh);
  for (Eigen::Vector3d& vertex : mesh->vertices)
    vertex *= 1.0 + 0.2 * std::sin(120.0 * vertex.x()) * std::sin(90.0 * vertex.z());
  return mesh;
}

std::shared_ptr<const CollisionProblem> problem()
{
  auto made = std::make_shared<CollisionProblem>();
  const auto mesh = wavySphere();
  made->shapes = {mesh};
  made->tessellations = {tessellate(mesh)};
  made->robot = {{0, 0, 0, Eigen::Isometry3d::Identity()}};
  for (int i = 0; i < 3; ++i)
    made->world.push_back({0, 1 + i, -1, Eigen::Isometry3d(Eigen::Translation3d(0.11 * i, 0.0, 0.0))});
  made->world_pairs = {1, 1, 1};
  return made;
}

class BatchLimits : public testing::TestWithParam<Traversal>
{
 protected:
  void SetUp() override
  {
    std::mt19937_64 generator(kSeed);
    std::uniform_real_distribution<double> uniform(-0.13, 0.13);
    for (std::size_t i = 0; i < kStates; ++i)
      poses_.emplace_back(Eigen::Translation3d(uniform(generator), uniform(generator), uniform(generator)));
  }

  /// The verdicts of the GPU alone, with lists of given capacities.
  std::vector<std::uint32_t> verdictsWith(const ListCapacities& capacities)
  {
    EglContext context("auto");
    GpuPairChecker checker(folder_.path(), GetParam(), kStates, capacities);
    checker.setProblem(*problem_);
    const UploadedPoses::LinkPoses link_poses = [&](std::size_t row, Eigen::Isometry3d* pose) { *pose = poses_[row]; };
    UploadedPoses poses(*problem_, 1, link_poses);
    RecordedVerdicts recorded(kStates);
    checker.check(poses, recorded, nullptr);
    EXPECT_EQ(recorded.brought, std::vector<int>(kStates, 1)) << "each verdict is brought once";
    return recorded.words;
  }

  /// The result of the whole checker with the shaders of folder_.
  BatchResult resultWithChangedShaders()
  {
    BatchCheckerOptions options;
    options.traversal = GetParam();
    options.shader_folder = folder_.path();
    GpuChecker checker(options);
    checker.setProblem(problem_);
    BatchResult result;
    checker.checkPoses(
        kStates, 1, [&](std::size_t row, Eigen::Isometry3d* pose) { *pose = poses_[row]; }, result);
    return result;
  }

  std::vector<std::uint8_t> validOnCpu()
  {
    BatchCheckerOptions options;
    EglContext context("auto");
    GpuScene scene(shaderFolder());
    scene.setProblem(*problem_);
    const ExactChecker exact(problem_, std::make_shared<const Forest>(scene.readForest()));
    ExactChecker::Scratch scratch;
    std::vector<std::uint8_t> valid;
    for (const Eigen::Isometry3d& pose : poses_)
      valid.push_back(exact.firstCollision(&pose, scratch) ? 0 : 1);
    return valid;
  }

  /// Gives a constant another value in one shader, so that no other program is compiled again.
  void define(const std::string& shader, const std::string& name, const std::string& value) const
  {
    const std::string include = "#include \"shader_constants.h\"\n";
    folder_.replace(shader, include, include + "#undef " + name + "\n#define " + name + " " + value + "\n");
  }

  ShaderFolder folder_;
  std::shared_ptr<const CollisionProblem> problem_ = problem();
  std::vector<Eigen::Isometry3d> poses_;
};

/// Limits that only the work queues have.
class QueueLimits : public BatchLimits
{
};

TEST_P(BatchLimits, ListsThatOverflowSplitTheBatch)
{
  const auto roomy = verdictsWith({});
  // Room for a single state, but not for all states.
  ListCapacities tight;
  tight.candidates = 16;
  tight.root_pairs = 16;
  tight.node_pairs = 40000;
  tight.leaf_pairs = 40000;
  const auto split = verdictsWith(tight);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < kStates; ++i)
  {
    // The order of the tests decides whether a state with a hit also has an undecided pair.
    EXPECT_EQ(isHit(split[i]), isHit(roomy[i])) << "state " << i;
    EXPECT_EQ(isFree(split[i]), isFree(roomy[i])) << "state " << i;
    hits += isHit(roomy[i]) ? 1 : 0;
  }
  EXPECT_GT(hits, kStates / 10);
  EXPECT_LT(hits, kStates * 9 / 10);
}

/// The roots of these trees are leaves, so the list of node pairs stays empty.
TEST_P(BatchLimits, RootPairsMayOutnumberNodePairs)
{
  const auto mesh = std::make_shared<Mesh>();
  mesh->vertices = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.1}, {0.0, 1.0, -0.1}};
  mesh->triangles = {{0, 1, 2}};
  auto crossing = std::make_shared<CollisionProblem>();
  crossing->shapes = {mesh};
  crossing->tessellations = {tessellate(mesh)};
  crossing->robot = {{0, 0, 0, Eigen::Isometry3d::Identity()}};
  crossing->world = {
      {0, 1, -1, Eigen::Isometry3d(Eigen::AngleAxisd(1.5, Eigen::Vector3d(1.0, 1.0, 0.2).normalized()))}};
  crossing->world_pairs = {1};
  problem_ = crossing;
  for (Eigen::Isometry3d& pose : poses_)
    pose.translation() = 0.1 * pose.translation() + Eigen::Vector3d(0.1, 0.1, 0.0);
  const std::vector<std::uint8_t> valid = validOnCpu();
  ListCapacities few_node_pairs;
  few_node_pairs.node_pairs = 1;
  const auto verdicts = verdictsWith(few_node_pairs);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < kStates; ++i)
  {
    EXPECT_TRUE(!isFree(verdicts[i]) || valid[i] != 0) << "state " << i;
    hits += isHit(verdicts[i]) ? 1 : 0;
  }
  EXPECT_GT(hits, kStates / 4);
}

TEST_P(BatchLimits, AStateThatOverflowsAloneIsUndecided)
{
  ListCapacities none;
  none.candidates = 1;
  none.root_pairs = 1;
  none.node_pairs = 1;
  none.leaf_pairs = 1;
  const auto roomy = verdictsWith({});
  const auto verdicts = verdictsWith(none);
  std::size_t undecided = 0;
  for (std::size_t i = 0; i < kStates; ++i)
  {
    const bool hit = isHit(verdicts[i]);
    EXPECT_TRUE(!hit || isHit(roomy[i])) << "state " << i;
    EXPECT_TRUE(!isFree(verdicts[i]) || isFree(roomy[i])) << "state " << i;
    undecided += !hit && !isFree(verdicts[i]) ? 1 : 0;
  }
  EXPECT_GT(undecided, 0U);
}

TEST_P(QueueLimits, StacksThatAreTooShortSpill)
{
  define("traversal/work_queue.comp", "QUEUE_STACK", "2");
  EXPECT_EQ(resultWithChangedShaders().valid, validOnCpu());
}

TEST_P(QueueLimits, WorkThatIsLeftWhenTheIterationsRunOutIsHandedOn)
{
  define("traversal/work_queue.comp", "INVOCATION_ITERATIONS", "100");
  EXPECT_EQ(resultWithChangedShaders().valid, validOnCpu());
}

TEST_P(QueueLimits, WorkThatIsHandedOnAfterEachRoundIsFinishedByTheLastPass)
{
  define("traversal/work_queue.comp", "QUEUE_LAST_ROUNDS", "0");
  EXPECT_EQ(resultWithChangedShaders().valid, validOnCpu());
  EXPECT_EQ(resultWithChangedShaders().undecided_states, 0U);
}

TEST_P(BatchLimits, AWalkThroughTheWorldThatTakesTooLongIsUndecided)
{
  define("broad_phase/world_pairs.comp", "INVOCATION_ITERATIONS", "2");
  const BatchResult result = resultWithChangedShaders();
  EXPECT_EQ(result.valid, validOnCpu());
  EXPECT_GT(result.undecided_states, 0U);
}

TEST_P(QueueLimits, InvocationsThatTheDeviceEndsEarlyAreNoticed)
{
  // Ends every invocation silently before it does anything, as llvmpipe ends invocations after too many iterations.
  std::string text = readShader(folder_.path(), "traversal/work_queue.comp");
  const std::string begin = "void main()\n{\n";
  const auto at = text.rfind(begin);
  ASSERT_NE(at, std::string::npos);
  text.insert(at + begin.size(), "  if (gl_NumWorkGroups.x > 0u) return;\n");
  folder_.write("traversal/work_queue.comp", text);
  const BatchResult result = resultWithChangedShaders();
  EXPECT_EQ(result.valid, validOnCpu());
  EXPECT_GT(result.undecided_states, 0U);
}

TEST_P(BatchLimits, ListsThatGrowWhileTheDeviceWorksChangeNoAnswer)
{
  const auto once = verdictsWith({});
  const EglContext context("auto");
  GpuPairChecker checker(folder_.path(), GetParam(), 16384, {}, std::numeric_limits<double>::infinity());
  checker.setProblem(*problem_);
  const UploadedPoses::LinkPoses link_poses = [&](std::size_t row, Eigen::Isometry3d* pose)
  { *pose = poses_[row % kStates]; };
  UploadedPoses poses(*problem_, 1, link_poses);
  constexpr std::size_t kMany = 40 * kStates;
  RecordedVerdicts recorded(kMany);
  checker.check(poses, recorded, nullptr);
  const std::vector<std::size_t>& parts = recorded.parts;
  const std::vector<std::uint32_t>& verdicts = recorded.words;
  EXPECT_GT(*std::max_element(parts.begin(), parts.end()), parts.front());
  for (std::size_t i = 0; i < kMany; ++i)
  {
    EXPECT_EQ(isHit(verdicts[i]), isHit(once[i % kStates])) << "state " << i;
    EXPECT_EQ(isFree(verdicts[i]), isFree(once[i % kStates])) << "state " << i;
  }
}

/// A source of poses that writes at most kMost states at once.
class FewPoses : public UploadedPoses
{
 public:
  static constexpr std::size_t kMost = 70;
  using UploadedPoses::UploadedPoses;
  std::size_t maxStates() const override { return kMost; }
};

TEST_P(BatchLimits, APartHasNoMoreStatesThanTheSourceOfThePosesWrites)
{
  const auto once = verdictsWith({});
  const EglContext context("auto");
  GpuPairChecker checker(folder_.path(), GetParam(), kStates, {}, std::numeric_limits<double>::infinity());
  checker.setProblem(*problem_);
  const UploadedPoses::LinkPoses link_poses = [&](std::size_t row, Eigen::Isometry3d* pose) { *pose = poses_[row]; };
  FewPoses poses(*problem_, 1, link_poses);
  RecordedVerdicts recorded(kStates);
  checker.check(poses, recorded, nullptr);
  const std::vector<std::uint32_t>& verdicts = recorded.words;
  EXPECT_EQ(recorded.parts, (std::vector<std::size_t>{70, 70, 70, 70, 20}));
  for (std::size_t i = 0; i < kStates; ++i)
  {
    EXPECT_EQ(isHit(verdicts[i]), isHit(once[i])) << "state " << i;
    EXPECT_EQ(isFree(verdicts[i]), isFree(once[i])) << "state " << i;
  }
}

TEST(BatchLists, GrowWithThePartsUpToALimit)
{
  const EglContext context("auto");
  ListCapacities fixed;
  fixed.leaf_pairs = 7;
  BatchLists lists(fixed);
  constexpr std::size_t kMaxBytes = 8'000'000;
  const auto holds = [](const TexelBuffer& list, std::size_t entries, std::size_t texels)
  { return list.buffer().size() >= entries * texels * TexelBuffer::kTexelBytes; };
  const auto fit = [&lists, &holds]
  {
    return holds(lists.candidates, lists.capacity.candidates / 2, 1) &&
           holds(lists.root_pairs, lists.capacity.root_pairs, ROOT_PAIR_TEXELS) &&
           holds(lists.node_pairs[0], lists.capacity.node_pairs, 1) &&
           holds(lists.node_pairs[1], lists.capacity.node_pairs, 1);
  };
  lists.reserve(100, kMaxBytes);
  const ListCapacities small = lists.capacity;
  EXPECT_TRUE(fit());
  lists.reserve(1000, kMaxBytes);
  EXPECT_GT(lists.capacity.candidates, small.candidates);
  EXPECT_GT(lists.capacity.root_pairs, small.root_pairs);
  EXPECT_GT(lists.capacity.node_pairs, small.node_pairs);
  EXPECT_EQ(lists.capacity.leaf_pairs, 7U);
  EXPECT_TRUE(fit());
  lists.reserve(100'000, kMaxBytes);
  EXPECT_EQ(lists.capacity.node_pairs, kMaxBytes / TexelBuffer::kTexelBytes);
  EXPECT_TRUE(fit());
  lists.reserve(100, kMaxBytes);
  EXPECT_EQ(lists.capacity.node_pairs, kMaxBytes / TexelBuffer::kTexelBytes) << "lists do not shrink";
}

INSTANTIATE_TEST_SUITE_P(Traversals, BatchLimits, testing::Values(Traversal::BreadthFirst, Traversal::WorkQueue),
                         [](const auto& parameter)
                         { return parameter.param == Traversal::WorkQueue ? "WorkQueue" : "BreadthFirst"; });
INSTANTIATE_TEST_SUITE_P(Traversals, QueueLimits, testing::Values(Traversal::WorkQueue));
}  // namespace
}  // namespace gpu_planning_scene::core
