#include "stability/ours.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "base/parallel_for.h"
#include "collision/cpu/lanes/lane_buffers.h"
#include "collision/cpu/lanes/lane_kernel.h"
#include "collision/exact/exact_checker.h"
#include "collision/gpu/gpu_checker.h"
#include "collision/trees/binned_sah.h"

namespace gpu_planning_scene::core::stability
{
namespace
{
constexpr std::size_t kCasesPerProblem = 64;
constexpr double kFarApart = 1e5;  // metres: larger than every case

std::uint32_t treeOf(const Shape& shape, CollisionProblem& problem)
{
  const auto same =
      std::find_if(problem.shapes.begin(), problem.shapes.end(), [&](const Shape& s) { return sameShape(s, shape); });
  if (same != problem.shapes.end())
    return static_cast<std::uint32_t>(same - problem.shapes.begin());
  problem.shapes.push_back(shape);
  problem.tessellations.push_back(tessellate(shape));
  return static_cast<std::uint32_t>(problem.shapes.size() - 1);
}

BatchCheckerOptions gpuOptions(const std::string& device, const std::string& shaders, Traversal traversal)
{
  BatchCheckerOptions options;
  options.device = device;
  options.shader_folder = shaders;
  options.traversal = traversal;
  options.max_batch = kCasesPerProblem;
  return options;
}

/// `count` cases as one problem. Shape a of case i is on link i. In a `self` case, shape b is on link count + i.
struct Part
{
  const Case* cases;
  std::size_t count;
  std::shared_ptr<CollisionProblem> problem = std::make_shared<CollisionProblem>();

  Part(const Case* first, std::size_t case_count, const Eigen::Vector3d& origin) : cases(first), count(case_count)
  {
    problem->origin = origin;
    for (std::size_t i = 0; i < count; ++i)
    {
      const auto link = static_cast<std::int32_t>(i);
      problem->robot.push_back({treeOf(cases[i].a, *problem), link, link, cases[i].a_in_link, cases[i].padding_a});
    }
    const auto links = static_cast<std::int32_t>(count);
    for (std::size_t i = 0; i < count; ++i)
    {
      const auto other = links + static_cast<std::int32_t>(i);
      if (const auto* half_space = std::get_if<HalfSpace>(&cases[i].b))
        problem->half_spaces.push_back({other, half_space->normal, half_space->offset, cases[i].padding_b});
      else if (cases[i].self)
      {
        problem->self_pairs.push_back(
            {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(problem->robot.size())});
        problem->robot.push_back(
            {treeOf(cases[i].b, *problem), other, other, Eigen::Isometry3d::Identity(), cases[i].padding_b});
      }
      else
        problem->world.push_back({treeOf(cases[i].b, *problem), other, -1, cases[i].pose_b, cases[i].padding_b});
    }
    problem->world_pairs.assign(problem->robot.size() * problem->world.size(), 0);
    problem->half_space_pairs.assign(problem->robot.size() * problem->half_spaces.size(), 0);
    std::size_t object = 0;
    std::size_t half_space = 0;
    for (std::size_t i = 0; i < count; ++i)
      if (std::holds_alternative<HalfSpace>(cases[i].b))
        problem->half_space_pairs[i * problem->half_spaces.size() + half_space++] = 1;
      else if (!cases[i].self)
        problem->world_pairs[i * problem->world.size() + object++] = 1;
  }

  std::size_t linkCount() const { return 2 * count; }

  void linkPoses(std::size_t state, Eigen::Isometry3d* poses) const
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      poses[i] = cases[i].link_a;
      poses[count + i] = cases[i].pose_b;
      if (i == state)
        continue;
      const auto* half_space = std::get_if<HalfSpace>(&cases[i].b);
      poses[i].translation() += kFarApart * (half_space ? half_space->normal : Eigen::Vector3d::UnitX());
    }
  }
};
/// A robot of two links that can be anywhere: link 0 has shape a, link 1 has shape b of a `self` case.
std::shared_ptr<const RobotModel> twoFloatingLinks()
{
  return RobotModel::fromXml(R"(<robot name="pair"><link name="a"/><link name="b"/>
      <joint name="between" type="floating"><parent link="a"/><child link="b"/></joint></robot>)",
                             R"(<robot name="pair">
      <virtual_joint name="base" type="floating" parent_frame="world" child_link="a"/></robot>)",
                             {});
}

RobotProofs ballsOf(const CollisionProblem& problem, const CpuForest& forest)
{
  RobotProofs proofs;
  for (const ShapeInstance& instance : problem.robot)
  {
    const CpuTree& tree = forest.tree(instance.tree);
    proofs.covers.push_back(std::make_shared<const BallCover>(
        coverOf(tree, samplesOf(tree), problem.tessellations[instance.tree].sagitta)));
  }
  proofs.tables.resize(problem.self_pairs.size());
  return proofs;
}

