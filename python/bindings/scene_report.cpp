#include <pybind11/stl.h>

#include "bindings/bindings.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::python
{
namespace py = pybind11;

void addSceneReport(py::module_& module)
{
  using core::DecidedStates;
  using core::SceneReport;
  py::class_<DecidedStates>(module, "DecidedStates", "The states that a stage of the CPU's checks has decided.")
      .def_readonly("by", &DecidedStates::by, "The stage: see docs/architecture.md, \"How a batch flows\".")
      .def_readonly("states", &DecidedStates::states)
      .def_readonly("nanoseconds", &DecidedStates::nanoseconds,
                    "Mean time in this stage, over all states that entered the first stage; 0: not measured.");
  py::class_<SceneReport>(module, "SceneReport",
                          "The pairs of a scene that are checked, and the pairs that are left out, by reason. Bodies "
                          "are indices: see PlanningScene.body_name.\n\n    print(checker.report().world_pairs)")
      .def_readonly("self_pairs", &SceneReport::self_pairs, "Checked: two links or attached objects.")
      .def_readonly("world_pairs", &SceneReport::world_pairs, "Checked: a world object and a link or attached object.")
      .def_readonly("allowed_self_pairs", &SceneReport::allowed_self_pairs,
                    "Left out: the allowed collision matrix allows them.")
      .def_readonly("allowed_world_pairs", &SceneReport::allowed_world_pairs,
                    "Left out: the allowed collision matrix allows them.")
      .def_readonly("touch_pairs", &SceneReport::touch_pairs,
                    "Left out: an attached object with its link, its touch links, or the other objects of its link.")
      .def_readonly("pairs_outside_group", &SceneReport::pairs_outside_group,
                    "Left out: the group does not move either body.")
      .def_readonly("links_without_shapes", &SceneReport::links_without_shapes, "Left out: they cannot collide.")
      .def_readonly("unreachable_self_pairs", &SceneReport::unreachable_self_pairs,
                    "Left out: within the joint limits the bodies never meet.")
      .def_readonly("unreachable_world_pairs", &SceneReport::unreachable_world_pairs,
                    "Left out: within the joint limits the bodies never meet.")
      .def_readonly("unreachable_objects", &SceneReport::unreachable_objects,
                    "Left out: no link or attached object reaches them.")
      .def_readonly("rigid_pairs", &SceneReport::rigid_pairs,
                    "Left out: decided once, because no joint moves one body relative to the other.")
      .def_readonly("always_colliding", &SceneReport::always_colliding,
                    "Body indices of a rigid pair that collides, so that every state collides; or None.")
      .def_readonly("colliding_in_samples", &SceneReport::colliding_in_samples,
                    "Pairs that collided in each of 64 random states within the joint limits.")
      .def_readonly("triangles", &SceneReport::triangles, "In all trees.")
      .def_readonly("trees", &SceneReport::trees, "One per distinct shape.")
      .def_readonly("shared_trees", &SceneReport::shared_trees, "Shapes that use the tree of an equal shape.")
      .def_readonly("decided", &SceneReport::decided,
                    "The states that the CPU has checked, by the stage that decided them.");
}
}  // namespace gpu_planning_scene::python
