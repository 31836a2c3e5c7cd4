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
MethodInfo info(const char* name, const char* title, const char* source, const Make& make, const char* family = "trees")
{
  return {name, title, source, family, {}, make};
}

auto orientedBoxes(double epsilon, Search search)
{
  return [=](const MeshPtr& a, const MeshPtr& b) { return makeOrientedBoxes(a, b, epsilon, search); };
}

auto dop18(DopDescent descent)
{
  return [=](const MeshPtr& a, const MeshPtr& b) { return makeDop18(a, b, descent); };
}

auto breadthFirst(Search search)
{
  return [=](const MeshPtr& a, const MeshPtr& b) { return makeBreadthFirst(a, b, search); };
}
}  // namespace

std::vector<MethodInfo> treeMethods()
{
  return {
      info("rapid", "oriented boxes (RAPID)", "Gottschalk, Lin, Manocha 1996",
           orientedBoxes(kRapidEpsilon, Search::First)),
      info("rapid_without_epsilon", "oriented boxes, epsilon 0", "Gottschalk, Lin, Manocha 1996, changed",
           orientedBoxes(0.0, Search::First)),
      info("rapid_all", "oriented boxes, all pairs", "Gottschalk, Lin, Manocha 1996",
           orientedBoxes(kRapidEpsilon, Search::All)),
      info("dop18", "18-DOPs", "Klosowski et al. 1998", dop18(DopDescent::FixedFirst)),
      info("dop18_larger", "18-DOPs, larger first", "Klosowski et al. 1998, changed", dop18(DopDescent::Larger)),
      info("dop24", "24-DOPs, realigned", "Zachmann 1998", makeDop24),
      info("box_tree", "box trees", "Zachmann 2002", makeBoxTree),
      info("breadth_first", "breadth-first, CPU", "Gress, Zachmann 2003, on the CPU", breadthFirst(Search::First),
           "paper"),
      info("breadth_first_all", "breadth-first, CPU, all pairs", "Gress, Zachmann 2003, on the CPU",
           breadthFirst(Search::All), "paper"),
  };
}
}  // namespace gpu_planning_scene::core::literature