/// Sets the variables of a floating joint.
void setFloating(const Eigen::Isometry3d& pose, const Joint& joint, std::vector<double>& state)
{
  const Eigen::Quaterniond rotation(pose.linear());
  double* const values = &state[static_cast<std::size_t>(joint.first_variable)];
  Eigen::Map<Eigen::Vector3d>{values} = pose.translation();
  Eigen::Map<Eigen::Vector4d>{values + 3} = rotation.coeffs();
}

/// The verdict that the lane kernels of all instruction sets prove for a case.
Proof proofOf(const std::shared_ptr<const RobotModel>& robot, const Case& made, const Eigen::Vector3d& origin)
{
  const Part part(&made, 1, origin);
  const CpuForest forest(*part.problem);
  const LaneScene scene(*robot, *part.problem, forest,
                        std::make_shared<const RobotProofs>(ballsOf(*part.problem, forest)));
  std::vector<Eigen::Isometry3d> poses(part.linkCount());
  part.linkPoses(0, poses.data());
  std::vector<double> state = robot->defaultState();
  setFloating(poses[0], robot->joints()[static_cast<std::size_t>(robot->jointIndex("base"))], state);
  setFloating(poses[0].inverse() * poses[1], robot->joints()[static_cast<std::size_t>(robot->jointIndex("between"))],
              state);
  if (!scene.isWithinBounds(state.data()))
    return Proof::None;
  // A kernel may prove what another one leaves open.
  Proof proof = Proof::None;
  for (const lanes::NamedKernel& kernel : lanes::availableKernels())
  {
    LaneBuffers buffers;
    lanes::Block block;
    kernel.kernel(scene.model(), state.data(), 1, nullptr, buffers.of(scene), block);
    const Proof other = block.proof[0];
    if (proof != Proof::None && other != Proof::None && proof != other)
      throw std::logic_error(kernel.instructions + std::string(": the kernels prove different verdicts"));
    proof = other == Proof::None ? proof : other;
  }
  return proof;
}
}  // namespace

struct Ours::Impl
{
  GpuChecker work_queue;
  GpuChecker breadth_first;
  std::size_t with_proofs;
  std::shared_ptr<const RobotModel> robot = twoFloatingLinks();

  static std::size_t append(GpuChecker& checker, const Part& part, std::vector<std::uint8_t>& answers)
  {
    BatchResult result;
    checker.setProblem(part.problem);
    checker.checkPoses(
        part.count, part.linkCount(), [&](std::size_t row, Eigen::Isometry3d* poses) { part.linkPoses(row, poses); },
        result);
    for (const std::uint8_t valid : result.valid)
      answers.push_back(valid ? 0 : 1);
    return result.undecided_states;
  }

  static void appendExact(const Part& part, std::vector<std::uint8_t>& answers)
  {
    const core::ExactChecker exact(part.problem,
                                   std::make_shared<const Forest>(buildBinnedSah(part.problem->tessellations)));
    core::ExactChecker::Scratch scratch;
    std::vector<Eigen::Isometry3d> poses(part.linkCount());
    for (std::size_t i = 0; i < part.count; ++i)
    {
      part.linkPoses(i, poses.data());
      answers.push_back(exact.firstCollision(poses.data(), scratch) ? 1 : 0);
    }
  }

  void addProofs(const std::vector<Case>& cases, const Eigen::Vector3d& origin, Answers& answers) const
  {
    std::vector<Proof> proofs(std::min(cases.size(), with_proofs));
    parallelFor(proofs.size(), 1, [&](std::size_t i, std::size_t) { proofs[i] = proofOf(robot, cases[i], origin); });
    for (const Proof proof : proofs)
    {
      answers.proven += proof == Proof::None ? 0 : 1;
      answers.proofs.push_back(proof == Proof::None ? answers.exact[answers.proofs.size()]
                                                    : static_cast<std::uint8_t>(proof == Proof::Colliding));
    }
  }
};

Ours::Ours(const std::string& device, const std::string& shaders, std::size_t with_proofs)
  : impl_(new Impl{GpuChecker(gpuOptions(device, shaders, Traversal::WorkQueue)),
                   GpuChecker(gpuOptions(device, shaders, Traversal::BreadthFirst)), with_proofs})
{
}

Ours::~Ours() = default;

Ours::Answers Ours::check(const std::vector<Case>& cases, const Eigen::Vector3d& origin)
{
  Answers answers;
  for (std::size_t begin = 0; begin < cases.size(); begin += kCasesPerProblem)
  {
    const Part part(&cases[begin], std::min(kCasesPerProblem, cases.size() - begin), origin);
    answers.undecided += Impl::append(impl_->work_queue, part, answers.work_queue);
    Impl::append(impl_->breadth_first, part, answers.breadth_first);
    Impl::appendExact(part, answers.exact);
  }
  impl_->addProofs(cases, origin, answers);
  return answers;
}

std::string Ours::deviceName() const
{
  return impl_->work_queue.device().renderer;
}
}  // namespace gpu_planning_scene::core::stability
