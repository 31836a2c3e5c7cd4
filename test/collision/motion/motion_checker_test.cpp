// Motions that collide are rejected, also between samples under the bound rule. The part of a motion that is reported
// as free is free.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/motion_checker.h"
#include "model/model_testing.h"
#include "support/repetitions.h"
#include "support/seed.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr char kLimit[] = "<limit lower='-2' upper='2' effort='1' velocity='1'/>";

/// A small box that moves along x and y.
std::shared_ptr<const RobotModel> pointRobot()
{
  return robotOf(
      "<link name='base'/><link name='rail'/><link name='tip'><collision><geometry><box size='0.02 0.02 0.02'/>"
      "</geometry></collision></link>" +
      jointXml("x", "prismatic", "base", "rail", std::string("<axis xyz='1 0 0'/>") + kLimit) +
      jointXml("y", "prismatic", "rail", "tip", std::string("<axis xyz='0 1 0'/>") + kLimit));
}

WorldObject wall(double x, double thickness, double y, double width)
{
  WorldObject object;
  object.id = "wall at " + std::to_string(x);
  object.pose = Eigen::Translation3d(x, y, 0.0);
  object.shapes = {{Box{{thickness, width, 1.0}}}};
  return object;
}

class PointMotions : public testing::Test
{
 protected:
  MotionChecker checker(MotionRule rule, double step, std::size_t max_samples = 20000) const
  {
    MotionCheckerOptions options;
    options.rule = rule;
    options.steps = {step, step};
    options.max_samples = max_samples;
    return {std::make_shared<CpuChecker>(scene_), scene_->robot, "", options};
  }

  static MotionVerdict verdict(const MotionChecker& checker, const std::vector<double>& from,
                               const std::vector<double>& to, bool last_valid = false)
  {
    return checker.check(from.data(), to.data(), 1, last_valid ? MotionQuery::LastValid : MotionQuery::Valid).front();
  }

  std::shared_ptr<PlanningScene> scene_ = std::make_shared<PlanningScene>(pointRobot());
};

/// Collisions of the links that only other joints move are not checked for a group.
TEST(MotionsOfAGroup, OfOtherJointsAreRefused)
{
  const auto robot =
      robotOf(boxLink("base") + boxLink("left") + boxLink("right") +
                  jointXml("l", "prismatic", "base", "left", std::string("<axis xyz='1 0 0'/>") + kLimit) +
                  jointXml("r", "prismatic", "base", "right", std::string("<axis xyz='0 1 0'/>") + kLimit),
              "<group name='arm'><joint name='l'/></group>");
  const auto scene = std::make_shared<PlanningScene>(robot);
  const MotionChecker checker(std::make_shared<CpuChecker>(scene), robot, "arm", {});
  const std::vector<double> starts = {0.0, 0.0, 0.0, 0.0};
  std::vector<double> ends = {0.5, 0.0, 0.0, 0.5};
  EXPECT_EQ(errorOf([&] { checker.check(starts.data(), ends.data(), 2); }),
            "motion 1 moves r, which is not in group 'arm', so collisions of the links that it moves would not be "
            "found; check without a group, or with one that has this joint");
  EXPECT_EQ(checker.check(starts.data(), ends.data(), 1).size(), 1U);
}

/// Only some samples are checked before the proofs.
TEST_F(PointMotions, UnderTheBoundACollisionAtAnyOneSampleIsNamed)
{
  constexpr int kSamples = 50;
  for (int sample = 0; sample <= kSamples; ++sample)
  {
    const double at = static_cast<double>(sample) / kSamples;
    scene_->objects = {wall(at, 0.001, 0.0, 1.0)};
    const MotionVerdict found = verdict(checker(MotionRule::Bound, 1.0 / kSamples), {0.0, 0.0}, {1.0, 0.0});
    EXPECT_FALSE(found.valid) << sample;
    EXPECT_NE(found.colliding, kNoPair) << sample;
    // Every second sample is checked. Around the others, a neighbour is found that collides: within half of the box and
    // of the wall.
    EXPECT_NEAR(found.first_invalid, at, sample % 2 == 1 ? 1e-9 : 0.011) << sample;
  }
}

