#include "peers/vamp/vamp_check.h"

#include <algorithm>
#include <cstring>

#include <dlfcn.h>

#include "gpu_planning_scene/error.h"
#include "peers/vamp/vamp_library.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

/// Either the functions, or the reason why there are none.
struct Loaded
{
  const VampLibrary* library = nullptr;
  std::string missing;
};

bool processorHasAvx2()
{
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

/// The library is opened at run time, because a processor without AVX2 must not run any of its code.
Loaded load()
{
  const std::string path = GPS_VAMP_LIBRARY;
  if (path.empty())
    return {nullptr, "this build found no VAMP; CONTRIBUTING.md (Data that is not in the repository) names its source"};
  if (!processorHasAvx2())
    return {nullptr, "VAMP needs a processor with AVX2 and FMA"};
  void* const opened = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const symbol = opened != nullptr ? dlsym(opened, "gpsVampLibrary") : nullptr;
  if (symbol == nullptr)
    return {nullptr, "cannot open the library with VAMP: " + std::string(dlerror())};
  decltype(&gpsVampLibrary) functions = nullptr;
  std::memcpy(&functions, &symbol, sizeof(functions));
  return {&functions(), ""};
}

const Loaded& loaded()
{
  static const Loaded once = load();
  return once;
}

/// Throws Error if there is none.
const VampLibrary& requiredLibrary()
{
  if (loaded().library == nullptr)
    throw Error(loaded().missing);
  return *loaded().library;
}

void copyTo(float (&to)[3], const Vector3d& from)
{
  for (int i = 0; i < 3; ++i)
    to[i] = static_cast<float>(from[i]);
}

/// Collects the shapes of a world in VAMP's terms.
class Shapes
{
 public:
  explicit Shapes(VampCylinders cylinders) : cylinders_(cylinders) {}

  void add(const Shape& shape, const Isometry3d& pose)
  {
    if (const Box* box = std::get_if<Box>(&shape))
      addBox(pose, 0.5 * box->size);
    else if (const Sphere* sphere = std::get_if<Sphere>(&shape))
    {
      VampSphere made{{}, static_cast<float>(sphere->radius)};
      copyTo(made.center, pose.translation());
      spheres_.push_back(made);
    }
    else if (const Cylinder* cylinder = std::get_if<Cylinder>(&shape))
    {
      if (cylinders_ == VampCylinders::Boxes)
        addBox(pose, {cylinder->radius, cylinder->radius, 0.5 * cylinder->length});
      else
        addCapsule(pose, *cylinder);
    }
  }

  VampShapes all() const
  {
    return {spheres_.data(), spheres_.size(), capsules_.data(), capsules_.size(), boxes_.data(), boxes_.size()};
  }

 private:
  void addBox(const Isometry3d& pose, const Vector3d& half)
  {
    VampBox made{};
    copyTo(made.center, pose.translation());
    for (int i = 0; i < 3; ++i)
      copyTo(made.axes[i], pose.linear().col(i));
    copyTo(made.half, half);
    boxes_.push_back(made);
  }

  void addCapsule(const Isometry3d& pose, const Cylinder& cylinder)
  {
    VampCapsule made{{}, static_cast<float>(cylinder.radius)};
    copyTo(made.ends[0], pose * Vector3d(0.0, 0.0, 0.5 * cylinder.length));
    copyTo(made.ends[1], pose * Vector3d(0.0, 0.0, -0.5 * cylinder.length));
    capsules_.push_back(made);
  }

  VampCylinders cylinders_;
  std::vector<VampSphere> spheres_;
  std::vector<VampCapsule> capsules_;
  std::vector<VampBox> boxes_;
};

/// Empty if VAMP knows shapes of this kind.
std::string unknownKindOf(const Shape& shape)
{
  if (std::holds_alternative<std::shared_ptr<const Mesh>>(shape))
    return "a mesh";
  if (std::holds_alternative<Cone>(shape))
    return "a cone";
  return std::holds_alternative<HalfSpace>(shape) ? "a half-space" : "";
}

/// Whether VAMP's joints are the variables of the robot.
bool isItsUr5(const RobotModel& robot)
{
  constexpr const char* kName = "ur5_robotiq85";  // VAMP's sphere model has the gripper too
  const auto& names = requiredLibrary().joint_names;
  return robot.name() == kName && robot.variables().size() == kVampJoints &&
         std::all_of(std::begin(names), std::end(names),
                     [&](const char* name) { return robot.variableIndex(name) >= 0; });
}

bool areAll(const std::vector<double>& values, double wanted)
{
  return std::all_of(
      values.begin(), values.end(), [&](double value) { return value == wanted; });
}
}  // namespace

VampCylinders vampCylindersOf(const std::string& name)
{
  return name == "box" || name == "ur5_box" ? VampCylinders::Boxes : VampCylinders::Capsules;
}

std::string whyNoVamp()
{
  return loaded().missing;
}

std::string whyVampRefuses(const PlanningScene& scene)
{
  if (!isItsUr5(*scene.robot))
    return "VAMP's check is generated for one robot, the ur5 with the Robotiq gripper";
  if (!scene.attached.empty())
    return "VAMP's check of this benchmark has no attached objects, but the robot carries " +
           scene.attached.front().object.id;
  if (!areAll(scene.link_padding, 0.0))
    return "VAMP has no padding, but a link has one";
  if (!areAll(scene.robot->linkScale(), 1.0))
    return "VAMP's robot has one size, but a link is scaled";
  for (const WorldObject& object : scene.objects)
  {
    if (object.padding != 0.0)
      return "VAMP has no padding, but object " + object.id + " has one";
    for (const PlacedShape& placed : object.shapes)
      if (const std::string kind = unknownKindOf(placed.shape); !kind.empty())
        return "VAMP knows spheres, capsules and boxes, but object " + object.id + " has " + kind;
  }
  return "";
}

VampCheck::VampCheck(const PlanningScene& scene, VampCylinders cylinders)
  : library_(requiredLibrary()), width_(scene.robot->variables().size())
{
  if (const std::string reason = whyVampRefuses(scene); !reason.empty())
    throw Error(reason);
  for (const char* name : library_.joint_names)
    columns_.push_back(static_cast<std::size_t>(scene.robot->variableIndex(name)));
  Shapes shapes(cylinders);
  for (const WorldObject& object : scene.objects)
    for (const PlacedShape& placed : object.shapes)
      shapes.add(placed.shape, object.pose * placed.pose);
  world_.reset(library_.make_world(shapes.all()), library_.delete_world);
}

void VampCheck::check(const double* states, std::size_t count, std::uint8_t* valid) const
{
  std::vector<float> rows;
  rows.reserve(count * columns_.size());
  for (std::size_t i = 0; i < count; ++i)
    for (const std::size_t column : columns_)
      rows.push_back(static_cast<float>(states[i * width_ + column]));
  library_.check(*world_, rows.data(), count, valid);
}
}  // namespace gpu_planning_scene::core::benchmark
