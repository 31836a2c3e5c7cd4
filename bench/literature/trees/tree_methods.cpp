#include "literature/method.h"
#include "literature/trees/box_tree.h"
#include "literature/trees/breadth_first.h"
#include "literature/trees/dop18.h"
#include "literature/trees/dop24.h"
#include "literature/trees/oriented_boxes.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
template <class Make>
MethodInfo info(const char* name, const char* title, const char* source, const Make& make)
{
  return {name, title, source, "trees", {}, [make](const auto& a, const auto& b) { return make(*a, *b); }};
}
}  // namespace

std::vector<MethodInfo> treeMethods()
{
  return {
      info(
          "rapid", "oriented boxes (RAPID)", "Gottschalk, Lin, Manocha 1996",
          [](const Mesh& a, const Mesh& b) { return makeOrientedBoxes(a, b, kRapidEpsilon); }),
      info(
          "rapid_without_epsilon", "oriented boxes, epsilon 0", "Gottschalk, Lin, Manocha 1996, changed",
          [](const Mesh& a, const Mesh& b) { return makeOrientedBoxes(a, b, 0.0); }),
      info(
          "dop18", "18-DOPs", "Klosowski et al. 1998",
          [](const Mesh& a, const Mesh& b) { return makeDop18(a, b, DopDescent::FixedFirst); }),
      info(
          "dop18_larger", "18-DOPs, larger first", "Klosowski et al. 1998, changed",
          [](const Mesh& a, const Mesh& b) { return makeDop18(a, b, DopDescent::Larger); }),
      info("dop24", "24-DOPs, realigned", "Zachmann 1998", makeDop24),
      info("box_tree", "box trees", "Zachmann 2002", makeBoxTree),
      info("breadth_first", "oriented boxes, breadth-first", "Gress, Zachmann 2003, on the CPU", makeBreadthFirst),
  };
}
}  // namespace gpu_planning_scene::core::literature
