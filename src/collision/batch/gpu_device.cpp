#include <utility>
#include <vector>

#include "collision/batch/batch.h"
#include "collision/batch/batch_device.h"
#include "collision/gpu/gpu_checker.h"

namespace gpu_planning_scene::core
{
namespace
{
/// The parts of a batch on their way to a GPU and back.
class GpuParts : public PartSource
{
 public:
  GpuParts(const GpuChecker& checker, Batch& batch, std::size_t device, const BatchDevice::Take& take)
    : checker_(checker), batch_(batch), device_(device), take_(take)
  {
  }

  StateRange take(std::size_t most) override { return take_(most); }
  void bring(const StateRange& part, const std::uint32_t* verdicts) override
  {
    batch_.noteWork(device_, checker_.lastWork());  // before the batch may end
    undecided_.clear();
    undecided_.reserve(part.count);  // now, because nothing may fail after beginAnswer
    const StateRange states = batch_.beginAnswer(device_, part);
    if (states.count == 0)
      return;
    BatchResult& result = batch_.result();
    for (std::size_t i = 0; i < states.count; ++i)
      if (isHit(verdicts[i]))
      {
        result.valid[states.begin + i] = 0;
        result.colliding[states.begin + i] = checker_.bodiesOf(verdicts[i]);
      }
      else if (!isFree(verdicts[i]))
        undecided_.push_back(states.begin + i);
    batch_.endAnswer(states, undecided_);
  }

 private:
  const GpuChecker& checker_;
  Batch& batch_;
  const std::size_t device_;
  const BatchDevice::Take& take_;
  std::vector<std::size_t> undecided_;
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

  void check(Batch& batch, std::size_t device, const Take& take) override
  {
    GpuParts parts(checker_, batch, device, take);
    checker_.check(batch.deviceRows().states, parts, batch.margins());
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
