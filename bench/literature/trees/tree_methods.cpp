#include "literature/method.h"
#include "literature/trees/oriented_boxes.h"

namespace gpu_planning_scene::core::literature
{
std::vector<MethodInfo> treeMethods()
{
  const std::string gottschalk = "Gottschalk, Lin, Manocha 1996";
  return {
      {"rapid",
       "oriented boxes (RAPID)",
       gottschalk,
       "trees",
       {},
       [](const auto& a, const auto& b) { return makeOrientedBoxes(*a, *b, kRapidEpsilon); }},
      {"rapid_without_epsilon",
       "oriented boxes, epsilon 0",
       gottschalk + ", changed",
       "trees",
       {},
       [](const auto& a, const auto& b) { return makeOrientedBoxes(*a, *b, 0.0); }},
  };
}
}  // namespace gpu_planning_scene::core::literature
