#include "bindings/arguments.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <numeric>

#include <pybind11/stl.h>

#include "base/text/name_list.h"
#include "base/text/utf8.h"
#include "bindings/named_rows.h"
#include "gpu_planning_scene/error.h"
#include "model/joint_limits.h"
#include "model/rigid_pose.h"

namespace gpu_planning_scene::python
{
namespace
{
constexpr std::size_t kLongestText = 60;

std::string shapeText(const py::array& array)
{
  return py::str(array.attr("shape"));
}

std::string variablesText(const core::RobotModel& robot)
{
  std::string names;
  for (const core::Variable& variable : robot.variables())
    names += (names.empty() ? "" : ", ") + variable.name;
  return std::to_string(robot.variables().size()) + " variables (" + names + ")";
}

/// A Python function from a str to a path or None. The result may be called, copied and destroyed without the
/// interpreter's lock. `what`: the path, for a message.
std::function<std::string(const std::string&)> pathFunctionOf(py::function function, const char* what)
{
  const std::shared_ptr<py::function> shared(new py::function(std::move(function)),
                                             [](py::function* owned)
                                             {
                                               const py::gil_scoped_acquire lock;
                                               delete owned;
                                             });
  return [shared, what](const std::string& name)
  {
    const py::gil_scoped_acquire lock;
    return pathFrom((*shared)(name), what);
  };
}

/// Whether an object is a numpy.ma.MaskedArray, or of a class that is derived from it.
bool isMasked(py::handle object)
{
  // To look for the mask of a plain array takes a seventh of the time of a call with one state.
  if (std::strcmp(Py_TYPE(object.ptr())->tp_name, "numpy.ndarray") == 0)
    return false;
  return py::isinstance<py::array>(object) && py::hasattr(object, "mask") &&
         py::isinstance(object, py::module_::import("numpy.ma").attr("MaskedArray"));
}

bool isListOrTuple(py::handle object)
{
  return py::isinstance<py::list>(object) || py::isinstance<py::tuple>(object);
}

bool hasMasked(py::handle list)
{
  const auto items = py::reinterpret_borrow<py::sequence>(list);
  return std::any_of(items.begin(), items.end(), [](const py::handle& item) { return isMasked(item); });
}

/// The names of the columns of a table such as a pandas.DataFrame, or of the values of a pandas.Series. Empty if the
/// columns have numbers, or if the object is no table.
std::vector<std::string> columnsOf(py::handle object)
{
  std::vector<std::string> columns;
  if (py::isinstance<py::array>(object))
    return columns;
  const char* attribute = py::hasattr(object, "column_names") ? "column_names"  // pyarrow.Table
                          : py::hasattr(object, "columns")    ? "columns"
                          : py::hasattr(object, "to_frame")   ? "index"
                                                              : nullptr;
  if (attribute == nullptr || !py::hasattr(object, attribute))
    return columns;
  bool has_text = false;
  for (const py::handle name : object.attr(attribute))
  {
    has_text = has_text || py::isinstance<py::str>(name);
    columns.push_back(py::str(name));
  }
  return has_text ? columns : std::vector<std::string>();
}

/// Throws Error for a table whose columns are not the robot's variables in their order: numpy would read them by their
/// places.
void requireColumns(py::handle object, const core::RobotModel& robot, const char* what)
{
  const std::vector<std::string> columns = columnsOf(object);
  if (columns.empty())
    return;
  const auto has_name = [](const std::string& column, const core::Variable& variable)
  { return column == variable.name; };
  const std::vector<core::Variable>& variables = robot.variables();
  if (!std::equal(columns.begin(), columns.end(), variables.begin(), variables.end(), has_name))
    throw core::Error(std::string(what) + ": the columns are " + core::nameList(columns) + ", but robot '" +
                      robot.name() + "' has " + variablesText(robot) +
                      "; give the table with these columns in this order: table[list(robot.variable_names)]");
}
}  // namespace

py::array anyArrayFrom(py::handle object)
{
  // numpy would turn None and text into numbers if they were converted at once.
  py::array array = py::reinterpret_borrow<py::array>(object);
  if (!py::isinstance<py::array>(object))
    array = py::array::ensure(object);
  PyErr_Clear();
  return array;
}

ArrayOf<double> arrayFrom(py::handle object, const char* what)
{
  const py::array any = anyArrayFrom(object);
  if (isMasked(object) || (isListOrTuple(object) && hasMasked(object)))
    throwTypeError(std::string(what) +
                   ": expected an array of numbers, but got a masked array, whose mask would be lost");
  if (!any || std::string("iuf").find(any.dtype().kind()) == std::string::npos)
    throwTypeError(std::string(what) + ": " + expectedButGot("an array of numbers", object));
  return ArrayOf<double>(any);
}

std::string expectedButGot(const std::string& expected, py::handle got)
{
  std::string text = py::repr(got);
  text = text.substr(0, text.find('\n'));
  if (text.size() > kLongestText)
    text = text.substr(0, kLongestText) + "...";
  return "expected " + expected + ", but got " + text + " (" + Py_TYPE(got.ptr())->tp_name + ")";
}

void throwTypeError(const std::string& message)
{
  throw py::type_error(message);
}

Rows rowsFrom(py::handle object, const core::RobotModel& robot, const char* what, const std::vector<double>* current)
{
  if (const std::vector<std::string> names = namesFrom(object); !names.empty())
  {
    Rows rows = namedRows(names, robot, what, current);
    rows.is_single = py::isinstance<py::str>(object);
    return rows;
  }
  requireColumns(object, robot, what);
  Rows rows;
  rows.array = arrayFrom(object, what);
  rows.is_single = rows.array.ndim() == 1;
  const py::ssize_t width = static_cast<py::ssize_t>(robot.variables().size());
  if (rows.array.ndim() < 1 || rows.array.ndim() > 2 || rows.array.shape(rows.array.ndim() - 1) != width)
    throw core::Error(std::string(what) + ": the shape is " + shapeText(rows.array) + "; it must be (n, " +
                      std::to_string(width) + ") or (" + std::to_string(width) + ",): robot '" + robot.name() +
                      "' has " + variablesText(robot));
  rows.count = rows.is_single ? 1 : static_cast<std::size_t>(rows.array.shape(0));
  return rows;
}

std::vector<double> rowFrom(py::handle object, const core::RobotModel& robot, const char* what,
                            const std::vector<double>* current)
{
  const Rows rows = rowsFrom(object, robot, what, current);
  if (!rows.is_single)
    throw core::Error(std::string(what) + ": the shape is " + shapeText(rows.array) + "; one state is needed, (" +
                      std::to_string(robot.variables().size()) + ",)");
  return {rows.data(), rows.data() + robot.variables().size()};
}

void warnOfValuesOutsideLimits(const Rows& rows, const core::RobotModel& robot, const std::string& what)
{
  std::vector<int> columns(robot.variables().size());
  std::iota(columns.begin(), columns.end(), 0);
  if (const auto outside = core::findDoubtfulValue(robot, columns, rows.data(), rows.count))
    warnOf({what + ": row " + std::to_string(outside->row) + ": " + outside->text});
}

std::vector<double> numbersFrom(py::handle object, std::size_t count, const char* what)
{
  const auto array = arrayFrom(object, what);
  if (array.ndim() != 1 || array.shape(0) != static_cast<py::ssize_t>(count))
    throw core::Error(std::string(what) + ": the shape is " + shapeText(array) + "; " + std::to_string(count) +
                      " numbers are needed");
  return {array.data(), array.data() + count};
}

Eigen::Vector3d vectorFrom(py::handle object, const char* what)
{
  return Eigen::Vector3d(numbersFrom(object, 3, what).data());
}

Eigen::Isometry3d poseFrom(py::handle object, const std::string& where)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (object.is_none())
    return pose;
  std::vector<double> values;
  const bool is_pair = (py::isinstance<py::tuple>(object) || py::isinstance<py::list>(object)) && py::len(object) == 2;
  if (is_pair)
  {
    values = numbersFrom(object[py::int_(0)], 3, (where + ": the position of a pose").c_str());
    const auto rotation = numbersFrom(object[py::int_(1)], 4, (where + ": the quaternion of a pose").c_str());
    values.insert(values.end(), rotation.begin(), rotation.end());
  }
  else
  {
    const auto array = arrayFrom(object, (where + ": a pose").c_str());
    if (array.ndim() == 2 && array.shape(0) == 4 && array.shape(1) == 4)
    {
      pose.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(array.data());
      if (pose.matrix().row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0))
        throw core::Error(where + ": the last row of a pose is not 0, 0, 0, 1");
      return core::nearestRigid(pose, where);
    }
    if (array.ndim() != 1 || (array.shape(0) != 3 && array.shape(0) != 7))
      throw core::Error(where + ": a pose has the shape " + shapeText(array) +
                        "; it must be a matrix (4, 4), x y z, x y z qx qy qz qw, or a pair (xyz, xyzw)");
    values.assign(array.data(), array.data() + array.shape(0));
  }
  pose.translation() = Eigen::Vector3d(values.data());
  if (values.size() == 7)
  {
    const Eigen::Quaterniond rotation(values[6], values[3], values[4], values[5]);
    if (!(rotation.norm() > 0.0))
      throw core::Error(where + ": the quaternion of a pose is zero or not finite; the identity is 0, 0, 0, 1");
    pose.linear() = rotation.normalized().toRotationMatrix();
  }
  return core::nearestRigid(pose, where);
}

