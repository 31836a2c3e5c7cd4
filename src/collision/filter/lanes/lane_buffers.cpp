#include "collision/filter/lanes/lane_buffers.h"

namespace gpu_planning_scene::core
{
lanes::Scratch LaneBuffers::of(const LaneScene& scene)
{
  const lanes::Model& model = scene.model();
  const std::size_t frames = std::size_t{12} * lanes::kLanes * model.frames.count;
  const std::size_t centers = std::size_t{3} * lanes::kLanes * (model.instances.count + model.clusters.count);
  const std::size_t balls = std::size_t{lanes::kBallNumbers} * model.instances.count;
  floats_.resize(2 * frames + centers + balls);
  placed_.resize(model.instances.count);
  open_.resize(lanes::kLanes * scene.pairCount());
  trials_.resize(std::size_t{lanes::kLevels} * scene.pairCount(), lanes::Trial{});
  float* const first = floats_.data();
  return {first,          first + frames, first + 2 * frames, first + 2 * frames + centers,
          placed_.data(), open_.data(),   trials_.data()};
}
}  // namespace gpu_planning_scene::core
