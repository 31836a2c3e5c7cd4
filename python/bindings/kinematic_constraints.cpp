#include <memory>
#include <string>

#include <pybind11/stl.h>

#include "base/text/number_text.h"
#include "bindings/arguments.h"
#include "bindings/bindings.h"
#include "bindings/kinematic_constraints.h"
#include "gpu_planning_scene/error.h"
#include "scene/link_frame.h"

namespace gpu_planning_scene::python
{
namespace
{
using core::OrientationConstraint;
using core::PlanningScene;

void addPosition(SceneConstraints& constraints, const Arg<std::string>& frame, const py::object& pose,
                 const py::object& sphere, const py::object& box, const py::object& point)
{
  const core::LinkFrame moved = core::linkFrame(*constraints.scene, frame.value);
  core::PositionConstraint position;
  position.link = moved.link;
  position.point = moved.pose * (point.is_none() ? Eigen::Vector3d::Zero() : vectorFrom(point, "point"));
  position.pose = poseFrom(pose, "pose");
  if (sphere.is_none() == box.is_none())
    throw core::Error("the region is a sphere (its radius) or a box (its three sizes); give one of them");
  if (box.is_none())
    position.region = core::Sphere{sphere.cast<Arg<double>>().value};
  else
    position.region = core::Box{vectorFrom(box, "box")};
  constraints.add(position);
}

void addOrientation(SceneConstraints& constraints, const Arg<std::string>& frame, const py::object& pose,
                    const py::object& tolerance, Arg<bool> rotation_vector)
{
  const core::LinkFrame moved = core::linkFrame(*constraints.scene, frame.value);
  OrientationConstraint orientation;
  orientation.link = moved.link;
  orientation.frame = moved.pose.linear();
  orientation.wanted = poseFrom(pose, "pose").linear();
  orientation.tolerance = vectorFrom(tolerance, "tolerance");
  if (rotation_vector.value)
    orientation.parameterization = OrientationConstraint::Parameterization::RotationVector;
  constraints.add(orientation);
}

void addPose(SceneConstraints& constraints, const Arg<std::string>& frame, const py::object& pose,
             Arg<double> position_tolerance, Arg<double> orientation_tolerance)
{
  const core::LinkFrame moved = core::linkFrame(*constraints.scene, frame.value);
  constraints.append(core::KinematicConstraints::pose(moved.link, moved.pose, poseFrom(pose, "pose"),
                                                      position_tolerance.value, orientation_tolerance.value));
}

void addJoint(SceneConstraints& constraints, const Arg<std::string>& name, Arg<double> lower, Arg<double> upper)
{
  const core::RobotModel& robot = *constraints.scene->robot;
  const int variable = robot.variableIndex(name.value);
  if (variable < 0)
    throw core::Error("the robot has no variable '" + name.value + "'");
  core::KinematicConstraints range;
  range.addJoint(robot, variable, lower.value, upper.value);
  constraints.append(range);
}

py::tuple violation(const SceneConstraints& constraints, const py::object& state)
{
  const core::RobotModel& robot = *constraints.scene->robot;
  const std::vector<double> row = rowFrom(state, robot, "state", &constraints.scene->current_state);
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  robot.linkPoses(row.data(), poses.data());
  const core::ConstraintViolation found = core::violationOf(constraints.all, poses.data(), row.data());
  return py::make_tuple(found.position, found.orientation, found.joint);
}
}  // namespace

void SceneConstraints::append(const core::KinematicConstraints& more)
{
  more.validate(*scene->robot, "the constraint");
  all.append(more);
}

void SceneConstraints::add(const core::PositionConstraint& position)
{
  core::KinematicConstraints more;
  more.positions.push_back(position);
  append(more);
}

void SceneConstraints::add(const OrientationConstraint& orientation)
{
  core::KinematicConstraints more;
  more.orientations.push_back(orientation);
  append(more);
}

std::vector<core::KinematicConstraints> constraintsFrom(py::handle object, const core::PlanningScene& scene,
                                                        const char* what)
{
  std::vector<core::KinematicConstraints> constraints;
  const auto take = [&](py::handle item)
  {
    if (!py::isinstance<SceneConstraints>(item))
      throwTypeError(std::string(what) + ": " + expectedButGot("a KinematicConstraints", item));
    const auto& given = item.cast<const SceneConstraints&>();
    if (given.scene->robot != scene.robot)
      throw core::Error(std::string(what) +
                        ": the constraints are for another robot; make them with a scene of the "
                        "checker's robot");
    constraints.push_back(given.all);
  };
  if (object.is_none())
    return constraints;
  if (!py::isinstance<py::list>(object) && !py::isinstance<py::tuple>(object))
    take(object);
  else
    for (const py::handle item : object)
      take(item);
  return constraints;
}

void addKinematicConstraints(py::module_& module)
{
  py::class_<SceneConstraints>(
      module, "KinematicConstraints",
      "Conditions on a state, all of which must hold: goals and path_constraints of plan_motion. Frames are links, "
      "objects that a link carries, or their subframes (OBJECT/SUBFRAME), as they are in `scene` when the condition is "
      "added. Poses are in the planning frame. Each method returns None, and raises Error for a wrong value.\n\n"
      "    upright = gps.KinematicConstraints(scene)\n"
      "    upright.add_orientation(\"palm\", numpy.eye(4), (0.1, 0.1, numpy.pi))")
      .def(py::init(
               [](const Arg<std::shared_ptr<PlanningScene>>& scene) {
                 return SceneConstraints{std::make_shared<const PlanningScene>(*scene.value), {}};
               }),
           py::arg("scene"))
      .def("add_position", &addPosition, py::arg("frame"), py::arg("pose"), py::arg("sphere") = py::none(),
           py::arg("box") = py::none(), py::arg("point") = py::none(),
           "A point of a frame is within a region. pose: of the region, as PlanningScene.add_object takes it. sphere: "
           "its radius; box: its three sizes; metres. point: in the frame; None: its origin.")
      .def("add_orientation", &addOrientation, py::arg("frame"), py::arg("pose"), py::arg("tolerance"),
           py::arg("rotation_vector") = false,
           "A frame has the orientation of `pose`, up to three tolerances in radians; pi: any angle. They hold for the "
           "angles of turns about the x axis of `pose`, then the new y, then the new z; or, with rotation_vector, for "
           "the rotation vector in the planning frame.")
      .def("add_pose", &addPose, py::arg("frame"), py::arg("pose"), py::arg("position_tolerance") = 1e-4,
           py::arg("orientation_tolerance") = 1e-3, "A frame has a pose, up to a distance and an angle.")
      .def("add_joint", &addJoint, py::arg("name"), py::arg("lower"), py::arg("upper"),
           "The values of a variable are within a range (radians, metres).")
      .def("violation", &violation, py::arg("state"),
           "How far a state is from fulfilling the conditions: the largest distance of a point from its region "
           "(metres), of an angle from its tolerance (radians), and of a variable from its range. All 0: it fulfils "
           "them.");
}
}  // namespace gpu_planning_scene::python
