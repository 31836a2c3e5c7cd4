#include "benchmark/method.h"
#include "collision/bounds/problem_maker.h"
#include "collision/exact/forest_cache.h"
#include "gpu/program.h"
#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "support/shader_folder.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
class CheckerMethod : public Method
{
 public:
  explicit CheckerMethod(std::unique_ptr<StateChecker> checker) : checker_(std::move(checker)) {}

  std::vector<std::uint8_t> check(const double* states, std::size_t count) override
  {
    BatchResult result = checker_->check(states, count);
    undecided_ = result.undecided_states;
    device_share_ = static_cast<double>(result.device_states) / static_cast<double>(std::max<std::size_t>(1, count));
    return std::move(result.valid);
  }
  bool update(const std::shared_ptr<const PlanningScene>& scene) override
  {
    checker_->setScene(scene);
    return true;
  }
  std::size_t undecided() const override { return undecided_; }

 protected:
  StateChecker& checker() { return *checker_; }
  double deviceShareOfLastCheck() const { return device_share_; }

 private:
  std::unique_ptr<StateChecker> checker_;
  std::size_t undecided_ = 0;
  double device_share_ = 0.0;
};

/// Only the CPU: the exact checker, with or without proofs for most states.
class CpuMethod : public CheckerMethod
{
 public:
  CpuMethod(const std::shared_ptr<const PlanningScene>& scene, const CheckerOptions& options)
    : CheckerMethod(std::make_unique<CpuChecker>(scene, options)), scene_(scene)
  {
  }

  bool update(const std::shared_ptr<const PlanningScene>& scene) override
  {
    scene_ = scene;
    return CheckerMethod::update(scene);
  }
  /// Counts the work of the checker on one core. The order of pairs is learned during these checks.
  WorkPerState work(const double* states, std::size_t count) override
  {
    const RobotModel& robot = *scene_->robot;
    const auto exact = ForestCache().exactCheckerOf(
        std::make_shared<const CollisionProblem>(ProblemMaker(CheckerOptions()).make(*scene_, "", nullptr)));
    ExactChecker::Scratch scratch;
    std::vector<Eigen::Isometry3d> poses(robot.links().size());
    for (std::size_t i = 0; i < count; ++i)
    {
      robot.linkPoses(states + i * robot.variables().size(), poses.data());
      exact->firstCollision(poses.data(), scratch);
    }
    WorkPerState work;
    work.node_visits = static_cast<double>(scratch.pair.steps) / static_cast<double>(count);
    return work;
  }

 private:
  std::shared_ptr<const PlanningScene> scene_;
};

/// A BatchChecker: only the device, or device and cores together.
class BatchMethod : public CheckerMethod
{
 public:
  explicit BatchMethod(std::unique_ptr<BatchChecker> checker) : CheckerMethod(std::move(checker)) {}

  WorkPerState work(const double* states, std::size_t count) override
  {
    check(states, count);
    const GpuWork done = batchChecker().lastWork();
    const auto all = static_cast<double>(done.states);
    WorkPerState work;
    if (done.states > 0)
      work = {NAN, static_cast<double>(done.candidates) / all, static_cast<double>(done.root_pairs) / all,
              static_cast<double>(done.traversed) / all};
    return work;
  }

 protected:
  BatchChecker& batchChecker() { return static_cast<BatchChecker&>(checker()); }
};

class ChoosingMethod : public BatchMethod
{
 public:
  using BatchMethod::BatchMethod;
  std::optional<double> deviceShare() override { return deviceShareOfLastCheck(); }
};

/// Only the CPU.
MethodInfo onCpu(const std::string& name, const std::string& title, bool proofs)
{
  CheckerOptions options;
  options.reductions.proofs = proofs;
  MethodInfo info;
  info.name = name;
  info.title = title;
  info.family = "exact checker";
  info.exact = true;
  info.responsive = true;
  info.make = [options](const auto& scene, const MethodOptions&)
  { return std::make_unique<CpuMethod>(scene, options); };
  return info;
}

