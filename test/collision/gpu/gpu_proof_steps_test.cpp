// The first step of the proofs on the device, compared with C++ in double: the lists of open pairs.

#include <set>

#include <gtest/gtest.h>

#include "collision/gpu/gpu_pair_checker.h"
#include "collision/gpu/problem/gpu_kinematics.h"
#include "collision/gpu/proofs/gpu_proofs.h"
#include "collision/proofs/proven_scene.h"
#include "gpu/egl_context.h"
#include "gpu/program.h"
#include "shader_constants.h"
#include "support/repetitions.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::uint32_t kStatesOfStep = repetitions(800U, 2000U);

/// A pair in a state.
using OpenPair = std::pair<std::uint32_t, std::uint32_t>;

/// The verdicts of the states, and the lists of open pairs.
struct StepResult
{
  std::vector<std::uint32_t> verdicts;
  std::set<OpenPair> self_pairs;
  std::set<OpenPair> world_pairs;
};

class ProofSteps : public testing::TestWithParam<const char*>
{
 protected:
  void SetUp() override
  {
    if (const std::string missing = missingFor(GetParam()); !missing.empty())
      GTEST_SKIP() << "there is no " << missing;
    proven_ = &provenScene(GetParam());
    lanes_ = std::make_unique<const LaneScene>(*proven_->scene.scene->robot, *proven_->problem,
                                               *proven_->forest.forest(), proven_->proofs, lanes::kDeviceRounding);
    states_ = proven_->scene.randomStates(kStatesOfStep, kSeed);
  }

  static std::set<OpenPair> readList(const Buffer& list, const std::vector<std::uint32_t>& counters, std::size_t place)
  {
    const std::uint32_t count = counters[place + LIST_LENGTH];
    EXPECT_EQ(counters[place], (count + GROUP_SIZE - 1) / GROUP_SIZE) << "work groups of a dispatch over the list";
    std::vector<OpenPair> entries(count);
    if (count > 0)
      list.read(entries.data(), entries.size() * sizeof(OpenPair));
    std::set<OpenPair> found(entries.begin(), entries.end());
    EXPECT_EQ(found.size(), entries.size()) << "a pair is listed twice";
    return found;
  }

  StepResult run() const
  {
    const EglContext context("auto");
    const std::string folder = shaderFolder();
    GpuProofs proofs(folder, "");
    proofs.set(*lanes_);
    GpuKinematics kinematics(folder, proven_->scene.scene->robot);
    BatchLists lists({});
    lists.reserve(kStatesOfStep, TexelBuffer::maxBytes());
    lists.clearCounters();
    Buffer verdicts(kStatesOfStep * sizeof(std::uint32_t));
    verdicts.clear();
    lists.counters.bindStorage(BINDING_COUNTERS);
    verdicts.bindStorage(BINDING_VERDICTS);
    kinematics.setStates(states_.data());
    kinematics.begin(0, kStatesOfStep);
    proofs.start({kStatesOfStep, static_cast<std::uint32_t>(proven_->problem->robot.size()), 0}, lists);
    std::vector<std::uint32_t> counters(COUNTER_WORDS);
    lists.counters.read(counters.data(), counters.size() * sizeof(std::uint32_t));
    EXPECT_EQ(counters[COUNTER_OVERFLOW], 0U);
    StepResult result{std::vector<std::uint32_t>(kStatesOfStep),
                      readList(lists.open_self_pairs, counters, LIST_OPEN_SELF_PAIRS),
                      readList(lists.open_world_pairs, counters, LIST_OPEN_WORLD_PAIRS)};
    verdicts.read(result.verdicts.data(), kStatesOfStep * sizeof(std::uint32_t));
    return result;
  }

  /// The centre of the enclosing ball of each instance, relative to the origin of the scene.
  std::vector<Eigen::Vector3d> centersOf(std::size_t state) const
  {
    const RobotModel& robot = *proven_->scene.scene->robot;
    std::vector<Eigen::Isometry3d> links(robot.links().size());
    robot.linkPoses(&states_[state * robot.variables().size()], links.data());
    std::vector<Eigen::Vector3d> centers;
    for (std::size_t i = 0; i < proven_->problem->robot.size(); ++i)
    {
      const ShapeInstance& instance = proven_->problem->robot[i];
      const CoverBall& ball = proven_->proofs->covers[i]->levels[0].front();
      centers.emplace_back(links[static_cast<std::size_t>(instance.link)] * instance.pose * ball.center -
                           proven_->problem->origin);
    }
    return centers;
  }

  double outerOf(std::uint32_t instance) const { return proven_->proofs->covers[instance]->levels[0].front().outer; }

  const ProvenScene* proven_ = nullptr;
  std::unique_ptr<const LaneScene> lanes_;
  std::vector<double> states_;
};

/// The steps of the boxes of world pairs are smaller (metres).
constexpr double kStep = 2e-4;

/// How far beyond its reach a pair may be open: the threshold and as much rounding as it allows for.
double allowed(const lanes::Thresholds& thresholds)
{
  return 2.0 * static_cast<double>(thresholds.enclosing) + kStep;
}

TEST_P(ProofSteps, LeaveExactlyThePairsOpenWhoseEnclosingBallsAreNear)
{
  const StepResult result = run();
  const lanes::Model& model = lanes_->model();
  std::size_t compared = 0;
  for (std::uint32_t state = 0; state < kStatesOfStep; ++state)
  {
    const std::vector<Eigen::Vector3d> centers = centersOf(state);
    for (std::uint32_t p = model.tables.count; p < model.self_pairs.count; ++p)
    {
      const auto [a, b] = lanes_->instancesOf(p);
      const double beyond = (centers[a] - centers[b]).norm() - outerOf(a) - outerOf(b);
      const bool is_open = result.self_pairs.count({state, p}) > 0;
      // A state that a table decides has no further pairs, so states with a hit are left out.
      EXPECT_TRUE(is_open || beyond > 0.0 || isHit(result.verdicts[state]))
          << "state " << state << ", pair " << p << ", " << beyond << " m, seed " << kSeed;
      EXPECT_TRUE(!is_open || beyond < allowed(model.self_pairs[p].thresholds))
          << "state " << state << ", pair " << p << ", " << beyond << " m";
      ++compared;
    }
    for (std::uint32_t w = 0; w < model.world_pairs.count; ++w)
    {
      const auto a = lanes_->instancesOf(model.self_pairs.count + w)[0];
      const double beyond = lanes_->worldBounds()[w].exteriorDistance(centers[a]) - outerOf(a);
      const bool is_open = result.world_pairs.count({state, w}) > 0;
      EXPECT_TRUE(is_open || beyond > 0.0 || isHit(result.verdicts[state]))
          << "state " << state << ", world pair " << w << ", " << beyond << " m, seed " << kSeed;
      EXPECT_TRUE(!is_open || beyond < allowed(model.world_pairs[w].thresholds))
          << "state " << state << ", world pair " << w << ", " << beyond << " m";
      ++compared;
    }
  }
  EXPECT_GT(compared, 0U);
  EXPECT_GT(result.self_pairs.size() + result.world_pairs.size(), kStatesOfStep / 10);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ProofSteps, testing::Values("kr5", "ur5_cage", "arm_boxes", "panda_boxes"));
}  // namespace
}  // namespace gpu_planning_scene::core
