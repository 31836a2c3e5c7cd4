#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

/// Collision tests of two rigid meshes from the literature, to be compared with each other and with this package.
namespace gpu_planning_scene::core::literature
{
/// The total work of all calls: a name, for example "box tests", and a number.
using WorkCounts = std::vector<std::pair<std::string, double>>;

/// A collision test of two meshes, prepared for these meshes. Not thread-safe.
class Method
{
 public:
  virtual ~Method() = default;
  /// One byte for each pose of `b` in the frame of `a`: 1 if the method reports a collision, else 0.
  virtual std::vector<std::uint8_t> collide(const std::vector<Eigen::Isometry3d>& b_in_a) = 0;
  virtual WorkCounts work() const { return {}; }
  /// The sizes of what the constructor made, for example "pieces of a".
  virtual WorkCounts built() const { return {}; }
  /// Checks the poses again, and returns the microseconds that parts of this work take. Clocks within a query cost
  /// time, so a timed call of `collide` reads none.
  virtual WorkCounts timesOfParts(const std::vector<Eigen::Isometry3d>& /*b_in_a*/) { return {}; }
  /// The CPU time so far of other processes that work for this method, in seconds.
  virtual double otherCpuSeconds() const { return 0.0; }
};

/// A method that checks one pose after the other.
class PosewiseMethod : public Method
{
 public:
  std::vector<std::uint8_t> collide(const std::vector<Eigen::Isometry3d>& b_in_a) final
  {
    std::vector<std::uint8_t> answers;
    for (const Eigen::Isometry3d& pose : b_in_a)
      answers.push_back(collides(pose) ? 1 : 0);
    return answers;
  }

 protected:
  virtual bool collides(const Eigen::Isometry3d& b_in_a) = 0;
};

/// The cases for which the authors of a method claim correct answers.
struct Domain
{
  bool concave = true;       ///< shapes that are not convex
  bool open = true;          ///< meshes that do not enclose a volume
  bool containment = false;  ///< one shape inside the other, without a common point of the surfaces
};

/// The runs of the program `literature` that measure a method.
enum class Scope
{
  Always,
  FullRun,  ///< not with --quick; the experiment measures it with few models
  Named     ///< only if --methods names it
};

struct MethodInfo
{
  std::string name;    ///< on the command line and in tables
  std::string title;   ///< in charts
  std::string source;  ///< authors and year, or the library and its version
  /// "ours", "paper" (the founding paper's), "trees", "image space", "convex" or "library". Methods of a family have
  /// one colour in charts.
  std::string family;
  Domain domain;
  /// Prepares the method for two meshes. Throws Error if it cannot check them.
  std::function<std::unique_ptr<Method>(const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b)>
      make;
  Scope scope = Scope::Always;
};

/// Trees of bounding volumes on the CPU, after their papers.
std::vector<MethodInfo> treeMethods();
/// The traversal of the founding paper on the device.
std::vector<MethodInfo> deviceMethods();
/// Methods that render the shapes and compare pixels.
std::vector<MethodInfo> imageSpaceMethods();
/// Convex pieces of surfaces.
std::vector<MethodInfo> convexMethods();
/// Other libraries, used as their users use them.
std::vector<MethodInfo> libraryMethods();
/// This package.
std::vector<MethodInfo> ourMethods();
}  // namespace gpu_planning_scene::core::literature