/// Batches are cut by time, and replicas cut them elsewhere.
TEST(MotionsInBatches, HaveTheVerdictsThatTheyHaveAlone)
{
  const char* const turns = "<axis xyz='0 0 1'/><limit lower='-3' upper='3' effort='1' velocity='1'/>";
  const std::string link =
      "<collision><origin xyz='0.25 0 0'/><geometry><box size='0.5 0.02 0.02'/></geometry></collision>";
  const auto robot =
      robotOf("<link name='base'/><link name='upper'>" + link + "</link><link name='fore'>" + link + "</link>" +
                  jointXml("shoulder", "revolute", "base", "upper", turns) +
                  jointXml("elbow", "revolute", "upper", "fore", std::string("<origin xyz='0.5 0 0'/>") + turns),
              "<disable_collisions link1='upper' link2='fore' reason='Adjacent'/>");
  const auto scene = std::make_shared<PlanningScene>(robot);
  scene->objects = {wall(0.6, 0.02, 0.5, 0.3)};
  const MotionChecker checker(std::make_shared<CpuChecker>(scene), robot, "", {});
  constexpr std::size_t kMotions = 300;
  std::mt19937_64 generator(kSeed);
  std::vector<double> starts(2 * kMotions);
  std::vector<double> ends(2 * kMotions);
  for (std::size_t i = 0; i < kMotions; ++i)
  {
    robot->randomState(generator, &starts[2 * i]);
    robot->randomState(generator, &ends[2 * i]);
  }
  const auto together = checker.check(starts.data(), ends.data(), kMotions, MotionQuery::LastValid);
  std::size_t valid = 0;
  for (std::size_t i = 0; i < kMotions; ++i)
  {
    const auto alone = checker.check(&starts[2 * i], &ends[2 * i], 1, MotionQuery::LastValid).front();
    EXPECT_EQ(alone.valid, together[i].valid) << "motion " << i << ", seed " << kSeed;
    EXPECT_EQ(alone.last_valid, together[i].last_valid) << "motion " << i << ", seed " << kSeed;
    EXPECT_EQ(alone.first_invalid, together[i].first_invalid) << "motion " << i << ", seed " << kSeed;
    valid += alone.valid ? 1 : 0;
  }
  EXPECT_GT(valid, kMotions / 10);
  EXPECT_LT(valid, kMotions * 9 / 10);
}

TEST_F(PointMotions, OnlyTheBoundRuleDetectsAThinWall)
{
  scene_->objects = {wall(0.512, 0.001, 0.0, 1.0)};
  for (const double step : {0.05, 0.2, 2.0})
  {
    EXPECT_TRUE(verdict(checker(MotionRule::Samples, step), {0.0, 0.0}, {1.0, 0.0}).valid) << step;
    const MotionVerdict bound = verdict(checker(MotionRule::Bound, step), {0.0, 0.0}, {1.0, 0.0}, true);
    EXPECT_FALSE(bound.valid) << step;
    EXPECT_LE(bound.last_valid, 0.5015) << step;
    EXPECT_EQ(bound.colliding, (BodyPair{2, 3})) << step;
  }
}

TEST_F(PointMotions, PassThroughAGapOfAMicrometreOnEachSide)
{
  scene_->objects = {wall(0.5, 0.1, 0.510001, 1.0), wall(0.5, 0.1, -0.510001, 1.0)};
  for (WorldObject& object : scene_->objects)
    object.id += std::to_string(object.pose.translation().y());
  EXPECT_TRUE(verdict(checker(MotionRule::Bound, 0.05, 2000000), {0.0, 0.0}, {1.0, 0.0}).valid);
}

TEST_F(PointMotions, AreRefusedWhereTheirSamplesDoNotProveThem)
{
  scene_->objects = {wall(0.5, 0.1, 0.510001, 1.0)};
  const MotionVerdict given_up = verdict(checker(MotionRule::Bound, 0.05, 300), {0.0, 0.0}, {1.0, 0.0}, true);
  EXPECT_FALSE(given_up.valid);
  EXPECT_EQ(given_up.colliding, (BodyPair{-1, -1}));
  EXPECT_GT(given_up.last_valid, 0.3);
  EXPECT_LT(given_up.last_valid, 0.5);
  // A gap so small that no sample proves the motion free.
  scene_->objects = {wall(0.5, 0.1, 0.51 + 2e-9, 1.0)};
  EXPECT_FALSE(verdict(checker(MotionRule::Bound, 0.05, 2000000), {0.0, 0.0}, {1.0, 0.0}).valid);
}

