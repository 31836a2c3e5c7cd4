#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "collision/gpu/traversal/gpu_traversal.h"
#include "gpu/buffer.h"
#include "gpu/program.h"

namespace gpu_planning_scene::core
{
class LaneScene;

/// Proves most verdicts of states on the device, before any link is placed in double: joint tables, enclosing balls,
/// the boxes and the balls of covers, as the lane kernel does on the CPU (shaders/proofs/). The pairs without a proof
/// become candidates. Used on the context's thread.
class GpuProofs
{
 public:
  /// `definitions`: preprocessor definitions for the programs, see Program.
  GpuProofs(std::string shader_folder, std::string definitions)
    : folder_(std::move(shader_folder)), definitions_(std::move(definitions))
  {
  }

  /// Uploads a scene, which was made with lanes::kDeviceRounding, and compiles the programs that its robot needs. If it
  /// throws, there are no proofs.
  void set(const LaneScene& scene);

  /// Compiles the programs for batches with margins, if this has not been done.
  void prepareMargins() { programs(true); }

  /// From now on there are no proofs.
  void clear() { exist_ = false; }
  bool exist() const { return exist_; }

  /// The most states of a part for which the frames fit into a buffer texture.
  std::size_t maxStates() const;

  /// A part whose states are bound to UNIT_STATES, with its verdicts and counters.
  struct Part
  {
    std::uint32_t states;
    std::uint32_t robot_instances;
    std::uint32_t margins;  // floats of a row of margins; 0: none
  };

  /// Starts the proofs of a part. The pairs that they leave open are added to lists.candidates, and their states to
  /// lists.open_states.
  void start(const Part& part, BatchLists& lists);

  /// Reads the frames of a part of `states` states.
  std::vector<float> readFrames(std::size_t states) const;

 private:
  /// The programs for batches without margins, or for those with margins; compiled when first needed.
  struct Programs
  {
    std::optional<Program> states;  // of the robot
    std::optional<Program> self_pairs, world_pairs, fine_pairs;
  };
  Programs& programs(bool margins);

  std::string folder_, definitions_;
  std::string robot_shader_;
  std::array<Programs, 2> programs_;  // [1]: with margins
  TexelBuffer records_, frames_;
  std::size_t frame_count_ = 0;
  bool exist_ = false;
};
}  // namespace gpu_planning_scene::core
