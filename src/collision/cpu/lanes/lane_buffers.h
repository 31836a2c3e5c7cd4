#pragma once

#include <cstdint>
#include <vector>

#include "collision/cpu/lanes/lane_scene.h"

namespace gpu_planning_scene::core
{
/// Memory for the lane kernel. One thread at a time.
class LaneBuffers
{
 public:
  /// The kernel's work space for a scene. It is valid until the next call. The trials and the frames of the base are
  /// kept from call to call.
  lanes::Scratch of(const LaneScene& scene);

  /// Must be called before another scene is used: it has other pairs and frames.
  void forget()
  {
    trials_.clear();
    base_.clear();
  }

 private:
  std::vector<float> floats_;
  std::vector<std::uint8_t> placed_;
  std::vector<std::uint32_t> open_;
  std::vector<lanes::OpenPair> open_pairs_;
  std::vector<lanes::Trial> trials_;
  std::vector<double> base_;
};
}  // namespace gpu_planning_scene::core