TEST_F(PointMotions, AreGivenUpWhenTheCallHasNoChecksLeft)
{
  // The first motion needs thousands of checks beside the wall to be proven; the second needs few.
  scene_->objects = {wall(0.5, 0.1, 0.51001, 1.0)};
  const std::vector<double> starts = {0.0, 0.0, 0.0, -1.0};
  const std::vector<double> ends = {1.0, 0.0, 1.0, -1.0};
  for (const MotionRule rule : {MotionRule::Bound, MotionRule::Samples})
    for (const MotionQuery query : {MotionQuery::Valid, MotionQuery::LastValid, MotionQuery::Extension})
    {
      MotionCheckerOptions options;
      options.rule = rule;
      options.steps = {0.05, 0.05};
      const auto check = [&](std::size_t max_checks)
      {
        options.max_checks = max_checks;
        const MotionChecker checker(std::make_shared<CpuChecker>(scene_), scene_->robot, "", options);
        const auto verdicts = checker.check(starts.data(), ends.data(), 2, query);
        EXPECT_LE(checker.statesChecked(), max_checks);
        return std::pair(verdicts, checker.statesChecked());
      };
      const auto [all, needed] = check(1000000);
      for (const MotionVerdict& verdict : all)
      {
        EXPECT_TRUE(verdict.valid);
        EXPECT_FALSE(verdict.given_up);
      }
      EXPECT_TRUE(check(needed).first[0].valid) << "the limit itself is allowed";
      for (std::size_t max_checks = 0; max_checks < needed; max_checks += 1 + needed / 50)
      {
        const std::vector<MotionVerdict> verdicts = check(max_checks).first;
        EXPECT_TRUE(verdicts[0].given_up || verdicts[1].given_up) << max_checks;
        for (const MotionVerdict& verdict : verdicts)
        {
          EXPECT_NE(verdict.given_up, verdict.valid) << max_checks;
          EXPECT_EQ(verdict.colliding, kNoPair);
          EXPECT_LE(verdict.last_valid, verdict.valid ? 1.0 : 0.999) << max_checks;
        }
      }
    }
}

TEST_F(PointMotions, EndTheirLastValidPartBeforeTheFirstCollision)
{
  scene_->objects = {wall(0.8, 0.1, 0.0, 1.0), wall(0.4, 0.1, 0.0, 1.0)};
  for (const MotionRule rule : {MotionRule::Samples, MotionRule::Bound})
  {
    const MotionVerdict found = verdict(checker(rule, 0.02), {0.0, 0.0}, {1.0, 0.0}, true);
    EXPECT_FALSE(found.valid);
    EXPECT_LT(found.last_valid, 0.34);
    EXPECT_GT(found.last_valid, 0.28);
    EXPECT_EQ(verdict(checker(rule, 0.02), {0.0, 0.0}, {0.3, 0.1}, true).last_valid, 1.0);
    EXPECT_EQ(verdict(checker(rule, 0.02), {0.4, 0.0}, {0.0, 0.0}, true).last_valid, 0.0);
    EXPECT_FALSE(verdict(checker(rule, 0.02), {0.4, 0.0}, {0.0, 0.0}).valid);
    EXPECT_FALSE(verdict(checker(rule, 0.02), {0.0, 0.0}, {0.4, 0.0}).valid);
    EXPECT_TRUE(verdict(checker(rule, 0.02), {0.0, 0.0}, {0.0, 0.0}).valid);
  }
}

/// A checker in which a state collides if its first variable has one of the values in hits.
class ScriptedChecker : public StateChecker
{
 public:
  void setScene(std::shared_ptr<const PlanningScene> /*scene*/) override {}
  BatchResult checkBatch(const StateBatch& batch) override
  {
    BatchResult result;
    for (std::size_t i = 0; i < batch.count; ++i)
    {
      const bool collides =
          std::any_of(hits.begin(), hits.end(), [&](double hit) { return std::abs(batch.states[2 * i] - hit) < 1e-6; });
      result.valid.push_back(collides ? 0 : 1);
      result.colliding.push_back(collides ? BodyPair{2, static_cast<std::int32_t>(i)} : kNoPair);
    }
    return result;
  }
  SceneReport report(const std::string& /*group*/) override { return {}; }
  std::string deviceName() const override { return "scripted"; }

  std::vector<double> hits;
};

/// All states are free. A neighbourhood is proven free or not by chance, but always alike. Records the neighbourhoods.
class ChanceChecker : public StateChecker
{
 public:
  struct Proof
  {
    std::vector<double> state;
    std::vector<double> center;
    std::vector<JointTravel> travel;
    double spread;
    bool is_proven;
  };