BatchCheckerOptions batchOptions(const MethodOptions& options)
{
  BatchCheckerOptions made;
  made.device = options.device;
  if (options.max_batch != 0)
    made.max_batch = options.max_batch;
  return made;
}

/// Only the GPU, with one traversal. `proofs`: whether joint tables and balls decide pairs before trees do.
MethodInfo onGpu(const std::string& name, const std::string& title, Traversal traversal, bool proofs)
{
  MethodInfo info;
  info.name = name;
  info.title = title;
  info.family = "ours";
  info.exact = true;
  info.batched = true;
  info.responsive = true;
  info.in_quick_run = proofs;
  info.make = [traversal, proofs](const auto& scene, const MethodOptions& options)
  {
    BatchCheckerOptions made = batchOptions(options);
    made.traversal = traversal;
    made.reductions.proofs = proofs;
    made.device_only = true;
    return std::make_unique<BatchMethod>(std::make_unique<BatchChecker>(scene, made));
  };
  return info;
}

/// The default for users: GPU and CPU together, or the CPU if there is no GPU.
MethodInfo automatic()
{
  MethodInfo info;
  info.name = "ours_auto";
  info.title = "ours, exact";
  info.family = "ours";
  info.exact = true;
  info.batched = true;
  info.responsive = true;
  info.make = [](const auto& scene, const MethodOptions& options)
  { return std::make_unique<ChoosingMethod>(std::make_unique<BatchChecker>(scene, batchOptions(options))); };
  return info;
}

/// A common form of a GPU check: the same shaders with error bounds of 0. Pairs that touch to the last bit or take too
/// many steps are still undecided. They are reported as collisions.
class UnfilteredFloat : public Method
{
 public:
  UnfilteredFloat(const std::shared_ptr<const PlanningScene>& scene, BatchCheckerOptions options)
    : shaders_(shaderFolder())
  {
    shaders_.define("UNIT_ROUNDOFF", "0.0");
    shaders_.define("CONTRACT_BAND", "0.0");
    shaders_.replace("traversal/verdicts.glsl", "if ((found & STATE_HIT) != 0u)",
                     "found = found != 0u ? STATE_HIT : 0u;\n  if (found != 0u)");
    options.shader_folder = shaders_.path();
    options.device_only = true;
    checker_ = std::make_unique<BatchMethod>(std::make_unique<BatchChecker>(scene, options));
  }

  std::vector<std::uint8_t> check(const double* states, std::size_t count) override
  {
    return checker_->check(states, count);
  }
  std::size_t undecided() const override { return checker_->undecided(); }
  WorkPerState work(const double* states, std::size_t count) override { return checker_->work(states, count); }

 private:
  ShaderFolder shaders_;
  std::unique_ptr<BatchMethod> checker_;
};
}  // namespace

std::vector<MethodInfo> ourMethods()
{
  std::vector<MethodInfo> methods;
  methods.push_back(onCpu("exact_cpu", "exact checker, CPU", true));
  methods.push_back(onCpu("exact_cpu_no_proofs", "exact checker, CPU, no proofs", false));
  methods.push_back(automatic());
  methods.push_back(onGpu("ours_work_queue", "ours, work queues", Traversal::WorkQueue, true));
  methods.push_back(onGpu("ours_breadth_first", "ours, breadth-first", Traversal::BreadthFirst, true));
  methods.push_back(onGpu("ours_work_queue_no_proofs", "ours, work queues, no proofs", Traversal::WorkQueue, false));
  MethodInfo floats;
  floats.name = "ours_float32";
  floats.title = "ours, float32 only";
  floats.family = "float32 only";
  floats.make = [](const auto& scene, const MethodOptions& options)
  { return std::make_unique<UnfilteredFloat>(scene, batchOptions(options)); };
  methods.push_back(floats);
  return methods;
}
}  // namespace gpu_planning_scene::core::benchmark
