#include <utility>
#include <vector>

#include "collision/batch/batch_device.h"
#include "collision/batch/device_parts.h"
#include "collision/gpu/gpu_checker.h"

namespace gpu_planning_scene::core
{
namespace
{
/// The parts of a batch on their way to a GPU and back.
class GpuParts : public PartSource
{
 public:
  GpuParts(const GpuChecker& checker, DeviceParts& parts) : checker_(checker), parts_(parts) {}

  StateRange take(std::size_t most) override { return parts_.take(most); }
  void copy(const StateRange& states, double* to) override { parts_.copy(states, to); }
  void bring(const StateRange& brought, const std::uint32_t* verdicts, const GpuWork& work) override
  {
    parts_.add(work);  // before the batch may end
    const StateRange states = parts_.beginAnswer(brought);
    if (states.count == 0)
      return;
    std::vector<std::size_t> undecided;
    try
    {
      undecided = checker_.write(states, verdicts, parts_.result());
    }
    catch (const std::exception&)  // no memory
    {
      return parts_.failAnswer(std::current_exception());
    }
    parts_.endAnswer(states, undecided);
  }

 private:
  const GpuChecker& checker_;
  DeviceParts& parts_;
};

class GpuDevice : public BatchDevice
{
 public:
  explicit GpuDevice(const BatchCheckerOptions& options) : checker_(options) {}

  void prepare(const DeviceTask& task) override
  {
    if (task.scene != scene_)
    {
      scene_.reset();
      checker_.setProblem(task.scene, task.robot);
      scene_ = group_ = task.scene;
    }
    if (task.group != group_)
    {
      group_.reset();
      checker_.selectPairs(task.group);
      group_ = task.group;
    }
    checker_.useProofs(task.proofs);
  }

  void check(DeviceParts& parts) override
  {
    GpuParts source(checker_, parts);
    checker_.check(source, parts.margins());
  }

  std::string name() const override { return checker_.device().renderer; }
  bool isSoftware() const override { return checker_.device().software; }
  std::string fault() const override { return checker_.fault(); }

 private:
  GpuChecker checker_;
  std::shared_ptr<const CollisionProblem> scene_;  // what the checker holds; null: unknown
  std::shared_ptr<const CollisionProblem> group_;
};
}  // namespace

std::unique_ptr<BatchDevice> openGpuDevice(const BatchCheckerOptions& options)
{
  return std::make_unique<GpuDevice>(options);
}
}  // namespace gpu_planning_scene::core
