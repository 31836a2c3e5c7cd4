#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <pybind11/stl.h>

#include "base/text/name_list.h"
#include "bindings/arguments.h"
#include "bindings/bindings.h"
#include "bindings/interrupt.h"
#include "bindings/shapes.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/planning_file.h"
#include "gpu_planning_scene/robot_model.h"
#include "model/description/description_file.h"

namespace gpu_planning_scene::python
{
namespace
{
using core::RobotModel;
using RobotPtr = std::shared_ptr<RobotModel>;

constexpr std::size_t kStatesBetweenSignals = 4096;

/// `load` gets a list for warnings and returns the robot.
template <typename Load>
RobotPtr loaded(const Load& load)
{
  std::vector<std::string> warnings;
  const auto robot = withoutLock([&] { return load(&warnings); });
  warnOf(warnings);
  return std::const_pointer_cast<RobotModel>(robot);
}

core::RobotModelOptions optionsFrom(py::handle packages, double unbounded_translation, py::handle files)
{
  core::RobotModelOptions options;
  options.packages = packagesFrom(packages);
  options.package_folders = packageFoldersFrom(packages);
  options.meshes = meshesFrom(files);
  options.info = [](const std::string& line)
  {
    const py::gil_scoped_acquire lock;
    py::print(line, py::arg("file") = py::module_::import("sys").attr("stderr"));
  };
  if (!(unbounded_translation > 0.0 && unbounded_translation <= core::kLargestLength))
    throw core::Error("unbounded_translation is " + std::to_string(unbounded_translation) +
                      "; it must be above 0 and at most 1e6 metres");
  options.unbounded_translation = unbounded_translation;
  return options;
}

/// The position limits of the file; none without a path.
std::vector<core::JointLimits> limitsOfFile(const std::string& path)
{
  std::vector<std::string> warnings;
  std::vector<core::JointLimits> limits;
  if (!path.empty())
    limits = core::readJointLimits(path, &warnings);
  warnOf(warnings);
  return limits;
}

RobotPtr fromFiles(const py::object& urdf, const py::object& srdf, const py::object& packages,
                   Arg<double> unbounded_translation, const py::object& files, const py::object& planning)
{
  core::RobotModelOptions options = optionsFrom(packages, unbounded_translation.value, files);
  const std::string urdf_path = pathFrom(urdf, "urdf");
  const std::string srdf_path = pathFrom(srdf, "srdf");
  options.joint_limits = limitsOfFile(pathFrom(planning, "planning"));
  return loaded([&](auto* warnings) { return RobotModel::fromFiles(urdf_path, srdf_path, options, warnings); });
}

RobotPtr fromXml(const Arg<std::string>& urdf, const Arg<std::string>& srdf, const py::object& packages,
                 const py::object& urdf_folder, Arg<double> unbounded_translation, const py::object& files,
                 const Arg<std::string>& planning)
{
  core::RobotModelOptions options = optionsFrom(packages, unbounded_translation.value, files);
  std::vector<std::string> faults;
  if (!planning.value.empty())
    options.joint_limits = core::jointLimitsFromText(planning.value, "planning", &faults);
  warnOf(faults);
  options.urdf_folder = pathFrom(urdf_folder, "urdf_folder");
  options.urdf_name = "urdf";
  options.srdf_name = "srdf";
  return loaded([&](auto* warnings) { return RobotModel::fromXml(urdf.value, srdf.value, options, warnings); });
}

/// The text of a description, which is UTF-8, without a byte order mark.
py::str decoded(const std::string& text)
{
  PyObject* decoded = PyUnicode_Decode(text.data(), static_cast<Py_ssize_t>(text.size()), "utf-8-sig", "strict");
  if (decoded == nullptr)
    throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

/// The robot of fromFiles, and the texts of the URDF and of the SRDF that it was made of. xacro runs once for each
/// file.
py::tuple withTexts(const py::object& urdf, const py::object& srdf, const py::object& packages, const py::object& files,
                    const py::object& planning)
{
  core::RobotModelOptions options = optionsFrom(packages, 1.0, files);
  options.joint_limits = limitsOfFile(pathFrom(planning, "planning"));
  const std::string urdf_path = pathFrom(urdf, "urdf");
  const std::string srdf_path = pathFrom(srdf, "srdf");
  const core::RobotDescription read = withoutLock(
      [&] { return core::readRobotDescription(urdf_path, srdf_path, options.package_folders, options.info); });
  options.urdf_folder = read.urdf_folder;
  options.urdf_name = read.urdf.name;
  options.srdf_name = read.srdf.name;
  const RobotPtr robot =
      loaded([&](auto* warnings) { return RobotModel::fromXml(read.urdf.text, read.srdf.text, options, warnings); });
  return py::make_tuple(robot, decoded(read.urdf.text), decoded(read.srdf.text));
}

/// Calls `work(i)` for all indices below `count`, and ends when a signal handler raises an exception.
template <typename Work>
void forEachState(std::size_t count, const Work& work)
{
  Interrupt interrupt;
  withoutLock(
      [&]
      {
        for (std::size_t i = 0; i < count; ++i)
        {
          if (i % kStatesBetweenSignals == kStatesBetweenSignals - 1 && interrupt.requested())
            break;
          work(i);
        }
      });
  interrupt.rethrow();
}

/// The array for `count` states: `out`, or a new one.
py::array_t<double> rowsFor(std::size_t count, std::size_t width, const py::object& out)
{
  if (out.is_none())
    return py::array_t<double>({count, width});
  if (!py::isinstance<ArrayOf<double>>(out) || !out.cast<py::array>().writeable())
    throwTypeError(expectedButGot("a writable array of float64 in C order for out", out));
  py::array_t<double> array = out.cast<py::array_t<double>>();
  if (array.ndim() != 2 || array.shape(0) != static_cast<py::ssize_t>(count) ||
      array.shape(1) != static_cast<py::ssize_t>(width))
    throw core::Error("out: the shape is " + std::string(py::str(array.attr("shape"))) + "; it must be (" +
                      std::to_string(count) + ", " + std::to_string(width) + ")");
  return array;
}

py::array_t<double> randomStates(const RobotModel& robot, Arg<std::size_t> count, Arg<std::uint64_t> seed,
                                 const py::object& base, const py::object& out, Arg<bool> moves_base)
{
  const std::size_t width = robot.variables().size();
  if (moves_base.value && !base.is_none())
    throw core::Error("base is given and moves_base is True; give one of the two");
  std::vector<double> start;
  if (!moves_base.value)
    start = base.is_none() ? robot.defaultState() : rowFrom(base, robot, "base");
  py::array_t<double> states = rowsFor(count.value, width, out);
  double* rows = states.mutable_data();
  std::mt19937_64 generator(seed.value);
  forEachState(count.value,
               [&](std::size_t i)
               {
                 if (start.empty())
                   robot.randomState(generator, rows + i * width);
                 else
                   robot.randomState(generator, start.data(), rows + i * width);
               });
  return states;
}

py::array_t<double> linkPoses(const RobotModel& robot, const py::object& states)
{
  const Rows rows = rowsFrom(states, robot, "states");
  const std::size_t width = robot.variables().size();
  const std::size_t links = robot.links().size();
  std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(links), 4, 4};
  if (!rows.is_single)
    shape.insert(shape.begin(), static_cast<py::ssize_t>(rows.count));
  py::array_t<double> poses(shape);
  double* out = poses.mutable_data();
  std::vector<Eigen::Isometry3d> link_poses(links);
  forEachState(rows.count,
               [&](std::size_t i)
               {
                 robot.linkPoses(rows.data() + i * width, link_poses.data());
                 for (std::size_t link = 0; link < links; ++link)
                   Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(out + 16 * (i * links + link)) =
                       link_poses[link].matrix();
               });
  return poses;
}

/// An index of the robot. The library returns -1 for an unknown name, which would be the last element in Python.
/// `parts`: the links, joints or variables of the robot.
template <typename Part>
int known(int index, const RobotModel& robot, const char* kind, const std::string& name, const std::vector<Part>& parts)
{
  if (index >= 0)
    return index;
  std::vector<std::string> names;
  for (const Part& part : parts)
    names.push_back(part.name);
  throw core::Error("robot '" + robot.name() + "' has no " + kind + " '" + name +
                    "'; there are: " + core::nameList(names));
}

void addParts(py::module_& module)
{
  py::class_<core::Variable>(module, "Variable",
                             "One number of a robot state: radians, metres, or a component of a "
                             "quaternion. The names are MoveIt's.")
      .def_readonly("name", &core::Variable::name)
      .def_readonly("bounded", &core::Variable::bounded, "True: it has limits.")
      .def_readonly("lower", &core::Variable::lower, "The lower limit, or that of random states.")
      .def_readonly("upper", &core::Variable::upper, "The upper limit, or that of random states.")
      .def_readonly("limits_source", &core::Variable::limits_source,
                    "Source of the limits. Empty: the URDF's <limit>. Otherwise the URDF's <safety_controller>, the "
                    "argument planning, or both.")
      .def_readonly("max_velocity", &core::Variable::max_velocity,
                    "The largest speed, in rad/s or m/s: of the URDF's <limit>, or of the argument planning. None: "
                    "there is no limit.")
      .def_readonly(
          "max_acceleration", &core::Variable::max_acceleration,
          "The largest acceleration, in rad/s^2 or m/s^2, of the argument planning. None: there is no limit.");
  py::enum_<core::JointType>(module, "JointType", "The type of a joint.")
      .value("FIXED", core::JointType::Fixed)
      .value("REVOLUTE", core::JointType::Revolute)
      .value("CONTINUOUS", core::JointType::Continuous)
      .value("PRISMATIC", core::JointType::Prismatic)
      .value("PLANAR", core::JointType::Planar)
      .value("FLOATING", core::JointType::Floating);
  py::class_<core::Joint>(module, "Joint", "A joint. Indices count from 0 in RobotModel.links and .variables.")
      .def_readonly("name", &core::Joint::name)
      .def_readonly("type", &core::Joint::type)
      .def_readonly("parent_link", &core::Joint::parent_link, "-1: the parent is the planning frame.")
      .def_readonly("child_link", &core::Joint::child_link)
      .def_readonly("first_variable", &core::Joint::first_variable,
                    "-1 for fixed joints; a mimic joint has the variable of its leader.")
      .def_readonly("mimic", &core::Joint::mimic)
      .def_readonly("passive", &core::Joint::passive, "True: a passive_joint of the SRDF.")
      .def_property_readonly(
          "origin", [](const core::Joint& joint) { return toPython(joint.origin); },
          "The joint's frame in the frame of the parent link, shape (4, 4).")
      .def_property_readonly(
          "axis", [](const core::Joint& joint) { return toPython(joint.axis); }, "Unit length, shape (3,).");
  py::class_<core::Link>(module, "Link", "A link.")
      .def_readonly("name", &core::Link::name)
      .def_readonly("parent_joint", &core::Link::parent_joint, "-1: the root link has no virtual joint.")
      .def_property_readonly(
          "shapes", [](const core::Link& link) { return toPython(link.shapes); },
          "The collision elements: pairs (shape, pose in the frame of the link).");
  py::class_<core::Group>(module, "Group", "A planning group of the SRDF.")
      .def_readonly("name", &core::Group::name)
      .def_readonly("joints", &core::Group::joints, "Indices, with fixed and mimic joints.")
      .def_readonly("variables", &core::Group::variables, "Indices of the variables of the active joints.")
      .def_readonly("moved_links", &core::Group::moved_links, "Indices of the links that these variables move.");
  py::class_<core::NamedState>(module, "NamedState", "A state that the SRDF names for a group.")
      .def_readonly("name", &core::NamedState::name)
      .def_readonly("group", &core::NamedState::group)
      .def_readonly("variables", &core::NamedState::variables, "Indices.")
      .def_readonly("values", &core::NamedState::values, "One per variable of this state.");
}
}  // namespace

void addRobotModel(py::module_& module)
{
  addParts(module);
  py::class_<RobotModel, RobotPtr>(
      module, "RobotModel",
      "A robot: the kinematic tree of a URDF with its collision shapes, and the content of its SRDF. It never changes "
      "and can be used by several threads. A state is a row with one number for each of `variables`, in radians and "
      "metres.\n\n    robot = gps.RobotModel.from_files(\"robot.urdf\", \"robot.srdf\")")
      .def_static(
          "from_files", &fromFiles, py::arg("urdf"), py::arg("srdf") = py::none(), py::arg("packages") = py::none(),
          py::arg("unbounded_translation") = 1.0, py::arg("files") = py::none(), py::arg("planning") = py::none(),
          "Loads a robot.\n\nurdf, srdf: paths; without an SRDF, adjacent links may touch. A xacro file is expanded if "
          "the program xacro is on PATH; a line on sys.stderr says so. packages: the "
          "folders of ROS packages by name, or a function that returns the folder of a name. With a dict or "
          "without packages, other names are looked up on ROS_PACKAGE_PATH. unbounded_translation: metres; "
          "random translations of planar and floating joints without limits are in [-value, value]. "
          "files: a function that gets the URI of each mesh file and returns the path of the file; None means "
          "that the usual rules apply. planning: the path of a YAML file with MoveIt's joint_limits, whose limits "
          "replace those of the URDF.\n\n"
          "Harmless faults of the files are Python warnings (UserWarning). Raises Error with file and line "
          "for other faults, and for meshes that cannot be read.\n\n"
          "    gps.RobotModel.from_files(\"ur5.urdf\", packages={\"ur5\": \"/path/ur5\"})")
      .def_static("from_xml", &fromXml, py::arg("urdf"), py::arg("srdf") = "", py::arg("packages") = py::none(),
                  py::arg("urdf_folder") = py::none(), py::arg("unbounded_translation") = 1.0,
                  py::arg("files") = py::none(), py::arg("planning") = "",
                  "Loads a robot from the texts of its URDF and SRDF.\n\nplanning: the text of a YAML file with "
                  "MoveIt's joint_limits. urdf_folder: the start of relative paths of "
                  "meshes; without it they are refused. Everything else is as in from_files.\n\n"
                  "    gps.RobotModel.from_xml(pathlib.Path(\"robot.urdf\").read_text())")
      .def(
          "with_solids",
          [](const RobotModel& robot, const std::map<std::string, std::string>& solids)
          {
            std::map<std::string, core::SolidRule> rules;
            for (const auto& [link, rule] : solids)
              rules[link] = core::solidRuleFrom(rule);
            return std::const_pointer_cast<RobotModel>(robot.withSolids(rules));
          },
          py::arg("solids"),
          "The robot with other rules for the meshes of some links.\n\nsolids: the rule by link: auto, surface or "
          "filled, see Mesh.\n\nRaises Error for an unknown link or rule.\n\n"
          "    robot.with_solids({\"base\": \"filled\"})")
      .def_property_readonly("name", &RobotModel::name)
      .def_property_readonly("planning_frame", &RobotModel::planningFrame, "The frame of all poses of links.")
      .def_property_readonly("links", &RobotModel::links, "Parents before children; [0] is the root link.")
      .def_property_readonly("joints", &RobotModel::joints, "Parents before children.")
      .def_property_readonly("variables", &RobotModel::variables, "The columns of a state.")
      .def_property_readonly("groups", &RobotModel::groups, "The planning groups of the SRDF.")
      .def_property_readonly("named_states", &RobotModel::namedStates, "The states of the SRDF.")
      .def_property_readonly(
          "variable_names",
          [](const RobotModel& robot)
          {
            std::vector<std::string> names;
            for (const core::Variable& variable : robot.variables())
              names.push_back(variable.name);
            return names;
          },
          "The names of the variables.")
      .def(
          "link_index",
          [](const RobotModel& robot, const Arg<std::string>& name)
          { return known(robot.linkIndex(name.value), robot, "link", name.value, robot.links()); },
          py::arg("name"), "The index of a link. Raises Error for an unknown name.")
      .def(
          "joint_index",
          [](const RobotModel& robot, const Arg<std::string>& name)
          { return known(robot.jointIndex(name.value), robot, "joint", name.value, robot.joints()); },
          py::arg("name"), "The index of a joint. Raises Error for an unknown name.")
      .def(
          "variable_index",
          [](const RobotModel& robot, const Arg<std::string>& name)
          { return known(robot.variableIndex(name.value), robot, "variable", name.value, robot.variables()); },
          py::arg("name"), "The column of a variable in a state. Raises Error for an unknown name.")
      .def(
          "group", [](const RobotModel& robot, const Arg<std::string>& name) { return robot.group(name.value); },
          py::arg("name"), "A group. Raises Error that lists the groups if it is unknown.")
      .def(
          "named_state",
          [](const RobotModel& robot, const Arg<std::string>& name) { return robot.namedState(name.value); },
          py::arg("name"),
          "The state of the SRDF with this name: NAME or GROUP/NAME. Raises Error that lists the states if there is "
          "none.")
      .def(
          "default_state",
          [](const RobotModel& robot)
          {
            const std::vector<double> state = robot.defaultState();
            return py::array_t<double>(static_cast<py::ssize_t>(state.size()), state.data());
          },
          "A state with all variables 0, or in the middle of their limits if 0 is outside. Shape (variables,).")
      .def("random_states", &randomStates, py::arg("count"), py::arg("seed"), py::arg("base") = py::none(),
           py::arg("out") = py::none(), py::arg("moves_base") = false,
           "Random states within the joint limits, shape (count, variables).\n\nThe same seed gives the same states "
           "as the tool check_states if base is the state of the scene. base: a state of shape (variables,), by "
           "default default_state(). Planar and "
           "floating joints, such as a virtual joint, have its values. moves_base: these joints get random values "
           "too; base must not be given then. out: an array of float64 in the order of C, of the shape of the result, "
           "which gets the states and is returned. Ctrl-C ends a long call.\n\n"
           "    states = robot.random_states(1000, seed=1)")
      .def("link_poses", &linkPoses, py::arg("states"),
           "Forward kinematics: the pose of each link in the planning frame, for each state.\n\nstates: shape "
           "(n, variables) or (variables,), or names of states of the SRDF that set all variables. Returns matrices of "
           "shape (n, links, 4, 4) or (links, 4, 4). Raises Error "
           "for another shape. Ctrl-C ends a long call.\n\n"
           "    poses = robot.link_poses(states)\n    tool = poses[:, robot.link_index(\"palm\")]")
      .def_static("_from_files_with_texts", &withTexts, py::arg("urdf"), py::arg("srdf"), py::arg("packages"),
                  py::arg("files"), py::arg("planning"),
                  "from_files, and the texts of the URDF and of the SRDF. For the robots of bulk runs.")
      .def("__repr__", [](const RobotModel& robot) { return "<RobotModel '" + robot.name() + "'>"; });
}
}  // namespace gpu_planning_scene::python