  explicit ChanceChecker(std::shared_ptr<const RobotModel> robot) : robot_(std::move(robot)) {}
  void setScene(std::shared_ptr<const PlanningScene> /*scene*/) override {}
  BatchResult checkBatch(const StateBatch& batch) override
  {
    const auto& [states, count, group, around, go_on] = batch;
    const std::size_t width = robot_->variables().size();
    const std::size_t joints = robot_->joints().size();
    BatchResult result;
    for (std::size_t i = 0; i < count; ++i)
    {
      bool is_proven = true;
      if (around)
      {
        const auto row = static_cast<std::ptrdiff_t>(around->rows[i]);
        const auto travel = around->travel.begin() + row * static_cast<std::ptrdiff_t>(joints);
        const auto center = around->centers.begin() + row * static_cast<std::ptrdiff_t>(width);
        Proof proof{{states + i * width, states + (i + 1) * width},
                    {center, center + static_cast<std::ptrdiff_t>(width)},
                    {travel, travel + static_cast<std::ptrdiff_t>(joints)},
                    around->spread,
                    true};
        std::seed_seq seed{std::lround(1e6 * proof.state[0]), std::lround(1e6 * proof.travel[0].length)};
        std::minstd_rand generator(seed);
        is_proven = proof.is_proven = std::bernoulli_distribution(0.65)(generator);
        proofs.push_back(std::move(proof));
      }
      result.valid.push_back(is_proven ? 1 : 0);
      result.colliding.push_back(kNoPair);
    }
    return result;
  }
  SceneReport report(const std::string& /*group*/) override { return {}; }
  std::string deviceName() const override { return "chance"; }

  std::vector<Proof> proofs;

 private:
  std::shared_ptr<const RobotModel> robot_;
};

class MotionsByChance : public testing::Test
{
 protected:
  /// A joint that slides from 0 to 1, and one that turns.
  static std::shared_ptr<const RobotModel> slider()
  {
    return robotOf(boxLink("base") + boxLink("cart") + boxLink("tip") +
                   jointXml("slide", "prismatic", "base", "cart", kLimit) +
                   jointXml("turn", "continuous", "cart", "tip", "<axis xyz='0 0 1'/>"));
  }

  MotionVerdict verdictOf(double step, std::size_t max_samples, MotionQuery query)
  {
    checker_->proofs.clear();
    MotionCheckerOptions options;
    options.steps = {10.0, step};
    options.max_samples = max_samples;
    return MotionChecker(checker_, robot_, "", options).check(from_.data(), to_.data(), 1, query).front();
  }

  std::shared_ptr<const RobotModel> robot_ = slider();
  std::shared_ptr<ChanceChecker> checker_ = std::make_shared<ChanceChecker>(robot_);
  const std::vector<double> from_{0.0, 3.0};
  const std::vector<double> to_{1.0, -2.5};  // turns through pi
};

TEST_F(MotionsByChance, AreProvenAlongTheirWholeLengthFromNeighbourhoodsNearTheirCentre)
{
  std::size_t valid = 0;
  for (std::size_t segments = 1; segments <= 40; ++segments)
  {
    SCOPED_TRACE(segments);
    const bool is_valid = verdictOf(1.000001 / static_cast<double>(segments), 20000, MotionQuery::Valid).valid;
    valid += is_valid ? 1 : 0;
    std::vector<std::pair<double, double>> proven;  // fractions of the motion
    for (const ChanceChecker::Proof& proof : checker_->proofs)
    {
      const std::vector<JointTravel> off = jointTravel(*robot_, proof.center.data(), proof.state.data());
      for (std::size_t j = 0; j < off.size(); ++j)
      {
        EXPECT_LE(off[j].length, proof.spread * proof.travel[j].length + 1e-12);
        EXPECT_LE(off[j].angle, proof.spread * proof.travel[j].angle + 1e-12);
      }
      if (proof.is_proven)
        proven.emplace_back(proof.state[0] - proof.travel[0].length, proof.state[0] + proof.travel[0].length);
    }
    if (!is_valid)
      continue;
    std::sort(proven.begin(), proven.end());
    double end = 0.0;
    for (const auto& [begin, next] : proven)
    {
      EXPECT_LE(begin, end + 1e-12) << "a part of the motion is not proven";
      end = std::max(end, next);
    }
    EXPECT_GE(end, 1.0 - 1e-12);
  }
  EXPECT_GT(valid, 30U);
}

TEST_F(MotionsByChance, HaveTheSameVerdictForBothQueriesWhateverTheLimitOfSamples)
{
  std::size_t rejected = 0;
  for (std::size_t segments = 20; segments <= 60; segments += 5)
    for (std::size_t max_samples = segments + 1; max_samples < 4 * segments; ++max_samples)
    {
      const double step = 1.000001 / static_cast<double>(segments);
      const bool is_valid = verdictOf(step, max_samples, MotionQuery::Valid).valid;
      EXPECT_EQ(is_valid, verdictOf(step, max_samples, MotionQuery::LastValid).valid)
          << segments << " segments, at most " << max_samples;
      rejected += is_valid ? 0 : 1;
    }
  EXPECT_GT(rejected, 10U);
}

