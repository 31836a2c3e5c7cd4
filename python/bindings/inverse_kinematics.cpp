#include <algorithm>
#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include <pybind11/stl.h>

#include "base/text/number_text.h"
#include "bindings/arguments.h"
#include "bindings/bindings.h"
#include "bindings/interrupt.h"
#include "bindings/state_checker.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/planning/collision_free_ik.h"
#include "model/rigid_pose.h"
#include "scene/link_frame.h"

namespace gpu_planning_scene::python
{
namespace
{
using core::CollisionFreeIkOptions;
using core::CollisionFreeIkResult;
using core::IkStatus;
using core::KinematicConstraints;
using core::PlanningScene;

/// The answer for one pose, with the number of variables of a state.
struct IkResult
{
  CollisionFreeIkResult found;
  std::size_t width;
};

struct WantedPoses
{
  std::vector<Eigen::Isometry3d> poses;
  bool is_single = false;
};

WantedPoses wantedPosesFrom(const py::object& object)
{
  const ArrayOf<double> array = arrayFrom(object, "poses");
  const py::ssize_t axes = array.ndim();
  if (axes < 2 || axes > 3 || array.shape(axes - 2) != 4 || array.shape(axes - 1) != 4)
    throw core::Error("poses: the shape is " + std::string(py::str(array.attr("shape"))) +
                      "; it must be (4, 4) for one pose, or (n, 4, 4)");
  WantedPoses wanted;
  wanted.is_single = axes == 2;
  if (wanted.is_single)
    wanted.poses.push_back(poseFrom(array, "poses"));
  else
    for (py::ssize_t i = 0; i < array.shape(0); ++i)
      wanted.poses.push_back(poseFrom(array[py::int_(i)], "poses: pose " + std::to_string(i)));
  return wanted;
}

void requireTolerance(double value, const char* name)
{
  constexpr double kLeast = 1e-9;
  if (!(value >= kLeast))
    throw core::Error(std::string(name) + " is " + core::numberText(value) + "; it must be at least 1e-9");
}

std::vector<double> seedStateFrom(const py::object& state, const PlanningScene& scene)
{
  if (!state.is_none())
    return rowFrom(state, *scene.robot, "seed_state", &scene.current_state);
  if (scene.current_state.empty())
    throw core::Error("the scene has no current_state at which the search could begin; give seed_state");
  return scene.current_state;
}

core::LinkFrame frameFrom(const py::object& frame, const PlanningScene& scene, const std::string& group)
{
  if (frame.is_none())
    return {core::tipOf(*scene.robot, scene.robot->group(group))};
  return core::linkFrame(scene, frame.cast<Arg<std::string>>().value);
}

std::vector<CollisionFreeIkResult> solveOnAllCores(SharedChecker& shared, const std::string& group,
                                                   const std::vector<Eigen::Isometry3d>& poses,
                                                   const py::object& seed_state, const py::object& frame,
                                                   double position_tolerance, double orientation_tolerance,
                                                   const CollisionFreeIkOptions& options)
{
  const auto scene = shared.scene();
  const std::vector<double> start = seedStateFrom(seed_state, *scene);
  const core::LinkFrame moved = frameFrom(frame, *scene, group);
  std::vector<KinematicConstraints> goals;
  for (const Eigen::Isometry3d& pose : poses)
    goals.push_back(
        KinematicConstraints::pose(moved.link, moved.pose, pose, position_tolerance, orientation_tolerance));
  Interrupt interrupt;
  // Only the thread of the call may ask for signals; the other searches see its answer.
  std::atomic<bool> is_interrupted{false};
  const auto caller = std::this_thread::get_id();
  const auto stop = [&]
  {
    if (std::this_thread::get_id() == caller && interrupt.requested())
      is_interrupted = true;
    return is_interrupted.load();
  };
  std::vector<CollisionFreeIkResult> found = withoutLock(
      [&]
      {
        const SharedChecker::Call call(shared);
        if (call.scene() != scene)
          throw core::Error("the scene of the checker was replaced meanwhile; call solve_ik again");
        return core::solveCollisionFree(*scene, *call.checker(), group, goals, start, options, stop);
      });
  interrupt.rethrow();
  return found;
}

py::object solveIk(const Arg<CheckerPtr>& checker, const Arg<std::string>& group, const py::object& poses,
                   const py::object& seed_state, const py::object& frame, Arg<double> position_tolerance,
                   Arg<double> orientation_tolerance, Arg<std::size_t> max_solutions, Arg<std::size_t> max_attempts,
                   Arg<bool> check_collisions, Arg<std::uint64_t> seed)
{
  requireTolerance(position_tolerance.value, "position_tolerance");
  requireTolerance(orientation_tolerance.value, "orientation_tolerance");
  const WantedPoses wanted = wantedPosesFrom(poses);
  CollisionFreeIkOptions options;
  options.ik.max_solutions = max_solutions.value;
  options.ik.max_attempts = max_attempts.value;
  options.ik.seed = seed.value;
  options.check_collisions = check_collisions.value;
  std::vector<CollisionFreeIkResult> found =
      solveOnAllCores(*checker.value, group.value, wanted.poses, seed_state, frame, position_tolerance.value,
                      orientation_tolerance.value, options);
  const std::size_t width = checker.value->scene()->robot->variables().size();
  if (wanted.is_single)
    return py::cast(IkResult{std::move(found.front()), width});
  py::list results;
  for (CollisionFreeIkResult& result : found)
    results.append(IkResult{std::move(result), width});
  return results;
}

py::array_t<double> statesOf(const IkResult& result)
{
  py::array_t<double> rows({result.found.states.size(), result.width});
  double* out = rows.mutable_data();
  for (const std::vector<double>& state : result.found.states)
    out = std::copy(state.begin(), state.end(), out);
  return rows;
}
}  // namespace

void addInverseKinematics(py::module_& module)
{
  const CollisionFreeIkOptions defaults;
  py::enum_<IkStatus>(module, "IkStatus", "How the search for the states of a pose ended.")
      .value("SOLVED", IkStatus::Solved)
      .value("NO_SOLUTION", IkStatus::NoSolution, "No attempt reached the pose.")
      .value("IN_COLLISION", IkStatus::InCollision, "States reach the pose, and all that were found collide.");
  py::class_<IkResult>(module, "IkResult", "The answer of solve_ik for one pose.")
      .def_property_readonly("status", [](const IkResult& result) { return result.found.status; })
      .def_property_readonly(
          "message", [](const IkResult& result) { return result.found.message; },
          "The fault, in one line: how near the search came, or which bodies collide. Empty if the status is SOLVED.")
      .def_property_readonly("states", &statesOf,
                             "States, shape (k, variables); the nearest to the seed state comes first. None unless the "
                             "status is SOLVED.")
      .def_property_readonly(
          "distances",
          [](const IkResult& result) {
            return py::array_t<double>(static_cast<py::ssize_t>(result.found.distances.size()),
                                       result.found.distances.data());
          },
          "The distance of each state from the seed state: the norm over the variables of the group, shape (k,).");
  module.def(
      "solve_ik", &solveIk, py::arg("checker"), py::arg("group"), py::arg("poses"), py::arg("seed_state") = py::none(),
      py::arg("frame") = py::none(), py::arg("position_tolerance") = 1e-6, py::arg("orientation_tolerance") = 1e-6,
      py::arg("max_solutions") = defaults.ik.max_solutions, py::arg("max_attempts") = defaults.ik.max_attempts,
      py::arg("check_collisions") = defaults.check_collisions, py::arg("seed") = defaults.ik.seed,
      "Inverse kinematics: states of a planning group in which a frame has a wanted pose, within the joint limits and "
      "free of collision in the scene of a StateChecker.\n\n"
      "poses: in the planning frame, shape (4, 4), or (n, 4, 4) for many poses at once. seed_state: the state near "
      "which "
      "the search begins, shape (variables,), or the name of a state of the SRDF; None: the scene's current_state. "
      "Variables outside the group keep its values, and so do variables of the group that do not move the frame. "
      "frame: whose pose is wanted: a link, an object that a link carries, or its subframe (OBJECT/SUBFRAME); None: "
      "the "
      "last link of the group's chain. position_tolerance: metres; orientation_tolerance: radians; each at least 1e-9. "
      "From pi on, any orientation will do, for example "
      "for an arm with few joints. max_solutions: the search ends with this number of states for a pose. "
      "max_attempts: it ends after this number of start states. check_collisions: False: only the pose and the limits "
      "count. seed: of the random start states; equal seeds give equal states.\n\n"
      "Returns an IkResult for one pose, or a list of them: a pose that is not reached is not an exception, and proves "
      "nothing, because the search is random. Raises Error for an unknown group or frame, for poses that are not rigid "
      "motions, for other shapes, for values that are not finite, and if seed_state is outside the limits of a "
      "variable of the group that the search does not move. Ctrl-C ends the call. A checker serves one call "
      "after the other.\n\n"
      "    result = gps.solve_ik(checker, \"arm\", scene.frame(\"palm\"))\n"
      "    print(result.status, result.message, result.states)");
}
}  // namespace gpu_planning_scene::python
