#pragma once

#include <algorithm>
#include <string>

#include "collision/filter/lanes/lane_model.h"
#include "model/text/number_text.h"

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

/// The place of a frame among the frames that have instances; -1: it has none.
inline int placeOf(const lanes::Model& model, int frame)
{
  const auto has_instance = [&model](int f)
  {
    return std::any_of(model.instances.data, model.instances.data + model.instances.count,
                       [f](const lanes::Instance& instance) { return instance.frame == f; });
  };
  if (!has_instance(frame))
    return -1;
  int place = 0;
  for (int f = 0; f < frame; ++f)
    place += has_instance(f) ? 1 : 0;
  return place;
}
}  // namespace gpu_planning_scene::core
