#include "lanes/workloads.h"

#include <algorithm>
#include <functional>
#include <map>
#include <random>
#include <stdexcept>

#include "collision/exact/exact_checker.h"
#include "collision/gpu/gpu_checker.h"
#include "collision/gpu/tree_build/gpu_trees.h"
#include "collision/trees/binned_sah.h"
#include "gpu/float_arithmetic.h"
#include "gpu/program.h"
#include "gpu/readback.h"
#include "gpu/staging_ring.h"
#include "lanes/gl_device.h"
#include "lanes/kernel_library.h"
#include "shader_constants.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr std::size_t kStates = 24;

Isometry3d at(double x, double y, double z)
{
  return Isometry3d(Eigen::Translation3d(x, y, z));
}

/// A surface of cells x cells squares of 0.1 m with hills of 0.04 m. Copies of it above each other do not touch, but
/// their boxes overlap.
std::shared_ptr<const Mesh> hills(int cells)
{
  auto mesh = std::make_shared<Mesh>();
  for (int i = 0; i <= cells; ++i)
    for (int j = 0; j <= cells; ++j)
      mesh->vertices.emplace_back(0.1 * i, 0.1 * j, 0.04 * ((i * 7 + j * 5) % 3));
  const auto row = static_cast<std::uint32_t>(cells + 1);
  for (std::uint32_t i = 0; i + 1 < row; ++i)
    for (std::uint32_t j = 0; j + 1 < row; ++j)
    {
      const std::uint32_t corner = i * row + j;
      mesh->triangles.push_back({corner, corner + row, corner + 1});
      mesh->triangles.push_back({corner + 1, corner + row, corner + row + 1});
    }
  // Triangles without area.
  mesh->triangles.push_back({row, row, row + 1});
  mesh->triangles.push_back({0, 1, 1});
  mesh->triangles.push_back({row + 1, row + 1, row + 1});
  return mesh;
}

std::uint32_t addTree(CollisionProblem& problem, const Shape& shape)
{
  problem.tessellations.push_back(tessellate(shape));
  problem.shapes.insert(problem.shapes.end(), 1, shape);
  return static_cast<std::uint32_t>(problem.shapes.size() - 1);
}

/// A lift with hills and an arm with a block above hills. `objects`: number of the other objects.
std::shared_ptr<CollisionProblem> problemOf(std::size_t objects)
{
  auto problem = std::make_shared<CollisionProblem>();
  const std::uint32_t few = addTree(*problem, hills(4));
  const std::uint32_t block = addTree(*problem, tessellate(Box{{0.05, 0.07, 0.03}}).mesh);
  problem->robot = {{few, 1, 1, at(0.0, 0.0, 0.0)}, {block, 2, 2, at(0.1, 0.0, 0.1), 0.002}};
  problem->self_pairs = {{0, 1}};
  std::int32_t body = 3;
  const auto add = [&](const Shape& shape, const Isometry3d& pose, double padding) {
    problem->world.push_back({addTree(*problem, shape), body++, -1, pose, padding});
  };
  problem->world.push_back({few, body++, -1, at(0.0, 0.0, -0.01)});
  const std::vector<std::function<void()>> others = {
      [&] { add(hills(9), at(0.25, -0.3, 0.05), 0.001); },
      [&] {
        add(tessellate(Box{{0.1, 0.1, 0.1}}).mesh, at(0.35, 0.2, 0.2), 0.0);
      },
      [&] {
        add(Cylinder{0.04, 0.1}, at(0.2, 0.35, 0.2), 0.001);
      },
      [&] {
        add(Box{{0.05, 0.04, 0.03}}, at(0.3, 0.1, 0.15), 0.0);
      },
  };
  for (std::size_t i = 0; i < objects; ++i)
    others[i]();
  problem->world_pairs.assign(2 * problem->world.size(), 1);
  problem->half_spaces = {{body, Vector3d(0.1, 0.2, 1.0).normalized(), -0.02, 0.001}};
  problem->half_space_pairs = {0, 1};
  problem->origin = {0.1, 0.2, 0.0};
  return problem;
}

std::shared_ptr<const RobotModel> liftAndArm()
{
  return RobotModel::fromXml(R"(<robot name="lift_and_arm"><link name="base"/><link name="lift"/><link name="arm"/>
      <joint name="rise" type="prismatic"><parent link="base"/><child link="lift"/><axis xyz="0 0 1"/>
        <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
      <joint name="turn" type="continuous"><parent link="lift"/><child link="arm"/><axis xyz="0.3 0.2 1"/>
        <origin xyz="0.2 0.2 0.12"/></joint></robot>)",
                             "", {});
}

