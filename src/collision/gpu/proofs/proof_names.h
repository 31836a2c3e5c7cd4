#pragma once

#include <string>
#include <vector>

#include "base/text/number_text.h"
#include "collision/cpu/lanes/lane_model.h"

/// Names and numbers in the generated shader of the proofs, and what several of its parts know of the lane scene.
namespace gpu_planning_scene::core
{
/// The value of a variable of the state.
inline std::string valueName(int variable)
{
  return "v" + std::to_string(variable);
}

/// The placed centre of an instance or a cluster.
inline std::string centerName(std::uint32_t center)
{
  return "k" + std::to_string(center);
}

inline std::string number(float value)
{
  return exactText(static_cast<double>(value));
}

/// Two links are apart if the centres of their enclosing balls are farther apart than this. Metres.
inline float enclosingSum(const lanes::Model& model, const lanes::SelfPair& pair)
{
  return model.instances[pair.a].outer + model.instances[pair.b].outer + pair.thresholds.enclosing;
}

/// The frame of a centre: of an instance, or of a cluster.
inline int frameOf(const lanes::Model& model, std::uint32_t center)
{
  return center < model.instances.count ? model.instances[center].frame
                                        : model.clusters[center - model.instances.count].frame;
}

/// For each frame, its place among the frames that have instances, or -1 if it has none.
inline std::vector<int> placesOfFrames(const lanes::Model& model)
{
  std::vector<int> places(model.frames.count, -1);
  for (std::uint32_t i = 0; i < model.instances.count; ++i)
    places[static_cast<std::size_t>(model.instances[i].frame)] = 0;
  int next = 0;
  for (int& place : places)
    place = place < 0 ? -1 : next++;
  return places;
}
}  // namespace gpu_planning_scene::core
