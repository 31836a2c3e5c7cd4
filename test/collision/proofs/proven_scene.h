#pragma once

#include <map>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "collision/bounds/problem_maker.h"
#include "collision/cpu/lanes/lane_scene.h"
#include "collision/exact/forest_cache.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
/// A scene with its proofs, and the exact checker.
struct ProvenScene
{
  TestScene scene;
  std::shared_ptr<const CollisionProblem> problem;
  ForestCache forest;
  std::unique_ptr<const ExactChecker> exact;
  std::shared_ptr<const RobotProofs> proofs;
  std::unique_ptr<const LaneScene> lanes;

  /// For GpuChecker::useProofs.
  std::shared_ptr<const LaneScene> ofDevice() const
  {
    return std::make_shared<const LaneScene>(*scene.scene->robot, *problem, *forest.forest(), proofs,
                                             lanes::kDeviceRounding);
  }
};

/// A scene with its proofs, made now or loaded from the user's cache.
inline ProvenScene prove(const TestScene& scene)
{
  ProvenScene made;
  made.scene = scene;
  made.problem = std::make_shared<const CollisionProblem>(makeProblem(*scene.scene, "", nullptr));
  made.exact = made.forest.exactCheckerOf(made.problem);
  RobotProver prover;
  const auto publish = [&made](RobotProofs proofs)
  { made.proofs = std::make_shared<const RobotProofs>(std::move(proofs)); };
  prover.prove(*scene.scene->robot, *made.problem, made.forest.forest(), ProofCache::ofUser(), publish,
               [] { return false; });
  made.lanes =
      std::make_unique<const LaneScene>(*scene.scene->robot, *made.problem, *made.forest.forest(), made.proofs);
  return made;
}

/// A scene by its name, with its proofs. They are made or loaded once per process.
inline const ProvenScene& provenScene(const std::string& name)
{
  static std::map<std::string, ProvenScene> kept;
  const auto found = kept.find(name);
  return found != kept.end() ? found->second : kept.emplace(name, prove(testScene(name))).first->second;
}

/// Tests of proofs. They are one suite, hence one process: making the proofs takes seconds.
class ProvenScenes : public testing::TestWithParam<const char*>
{
 protected:
  void SetUp() override
  {
    if (const std::string missing = missingFor(GetParam()); !missing.empty())
      GTEST_SKIP() << "there is no " << missing;
    proven_ = &provenScene(GetParam());
  }

  const RobotModel& robot() const { return *proven_->scene.scene->robot; }

  const ProvenScene* proven_ = nullptr;
};
}  // namespace gpu_planning_scene::core