/// Checks two batches of states in two scenes, of which the second has more objects.
std::vector<std::string> checkStates(Traversal traversal, const std::string& shaders, std::uint64_t seed)
{
  std::vector<std::string> wrong;
  BatchCheckerOptions options;
  options.traversal = traversal;
  options.shader_folder = shaders;
  options.max_batch = kStates;
  GpuChecker checker(options);
  if (!checker.fault().empty())
    wrong.push_back("the test of the arithmetic fails: " + checker.fault());
  const auto robot = liftAndArm();
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> height(-0.008, 0.04);
  std::uniform_real_distribution<double> angle(-3.0, 3.0);
  for (const std::size_t objects : {1, 4})
  {
    const auto problem = problemOf(objects);
    checker.setProblem(problem, robot);
    std::vector<double> states;
    for (std::size_t i = 0; i < kStates; ++i)
      for (const double value : {height(generator), angle(generator)})
        states.push_back(value);
    BatchResult result;
    checker.check(states.data(), kStates, result);
    const ExactChecker exact(problem, std::make_shared<const Forest>(buildBinnedSah(problem->tessellations)));
    ExactChecker::Scratch scratch;
    std::vector<Isometry3d> links(robot->links().size());
    for (std::size_t i = 0; i < kStates; ++i)
    {
      robot->linkPoses(&states[2 * i], links.data());
      if ((result.valid[i] != 0) != !exact.firstCollision(links.data(), scratch))
        wrong.push_back("state " + std::to_string(i) + " of " + std::to_string(kStates) + " is called " +
                        (result.valid[i] != 0 ? "free" : "a collision"));
    }
  }
  return wrong;
}

/// Builds the trees of a scene, then those of a changed scene. GpuTrees checks them.
std::vector<std::string> buildTrees(const std::string& shaders)
{
  GpuTrees trees(shaders);
  const Tessellation few{hills(4), 0.0};
  trees.setShapes({few, tessellate(Box{{0.05, 0.07, 0.03}})});
  trees.setShapes({few, Tessellation{hills(9), 0.0}, tessellate(Box{{0.1, 0.1, 0.1}}), Tessellation{hills(2), 0.0}});
  return {};
}

std::vector<std::string> testArithmetic(const std::string& shaders)
{
  std::vector<std::string> wrong;
  for (const std::string& fault : {findFloatFault(shaders), findDoubleFault(shaders)})
    if (!fault.empty())
      wrong.push_back(fault);
  return wrong;
}

/// Transfers directly after a dispatch that writes to their buffer.
std::vector<std::string> transferAfterDispatches(const std::string& shaders)
{
  constexpr std::size_t kBytes = GROUP_SIZE * sizeof(std::uint32_t);
  const Program program = Program::fromText(shaders, "numbers", R"(// One invocation per number: writes 7.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
layout(std430, binding = 0) buffer Numbers { uint numbers[]; };
void main()
{
  numbers[gl_LocalInvocationID.x] = 7u;
}
)");
  Buffer numbers(kBytes);
  numbers.bindStorage(0);
  std::vector<std::string> wrong;
  const auto expect = [&](const std::string& what, const std::uint32_t* found, std::uint32_t number)
  {
    if (std::count(found, found + GROUP_SIZE, number) != GROUP_SIZE)
      wrong.push_back(what + " gives wrong numbers");
  };
  std::vector<std::uint32_t> found(GROUP_SIZE);
  program.dispatch(1);
  numbers.read(found.data(), kBytes);
  expect("a download", found.data(), 7);
  program.dispatch(1);
  numbers.write(std::vector<std::uint32_t>(GROUP_SIZE, 8));
  numbers.read(found.data(), kBytes);
  expect("an upload", found.data(), 8);
  program.dispatch(1);
  numbers.clear();
  numbers.read(found.data(), kBytes);
  expect("a buffer that was cleared", found.data(), 0);
  program.dispatch(1);
  Buffer copy(kBytes);
  copy.copyFrom(numbers, kBytes);
  copy.read(found.data(), kBytes);
  expect("a copy", found.data(), 7);
  program.dispatch(1);
  Readback readback;
  readback.begin(numbers, kBytes);
  expect("a readback", readback.wait(), 7);
  return wrong;
}

