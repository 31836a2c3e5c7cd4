#include "gpu_planning_scene/cpu_checker.h"

#include <chrono>
#include <mutex>
#include <optional>
#include <shared_mutex>

#include "collision/checkers/change_gate.h"
#include "collision/checkers/cpu_scene.h"
#include "collision/problem/state_validation.h"
#include "model/seconds_since.h"

namespace gpu_planning_scene::core
{
struct CpuChecker::Impl
{
  explicit Impl(const CheckerOptions& options) : on_cpu(options) {}

  ChangeGate gate;  // checks share it; setScene holds it alone
  CpuScene on_cpu;
};

CpuChecker::CpuChecker(std::shared_ptr<const PlanningScene> scene, const CheckerOptions& options)
  : impl_(std::make_unique<Impl>(options))
{
  CpuChecker::setScene(std::move(scene));
}

CpuChecker::~CpuChecker() = default;

void CpuChecker::setScene(std::shared_ptr<const PlanningScene> scene)
{
  const std::lock_guard<ChangeGate> lock(impl_->gate);
  impl_->on_cpu.setScene(std::move(scene));
  impl_->on_cpu.prepare("");
}

BatchResult CpuChecker::check(const double* states, std::size_t count, const std::string& group,
                              const JointNeighbourhood* around)
{
  const std::shared_lock<ChangeGate> lock(impl_->gate);
  validateStates(*impl_->on_cpu.scene()->robot, states, count);
  BatchResult result;
  result.revision = impl_->on_cpu.scene()->revision;
  const auto start = std::chrono::steady_clock::now();
  std::optional<Margins> margins;
  if (around)
    margins = impl_->on_cpu.margins(*around, states, count, group);
  impl_->on_cpu.check(states, count, group, result, margins ? &*margins : nullptr);
  result.seconds = secondsSince(start);
  return result;
}

SceneReport CpuChecker::report(const std::string& group)
{
  const std::shared_lock<ChangeGate> lock(impl_->gate);
  return impl_->on_cpu.report(group);
}

std::string CpuChecker::deviceName() const
{
  return "CPU";
}
}  // namespace gpu_planning_scene::core
