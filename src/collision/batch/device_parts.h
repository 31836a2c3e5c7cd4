#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "collision/batch/batch.h"

namespace gpu_planning_scene::core
{
/// A batch as one device sees it. Used on any thread of the device, one call at a time; `copy` on several at once.
class DeviceParts
{
 public:
  /// `share`: see Batch::takeForDevice. `progress` is called whenever the device has made progress.
  DeviceParts(std::shared_ptr<Batch> batch, std::size_t device, double share, std::function<void()> progress)
    : batch_(std::move(batch)), device_(device), share_(share), progress_(std::move(progress))
  {
  }
  virtual ~DeviceParts() = default;

  const Margins* margins() const { return batch_->margins(); }
  BatchResult& result() { return batch_->result(); }

  /// See Batch.
  void copy(const StateRange& states, double* to) { batch_->copyForDevice(states, to); }
  virtual StateRange take(std::size_t most)
  {
    progress_();
    return batch_->takeForDevice(device_, most, share_);
  }
  StateRange beginAnswer(const StateRange& states)
  {
    progress_();
    return batch_->beginAnswer(device_, states);
  }
  void endAnswer(const StateRange& states, const std::vector<std::size_t>& undecided)
  {
    batch_->endAnswer(states, undecided);
  }
  void failAnswer(std::exception_ptr error) { batch_->failAnswer(std::move(error)); }
  void add(const GpuWork& work) { batch_->add(work); }
  void giveBack() { batch_->giveBack(device_); }
  void leave() { batch_->leave(device_); }

 private:
  const std::shared_ptr<Batch> batch_;
  const std::size_t device_;
  const double share_;
  const std::function<void()> progress_;
};
}  // namespace gpu_planning_scene::core
