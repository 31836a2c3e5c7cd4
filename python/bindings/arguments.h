#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <Eigen/Geometry>

#include "gpu_planning_scene/mesh_reader.h"
#include "gpu_planning_scene/resources.h"
#include "gpu_planning_scene/robot_model.h"

// Conversion of Python's arguments. pybind11 answers an argument of a wrong type with several lines, which show the
// signatures of the C++ functions. These conversions throw an exception with one line.
namespace gpu_planning_scene::python
{
namespace py = pybind11;

/// An argument that must convert to T: a number, a bool, a str, a list of str, or a shared_ptr to an object of this
/// module, which is not null.
template <typename T>
struct Arg
{
  T value;
};

/// "expected a str, but got 5 (int)".
std::string expectedButGot(const std::string& expected, py::handle got);

/// A TypeError with one line.
[[noreturn]] void throwTypeError(const std::string& message);

/// Numbers in the order of C, without a copy if the caller's array has this type and layout.
template <typename T>
using ArrayOf = py::array_t<T, py::array::c_style | py::detail::npy_api::NPY_ARRAY_ALIGNED_>;

/// Rows of doubles. They belong to `array`, which is the caller's own array if its layout allows.
struct Rows
{
  ArrayOf<double> array;
  std::size_t count = 0;
  bool is_single = false;  ///< a one-dimensional array: one row

  const double* data() const { return array.data(); }
};

/// The argument as an array of any type; null if numpy cannot make one of it.
py::array anyArrayFrom(py::handle object);

/// The argument as an array of doubles, without a copy if it is a contiguous one. Numbers of other types are converted,
/// but not complex numbers or text. Throws TypeError.
ArrayOf<double> arrayFrom(py::handle object, const char* what);

/// States of the robot: an array of shape (n, variables) or (variables,), or states that the SRDF names: a str or a
/// list of str. Variables that a named state does not set have the values of `current`, which is the current state of a
/// scene (empty: it has none), or null if the call has no scene. Throws TypeError unless the array has numbers, and
/// Error for another shape, an unknown name, and variables without a value. `what`: "states", for the message.
Rows rowsFrom(py::handle object, const core::RobotModel& robot, const char* what,
              const std::vector<double>* current = nullptr);

/// A state of the robot: an array of shape (variables,), or a state that the SRDF names.
std::vector<double> rowFrom(py::handle object, const core::RobotModel& robot, const char* what,
                            const std::vector<double>* current = nullptr);

/// Warns of values that are outside the limits of their joints, and suggests degrees where they would fit. `what`:
/// "states", for the message.
void warnOfValuesOutsideLimits(const Rows& rows, const core::RobotModel& robot, const std::string& what);

/// `count` numbers. `what`: for the message.
std::vector<double> numbersFrom(py::handle object, std::size_t count, const char* what);
Eigen::Vector3d vectorFrom(py::handle object, const char* what);

/// None (the identity), a matrix of shape (4, 4), three numbers (x, y, z), seven numbers (x, y, z, qx, qy, qz, qw), or
/// a pair (xyz, xyzw). Throws Error that begins with `where` unless it is a rigid motion.
Eigen::Isometry3d poseFrom(py::handle object, const std::string& where);

/// A matrix of shape (4, 4).
py::array_t<double> toPython(const Eigen::Isometry3d& pose);
py::array_t<double> toPython(const Eigen::Vector3d& vector);

/// A str or an os.PathLike; None is an empty path.
std::string pathFrom(py::handle object, const char* what);

/// None, a dict of folders by name, or a function from a name to a folder or None.
core::PackageResolver packagesFrom(py::handle object);
/// The folders by name; empty if `object` is None or a function.
std::map<std::string, std::string> packageFoldersFrom(py::handle object);

/// None, or a function from the URI of a mesh or octomap file to its path or None.
core::MeshAccess meshesFrom(py::handle files);

/// Python's warnings, as UserWarning.
void warnOf(const std::vector<std::string>& warnings);

/// Runs `work` without the interpreter's lock, so that other threads of Python run meanwhile.
template <typename Work>
auto withoutLock(const Work& work)
{
  const py::gil_scoped_release released;
  return work();
}

/// A read-only array that shows values of `owner` without copying them. `strides` are in bytes.
template <typename T>
py::array viewOf(const T* values, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides, py::handle owner)
{
  py::array array(py::dtype::of<T>(), std::move(shape), std::move(strides), values, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}
}  // namespace gpu_planning_scene::python

namespace pybind11::detail
{
template <typename T>
struct type_caster<gpu_planning_scene::python::Arg<T>>
{
  PYBIND11_TYPE_CASTER(gpu_planning_scene::python::Arg<T>, make_caster<T>::name);

  bool load(handle source, bool convert)
  {
    if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>)
    {
      // pybind11 would cut off the fraction of numbers such as numpy.float32.
      const object whole = reinterpret_steal<object>(PyNumber_Index(source.ptr()));
      PyErr_Clear();
      if (!whole)
        gpu_planning_scene::python::throwTypeError(gpu_planning_scene::python::expectedButGot(expected(), source));
    }
    make_caster<T> caster;
    if (source.is_none() || !caster.load(source, convert))
      gpu_planning_scene::python::throwTypeError(gpu_planning_scene::python::expectedButGot(expected(), source));
    value.value = cast_op<T>(caster);
    return true;
  }

 private:
  static std::string expected()
  {
    if constexpr (std::is_same_v<T, std::string>)
      return "a str";
    else if constexpr (std::is_same_v<T, std::vector<std::string>>)
      return "a list of str";
    else if constexpr (std::is_same_v<T, bool>)
      return "True or False";
    else if constexpr (std::is_integral_v<T>)
      return "a whole number of at least 0";
    else if constexpr (std::is_arithmetic_v<T>)
      return "a number";
    else
      return "a " + type::of<typename T::element_type>().attr("__name__").template cast<std::string>();
  }
};
}  // namespace pybind11::detail