TEST_F(PointMotions, AreJudgedByTheFirstSampleThatCollides)
{
  const auto scripted = std::make_shared<ScriptedChecker>();
  MotionCheckerOptions options;
  options.rule = MotionRule::Samples;
  options.steps = {1.0, 0.25000001};
  const MotionChecker checker(scripted, scene_->robot, "", options);
  const std::vector<double> starts = {0.0, 0.0, 0.0, 1.0};  // two motions of five samples
  const std::vector<double> ends = {0.0, 1.0, 1.0, 1.0};
  for (unsigned hits = 0; hits < 32; ++hits)  // all combinations of colliding samples
  {
    scripted->hits.clear();
    for (unsigned i = 0; i < 5; ++i)
      if ((hits >> i & 1u) != 0)
        scripted->hits.push_back(0.25 * i);
    unsigned first = 0;
    while (first < 5 && (hits >> first & 1u) == 0)
      ++first;
    const MotionVerdict verdict = checker.check(starts.data(), ends.data(), 2, MotionQuery::LastValid).at(1);
    EXPECT_EQ(verdict.valid, first == 5) << hits;
    EXPECT_EQ(verdict.last_valid, first == 5 ? 1.0 : first == 0 ? 0.0 : (first - 1) / 4.0) << hits;
    EXPECT_EQ(verdict.first_invalid, first == 5 ? 1.0 : first / 4.0) << hits;
    EXPECT_EQ(verdict.colliding == kNoPair, first == 5) << hits;
  }
}

TEST_F(PointMotions, ThatCollideHaveTheirPairAlsoIfTheChecksThenEnd)
{
  const auto scripted = std::make_shared<ScriptedChecker>();
  scripted->hits = {1.0};
  MotionCheckerOptions options;
  options.steps = {1.0, 0.25};
  options.max_checks = 1;  // the end is checked first
  const std::vector<double> start = {0.0, 0.0};
  const std::vector<double> end = {1.0, 0.0};
  const MotionVerdict verdict =
      MotionChecker(scripted, scene_->robot, "", options).check(start.data(), end.data(), 1).front();
  EXPECT_FALSE(verdict.valid);
  EXPECT_FALSE(verdict.given_up);
  EXPECT_EQ(verdict.first_invalid, 1.0);
  EXPECT_NE(verdict.colliding, kNoPair);
}

/// Steps of 0.25 make the samples 0, 0.25, 0.5, 0.75 and 1. A thin wall at each is found, except at the start.
TEST_F(PointMotions, ThatExtendATreeAreCheckedAtAllSamplesButTheStart)
{
  const std::vector<double> start = {0.0, 0.0};
  const std::vector<double> end = {1.0, 0.0};
  for (const MotionRule rule : {MotionRule::Samples, MotionRule::Bound})
    for (const double at : {0.0, 0.25, 0.5, 0.75, 1.0})
    {
      scene_->objects = {wall(at, 0.001, 0.0, 1.0)};
      const MotionVerdict found =
          checker(rule, 0.25).check(start.data(), end.data(), 1, MotionQuery::Extension).front();
      const auto what = [&] { return std::to_string(at) + (rule == MotionRule::Bound ? ", bound" : ", samples"); };
      EXPECT_EQ(found.valid, at == 0.0) << what();
      EXPECT_EQ(found.colliding == kNoPair, found.valid) << what();
      EXPECT_EQ(found.first_invalid, found.valid ? 1.0 : at) << what();
    }
}

TEST_F(PointMotions, ThatExtendATreeAreCheckedAtTheEndFirst)
{
  scene_->objects = {wall(1.0, 0.001, 0.0, 1.0), wall(0.5, 0.001, 0.0, 1.0)};
  const std::vector<double> starts = {0.0, 0.0, 0.0, 0.0};
  const std::vector<double> ends = {1.0, 0.0, 0.3, 0.0};
  const MotionChecker extensions = checker(MotionRule::Samples, 0.1);
  const std::vector<MotionVerdict> found = extensions.check(starts.data(), ends.data(), 2, MotionQuery::Extension);
  EXPECT_EQ(found[0].first_invalid, 1.0);
  EXPECT_TRUE(found[1].valid);
  EXPECT_EQ(extensions.statesChecked(), 4U) << "1; then 0.3, 0.1 and 0.2";
}