py::array_t<double> toPython(const Eigen::Isometry3d& pose)
{
  py::array_t<double> array({4, 4});
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(array.mutable_data()) = pose.matrix();
  return array;
}

py::array_t<double> toPython(const Eigen::Vector3d& vector)
{
  return py::array_t<double>(3, vector.data());
}

std::string pathFrom(py::handle object, const char* what)
{
  if (object.is_none())
    return "";
  PyObject* path = PyOS_FSPath(object.ptr());
  if (path == nullptr)
  {
    PyErr_Clear();
    throwTypeError(std::string(what) + ": " + expectedButGot("a str or a path", object));
  }
  const auto owned = py::reinterpret_steal<py::object>(path);
  PyObject* bytes = nullptr;
  if (PyUnicode_FSConverter(owned.ptr(), &bytes) == 0)
    throw py::error_already_set();
  return py::reinterpret_steal<py::bytes>(bytes);
}

std::map<std::string, std::string> packageFoldersFrom(py::handle object)
{
  std::map<std::string, std::string> folders;
  if (!py::isinstance<py::dict>(object))
    return folders;
  for (const auto& [name, folder] : py::reinterpret_borrow<py::dict>(object))
  {
    if (!py::isinstance<py::str>(name))
      throwTypeError("packages: the name of a package: " + expectedButGot("a str", name));
    folders[name.cast<std::string>()] = pathFrom(folder, "the folder of a package");
  }
  return folders;
}

core::PackageResolver packagesFrom(py::handle object)
{
  if (object.is_none() || py::isinstance<py::dict>(object))
    return core::packageResolver(packageFoldersFrom(object),
                                 "give the folder of NAME in the argument packages of this call");
  if (PyCallable_Check(object.ptr()) == 0)
    throwTypeError("packages: " + expectedButGot("a dict or a function", object));
  return pathFunctionOf(py::reinterpret_borrow<py::function>(object), "the folder of a package");
}

core::MeshAccess meshesFrom(py::handle files)
{
  core::MeshAccess meshes;
  if (files.is_none())
    return meshes;
  if (PyCallable_Check(files.ptr()) == 0)
    throwTypeError("files: " + expectedButGot("a function", files));
  meshes.find = pathFunctionOf(py::reinterpret_borrow<py::function>(files), "the path of a file");
  return meshes;
}

void warnOf(const std::vector<std::string>& warnings)
{
  for (const std::string& warning : warnings)
    if (PyErr_WarnEx(PyExc_UserWarning, core::inUtf8(warning).c_str(), 1) != 0)
      throw py::error_already_set();
}
}  // namespace gpu_planning_scene::python
