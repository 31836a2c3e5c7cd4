#pragma once

#include <algorithm>
#include <cstddef>

#include "interface.h"

namespace gpu_planning_scene
{
/// The most states of a part whose poses fit a buffer texture and whose dispatches have no more than MOST_LANES lanes.
/// `texture_bytes`: the most of a buffer texture; `searches`: of the larger of the two lists of the broad phase.
inline std::size_t mostStatesOfPart(std::size_t texture_bytes, std::size_t robot_instances, std::size_t searches)
{
  constexpr std::size_t kPoseBytes = 12 * sizeof(float);
  const std::size_t instances = std::max<std::size_t>(1, robot_instances);
  // Texels are counted in 31 bits.
  constexpr std::size_t kTexelBytes = 16;
  const std::size_t bytes = std::min(texture_bytes, (std::size_t{1} << 31) * kTexelBytes - kPoseBytes);
  const std::size_t by_poses = bytes / (instances * kPoseBytes);
  const std::size_t by_lanes = std::size_t{MOST_LANES} / std::max(instances, searches);
  return std::max<std::size_t>(1, std::min(by_poses, by_lanes));
}

/// How many states of a batch go to a device at once: as many as take it about kPartSeconds, fewer where its lists are
/// too short for them.
class PartSize
{
 public:
  /// `most`: states, at least 1.
  explicit PartSize(std::size_t most) : most_(most), limit_(most), size_(std::min(most, kFirstPart)) {}

  std::size_t size() const { return size_; }

  /// The scene, and what a device takes at once, may have changed.
  void setMost(std::size_t most)
  {
    most_ = limit_ = most;
    size_ = std::min(size_, limit_);
  }

  /// The lists were too short for so many. Parts that follow are likely to be like this one.
  void tooLarge(std::size_t count)
  {
    limit_ = std::max<std::size_t>(1, std::min(limit_, (count + 1) / 2));
    size_ = std::min(size_, limit_);
    good_parts_ = 0;
  }

  /// A part of `count` states took so long.
  void took(std::size_t count, double seconds)
  {
    // Later batches may be quite unlike the one whose parts were too large.
    if (++good_parts_ >= kPartsToForget)
    {
      limit_ = std::min(most_, 2 * limit_);
      good_parts_ = 0;
    }
    const double wanted = static_cast<double>(count) * kPartSeconds / std::max(seconds, 1e-6);
    if (wanted < static_cast<double>(size_))
      size_ = std::max<std::size_t>(1, static_cast<std::size_t>(wanted));
    else if (count == size_ && wanted >= 2.0 * static_cast<double>(count))
      size_ = std::min(limit_, 2 * size_);
  }

 private:
  /// Some devices end work that takes seconds, and it keeps others waiting: this is aimed at.
  static constexpr double kPartSeconds = 0.05;
  /// What the first part has, of which it is not known how long it takes.
  static constexpr std::size_t kFirstPart = 2048;
  static constexpr int kPartsToForget = 8;

  std::size_t most_;
  std::size_t limit_;  // fewer than most_ after lists were too short
  std::size_t size_;   // at most limit_
  int good_parts_ = 0;
};
}  // namespace gpu_planning_scene