TEST_F(PointMotions, AreRefusedWhereStepsCutThemIntoTooManySamples)
{
  for (const MotionRule rule : {MotionRule::Samples, MotionRule::Bound})
  {
    const MotionVerdict found = verdict(checker(rule, 0.001, 500), {0.0, 0.0}, {1.0, 0.0}, true);
    EXPECT_FALSE(found.valid);
    EXPECT_EQ(found.last_valid, 0.0);
    const std::vector<double> start = {0.0, 0.0};
    const std::vector<double> end = {1.0, 0.0};
    EXPECT_FALSE(checker(rule, 0.001, 500).check(start.data(), end.data(), 1, MotionQuery::Extension).front().valid);
    EXPECT_TRUE(verdict(checker(rule, 0.001, 500), {0.0, 0.0}, {0.2, 0.0}).valid);
  }
}

TEST_F(PointMotions, AreNotValidWhereTheCallIsStoppedBeforeTheyAreDecided)
{
  scene_->objects = {wall(0.5, 0.1, 0.5101, 1.0)};
  const std::vector<double> starts = {0.0, 0.0, 0.0, 0.6};
  const std::vector<double> ends = {1.0, 0.0, 1.0, 0.6};  // the second motion collides
  const MotionChecker checking = checker(MotionRule::Bound, 0.05);
  for (const MotionQuery query : {MotionQuery::Valid, MotionQuery::LastValid})
  {
    int asked = 0;
    const auto check = [&](int batches)
    {
      asked = 0;
      return checking.check(starts.data(), ends.data(), 2, query, [&] { return asked++ == batches; });
    };
    EXPECT_TRUE(check(-1)[0].valid);
    const int needed = asked;
    EXPECT_GT(needed, 4);
    EXPECT_TRUE(check(needed)[0].valid);
    for (int batches = 0; batches < needed; ++batches)
    {
      const std::vector<MotionVerdict> verdicts = check(batches);
      EXPECT_FALSE(verdicts[0].valid) << batches;
      EXPECT_LT(verdicts[0].last_valid, 1.0) << batches;
      EXPECT_FALSE(verdicts[1].valid) << batches;
      EXPECT_LE(asked, batches + 1) << "asked again after it was stopped";
    }
  }
}

TEST_F(PointMotions, RefuseStepsThatAreNone)
{
  EXPECT_NE(errorOf([&] { checker(MotionRule::Bound, 0.0); }), "");
  EXPECT_NE(errorOf([&] { verdict(checker(MotionRule::Bound, 0.1), {0.0, NAN}, {1.0, 0.0}); }), "");
  EXPECT_EQ(motionRuleFromName("bound"), MotionRule::Bound);
  EXPECT_EQ(motionRuleFromName("samples"), MotionRule::Samples);
  EXPECT_EQ(errorOf([] { motionRuleFromName("exact"); }), "the motion rule is 'exact'; it must be samples or bound");
}

/// An arm of 1 m on a wheel that mimics a crank. The wheel turns in the direction of the crank, not in the shorter
/// direction.
TEST(MotionsOfFollowers, AreNotFreeWhereAFollowerSweepsThroughAWall)
{
  const auto robot = robotOf(
      "<link name='base'/><link name='crank'/><link name='wheel'><collision><origin xyz='0.5 0 0'/><geometry>"
      "<box size='1 0.02 0.02'/></geometry></collision></link>" +
      jointXml("turn", "revolute", "base", "crank",
               "<axis xyz='0 0 1'/><limit lower='-4' upper='4' effort='1' velocity='1'/>") +
      jointXml("follow", "continuous", "base", "wheel", "<axis xyz='0 0 1'/><mimic joint='turn' multiplier='1'/>"));
  auto scene = std::make_shared<PlanningScene>(robot);
  scene->objects = {wall(0.9, 0.02, 0.0005, 0.001)};
  const auto cpu = std::make_shared<CpuChecker>(scene);
  MotionCheckerOptions options;
  options.steps = {0.31, 0.31};  // 0 is not among the samples
  const MotionChecker checker(cpu, robot, "", options);
  const double from = -3.0;
  const double to = 3.05;
  const MotionVerdict found = checker.check(&from, &to, 1, MotionQuery::LastValid).front();
  EXPECT_FALSE(found.valid);
  EXPECT_GT(found.last_valid, 0.4);
  EXPECT_LT(found.last_valid, 0.5);
}

TEST(MotionsOfFollowers, OfARobotWithoutJointsAreItsState)
{
  const auto robot =
      robotOf("<link name='base'><collision><geometry><box size='1 1 1'/></geometry></collision></link>");
  auto scene = std::make_shared<PlanningScene>(robot);
  EXPECT_TRUE(MotionChecker(std::make_shared<CpuChecker>(scene), robot, "").check(nullptr, nullptr, 1).front().valid);
}

class RealMotions : public testing::TestWithParam<std::string>
{
};

