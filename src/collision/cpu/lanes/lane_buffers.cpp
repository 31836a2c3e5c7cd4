#include "collision/cpu/lanes/lane_buffers.h"

#include <limits>

namespace gpu_planning_scene::core
{
lanes::Scratch LaneBuffers::of(const LaneScene& scene)
{
  const lanes::Model& model = scene.model();
  const std::size_t frames = std::size_t{12} * lanes::kLanes * model.frames.count;
  const std::size_t centers = std::size_t{3} * lanes::kLanes * (model.instances.count + model.clusters.count);
  const std::size_t balls = std::size_t{lanes::kBallNumbers} * model.instances.count;
  const std::size_t boxes = std::size_t{lanes::kBoxNumbers} * lanes::kLanes * model.instances.count;
  floats_.resize(frames + centers + balls + boxes);
  placed_.resize(std::size_t{2} * model.instances.count);
  open_.resize(lanes::kLanes * scene.pairCount() + 1);
  open_pairs_.resize(scene.pairCount() + 1);
  trials_.resize(std::size_t{lanes::kTests} * scene.pairCount(), lanes::Trial{});
  base_.resize(lanes::kMostBaseVariables, std::numeric_limits<double>::quiet_NaN());
  float* const first = floats_.data();
  float* const first_ball = first + frames + centers;
  return {first,
          base_.data(),
          first + frames,
          first_ball,
          first_ball + balls,
          placed_.data(),
          placed_.data() + model.instances.count,
          open_.data(),
          open_pairs_.data(),
          trials_.data()};
}
}  // namespace gpu_planning_scene::core