/// Uploads, clears, copies, downloads and readbacks of random parts of buffers, compared with the same operations on
/// vectors. The uploads are larger than the staging ring.
std::vector<std::string> mixTransfers(std::uint64_t seed)
{
  constexpr std::size_t kWords = StagingRing::kFirstPieceBytes / sizeof(std::uint32_t) - 64;
  constexpr std::size_t kBytes = kWords * sizeof(std::uint32_t);
  constexpr int kOperations = 60;
  std::mt19937_64 generator(seed);
  const auto below = [&generator](std::size_t end) { return static_cast<std::size_t>(generator() % end); };
  std::vector<Buffer> buffers;
  std::vector<std::vector<std::uint32_t>> expected(2, std::vector<std::uint32_t>(kWords, 0));
  for (std::size_t i = 0; i < expected.size(); ++i)
  {
    buffers.emplace_back(kBytes);
    buffers.back().clear();
  }
  std::vector<std::string> wrong;
  std::vector<std::uint32_t> found(kWords);
  Readback readback;
  for (int i = 0; i < kOperations; ++i)
  {
    const std::size_t one = below(2);
    const std::size_t other = 1 - one;
    const std::size_t first = below(4) == 0 ? 0 : kWords - 1 - below(64);
    const auto begin = expected[one].begin() + static_cast<std::ptrdiff_t>(first);
    switch (below(5))
    {
      case 0:
      case 1:
        std::generate(begin, expected[one].end(), [&generator] { return static_cast<std::uint32_t>(generator()); });
        buffers[one].write(&*begin, (kWords - first) * sizeof(std::uint32_t), first * sizeof(std::uint32_t));
        break;
      case 2:
        std::fill(begin, expected[one].end(), 0U);
        buffers[one].clear(first * sizeof(std::uint32_t), (kWords - first) * sizeof(std::uint32_t));
        break;
      case 3:
        std::copy_n(expected[one].begin(), kWords - first, expected[other].begin());
        buffers[other].copyFrom(buffers[one], (kWords - first) * sizeof(std::uint32_t));
        break;
      default:
        readback.begin(buffers[one], kBytes);
        buffers[one].clear(0, sizeof(std::uint32_t));
        if (!std::equal(expected[one].begin(), expected[one].end(), readback.wait()))
          wrong.push_back("readback " + std::to_string(i) + " gives wrong numbers");
        expected[one][0] = 0;
    }
  }
  for (std::size_t i = 0; i < buffers.size(); ++i)
  {
    buffers[i].read(found.data(), kBytes);
    if (found != expected[i])
      wrong.push_back("buffer " + std::to_string(i) + " has wrong numbers at the end");
  }
  return wrong;
}

using Task = std::function<std::vector<std::string>(const std::string&, std::uint64_t)>;

const std::map<std::string, Task>& tasks()
{
  static const std::map<std::string, Task> all = {
      {"arithmetic", [](const std::string& shaders, std::uint64_t) { return testArithmetic(shaders); }},
      {"buffers", [](const std::string& shaders, std::uint64_t) { return transferAfterDispatches(shaders); }},
      {"breadth_first", [](const std::string& shaders, std::uint64_t seed)
       { return checkStates(Traversal::BreadthFirst, shaders, seed); }},
      {"work_queue",
       [](const std::string& shaders, std::uint64_t seed) { return checkStates(Traversal::WorkQueue, shaders, seed); }},
      {"trees", [](const std::string& shaders, std::uint64_t) { return buildTrees(shaders); }},
      {"transfers", [](const std::string&, std::uint64_t seed) { return mixTransfers(seed); }},
      {"transforms", checkTransforms},
      {"triangles", checkTriangles},
      {"distances", checkDistances},
      {"kinematics", checkKinematics},
      {"crossings", checkCrossings},
      {"containment", checkContainment},
      {"solids", checkSolids},
      {"boxes", checkBoxes},
      {"far_links", checkFarLinks},
      {"half_spaces", checkHalfSpaces},
      {"proofs", checkProofs},
      {"turning_boxes", checkTurningBoxes},
      {"balls", checkBalls},
  };
  return all;
}
}  // namespace

std::vector<std::string> workloadNames()
{
  std::vector<std::string> names;
  for (const auto& [name, task] : tasks())
    names.push_back(name);
  return names;
}

std::vector<std::string> runWorkload(const std::string& name, const std::string& shaders, std::uint64_t seed)
{
  const auto task = tasks().find(name);
  if (task == tasks().end())
    throw std::runtime_error("there is no workload " + name);
  ::lanes::device().setSeed(seed);
  ::lanes::device().clearFaults();
  std::vector<std::string> wrong;
  try
  {
    wrong = task->second(shaders, seed);
  }
  catch (const ::lanes::TranslationError&)
  {
    throw;
  }
  catch (const std::exception& error)
  {
    wrong.push_back(std::string("the task ends with an exception: ") + error.what());
  }
  const auto& faults = ::lanes::device().faults();
  std::vector<std::string> all(faults.begin(), faults.end());
  all.insert(all.end(), wrong.begin(), wrong.end());
  return all;
}
}  // namespace gpu_planning_scene::core