TEST_P(RealMotions, ProvenPartsAreFreeAtTenTimesTheResolution)
{
  if (!missingFor(GetParam()).empty())
    GTEST_SKIP() << missingFor(GetParam()) << " is missing";
  const std::uint64_t seed = std::random_device()();
  const TestScene& test = testScene(GetParam());
  const RobotModel& robot = *test.scene->robot;
  const std::size_t width = robot.variables().size();
  const auto cpu = std::make_shared<CpuChecker>(test.scene);
  constexpr std::size_t kStates = repetitions(100, 400);
  const std::vector<double> random = test.randomStates(kStates, seed);
  const std::vector<std::uint8_t> free = cpu->check(random.data(), kStates).valid;
  std::vector<double> starts;
  std::vector<double> ends;
  for (std::size_t i = 0; i + 1 < kStates; ++i)
    if (free[i] != 0)
    {
      starts.insert(starts.end(), &random[i * width], &random[(i + 1) * width]);
      std::vector<double> end(width);
      interpolate(robot, &random[i * width], &random[(i + 1) * width], 0.2, end.data());
      ends.insert(ends.end(), end.begin(), end.end());
    }
  // Most short motions of KR5 are valid. This one is not, whatever the seed is.
  const auto collision = static_cast<std::size_t>(std::find(free.begin(), free.end(), 0) - free.begin());
  ASSERT_LT(collision, kStates) << "seed " << seed;
  ASSERT_FALSE(starts.empty()) << "seed " << seed;
  const std::vector<double> start(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(width));
  starts.insert(starts.end(), start.begin(), start.end());
  ends.insert(ends.end(), &random[collision * width], &random[collision * width] + width);
  const std::size_t count = starts.size() / width;
  MotionCheckerOptions options;
  const MotionChecker checker(cpu, test.scene->robot, "", options);
  const std::vector<MotionVerdict> verdicts = checker.check(starts.data(), ends.data(), count, MotionQuery::LastValid);
  const std::vector<MotionVerdict> without = checker.check(starts.data(), ends.data(), count);
  BatchCheckerOptions all_on_gpu;
  all_on_gpu.device_only = true;
  const auto gpu = std::make_shared<BatchChecker>(test.scene, all_on_gpu);
  const std::vector<MotionVerdict> on_gpu =
      MotionChecker(gpu, test.scene->robot, "", options).check(starts.data(), ends.data(), count);
  std::size_t valid = 0;
  std::vector<double> states;
  for (std::size_t i = 0; i < count; ++i)
  {
    EXPECT_EQ(without[i].valid, verdicts[i].valid) << "seed " << seed;
    EXPECT_EQ(on_gpu[i].valid, verdicts[i].valid) << "seed " << seed << ", on the GPU";
    valid += verdicts[i].valid ? 1 : 0;
    const double* const from = &starts[i * width];
    const double* const to = &ends[i * width];
    const double last = verdicts[i].last_valid;
    const auto parts = static_cast<std::size_t>(std::ceil(10.0 * last * segmentCount(robot, from, to, options.steps)));
    for (std::size_t k = 0; k <= parts && last > 0.0; ++k)
    {
      states.resize(states.size() + width);
      interpolate(robot, from, to, last * static_cast<double>(k) / static_cast<double>(parts),
                  &states[states.size() - width]);
    }
  }
  const std::vector<std::uint8_t> again = cpu->check(states.data(), states.size() / width).valid;
  EXPECT_EQ(std::count(again.begin(), again.end(), 0), 0) << "seed " << seed;
  EXPECT_GT(valid, 0U);
  EXPECT_LT(valid, count);
  std::cout << "seed " << seed << ": " << valid << " of " << count << " motions valid, " << again.size()
            << " states checked again" << std::endl;
}
INSTANTIATE_TEST_SUITE_P(Scenes, RealMotions, testing::Values("kr5", "wam", "ur5_cage", "ur5_bookshelf_thin"));

/// A rod of 1 m that turns, and a rod on it that turns 1000 times as fast.
class TurningRod : public testing::Test
{
 public:
  bool isFree(MotionRule rule, double from, double to) const
  {
    MotionCheckerOptions options;
    options.rule = rule;
    options.steps = {0.02, 0.02};
    const MotionChecker checker(std::make_shared<CpuChecker>(scene), scene->robot, "", options);
    return checker.check(&from, &to, 1).front().valid;
  }

  static std::string rod(const std::string& name)
  {
    return "<link name='" + name +
           "'><collision><origin xyz='0.5 0 0'/><geometry><box size='1 0.02 0.02'/></geometry>" + "</collision></link>";
  }

  static std::shared_ptr<const RobotModel> robotWith(const std::string& type, const std::string& follower)
  {
    return robotOf(
        "<link name='base'/>" + rod("rod") + rod("fast") +
            jointXml("turn", type, "base", "rod", "<axis xyz='0 0 1'/>" + std::string(type[0] == 'r' ? kWide : "")) +
            jointXml("follow", "continuous", "rod", "fast", "<origin xyz='1 0 1'/><axis xyz='0 0 1'/>" + follower),
        "<disable_collisions link1='rod' link2='fast' reason='User'/>");
  }

  static constexpr char kWide[] = "<limit lower='-1e10' upper='1e10' effort='1' velocity='1'/>";
  std::shared_ptr<PlanningScene> scene;
};

TEST_F(TurningRod, IsNotProvenFreeAtAnglesThatDoublesDoNotResolve)
{
  for (const std::string type : {"continuous", "revolute"})
  {
    const auto robot = robotWith(type, "<mimic joint='turn'/>");
    scene = std::make_shared<PlanningScene>(robot);
    for (const double angle : {2e9, -2e9, 1.1e6})
    {
      EXPECT_FALSE(isFree(MotionRule::Bound, angle, angle + 0.1)) << type << " " << angle;
      EXPECT_FALSE(isFree(MotionRule::Bound, angle - 0.1, angle)) << type << " " << angle;
      EXPECT_TRUE(isFree(MotionRule::Samples, angle, angle + 0.1)) << type << " " << angle;
    }
    for (const double angle : {0.0, 9.9e5, -9.9e5})
      EXPECT_TRUE(isFree(MotionRule::Bound, angle, angle + 0.1)) << type << " " << angle;
  }
}

TEST_F(TurningRod, IsNotProvenFreeIfAJointThatFollowsItTurnsTooFar)
{
  scene = std::make_shared<PlanningScene>(robotWith("continuous", "<mimic joint='turn' multiplier='-1000'/>"));
  EXPECT_FALSE(isFree(MotionRule::Bound, 1100.0, 1100.001));
  EXPECT_TRUE(isFree(MotionRule::Bound, 900.0, 900.001));
  scene = std::make_shared<PlanningScene>(robotWith("continuous", "<mimic joint='turn' offset='-2e6'/>"));
  EXPECT_FALSE(isFree(MotionRule::Bound, 0.0, 0.001));
}

TEST_F(TurningRod, TurnsAlsoAsPartOfAPlanarJoint)
{
  scene = std::make_shared<PlanningScene>(
      robotOf(rod("rod"), "<virtual_joint name='drive' type='planar' parent_frame='world' child_link='rod'/>"));
  MotionCheckerOptions options;
  options.steps = {0.02, 0.02};
  const MotionChecker checker(std::make_shared<CpuChecker>(scene), scene->robot, "", options);
  for (const auto& [angle, free] : std::vector<std::pair<double, bool>>{{2e9, false}, {9.9e5, true}})
  {
    const std::vector<double> from = {0.0, 0.0, angle};
    const std::vector<double> to = {0.1, 0.0, angle + 0.1};
    EXPECT_EQ(free, checker.check(from.data(), to.data(), 1).front().valid) << angle;
  }
}

TEST(MotionsOfBases, AreNotProvenFreeOutsideTheLimitsOfTheirTranslations)
{
  for (const std::string type : {"planar", "floating"})
  {
    const std::string y = type == "planar" ? "drive/y" : "drive/trans_y";
    RobotModelOptions options;
    options.joint_limits = {{y, -5.0, 5.0}};
    const auto robot = RobotModel::fromXml("<robot name='r'>" + boxLink("body") + "</robot>",
                                           "<robot name='r'><virtual_joint name='drive' type='" + type +
                                               "' parent_frame='world' child_link='body'/></robot>",
                                           options);
    const auto scene = std::make_shared<PlanningScene>(robot);
    const auto is_free = [&](MotionRule rule, double y_from, double y_to)
    {
      MotionCheckerOptions motions;
      motions.rule = rule;
      std::vector<double> from = robot->defaultState();
      std::vector<double> to = from;
      from[0] = 8.0;  // x has no limits
      from[1] = y_from;
      to[1] = y_to;
      const MotionChecker checker(std::make_shared<CpuChecker>(scene), robot, "", motions);
      return checker.check(from.data(), to.data(), 1).front().valid;
    };
    EXPECT_TRUE(is_free(MotionRule::Bound, -5.0, 5.0)) << type;
    EXPECT_FALSE(is_free(MotionRule::Bound, 0.0, 5.5)) << type;
    EXPECT_FALSE(is_free(MotionRule::Bound, -7.0, -8.0)) << type;
    EXPECT_TRUE(is_free(MotionRule::Samples, -7.0, -8.0)) << type;
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
