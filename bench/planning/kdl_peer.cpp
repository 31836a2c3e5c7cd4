#include "planning/kdl_peer.h"

#include <random>

#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_nr_jl.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>

#include "gpu_planning_scene/error.h"
#include "scene/frame.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
constexpr unsigned int kMaxSteps = 100;  // of one attempt, KDL's own default

KDL::Frame frameOf(const Eigen::Isometry3d& pose)
{
  const Eigen::Matrix3d& r = pose.linear();
  const Eigen::Vector3d& t = pose.translation();
  return {KDL::Rotation(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)),
          KDL::Vector(t.x(), t.y(), t.z())};
}
}  // namespace

struct KdlPeer::Impl
{
  const RobotModel& robot;
  int root;
  KDL::Chain chain;
  std::vector<int> variables;  // of the chain's joints
  KDL::JntArray lower;
  KDL::JntArray upper;
  std::mt19937_64 generator{1};
};

KdlPeer::KdlPeer(const RobotModel& robot, const std::string& urdf, const std::string& root, int tip)
  : impl_(new Impl{robot, robot.linkIndex(root), {}, {}, {}, {}})
{
  KDL::Tree tree;
  if (!kdl_parser::treeFromString(urdf, tree) ||
      !tree.getChain(root, robot.links()[static_cast<std::size_t>(tip)].name, impl_->chain))
    throw Error("KDL has no chain from " + root);
  impl_->lower.resize(impl_->chain.getNrOfJoints());
  impl_->upper.resize(impl_->chain.getNrOfJoints());
  for (const KDL::Segment& segment : impl_->chain.segments)
  {
    if (segment.getJoint().getType() == KDL::Joint::None)
      continue;
    const int index = robot.variableIndex(segment.getJoint().getName());
    const Variable& variable = robot.variables()[static_cast<std::size_t>(index)];
    const auto i = static_cast<unsigned int>(impl_->variables.size());
    impl_->variables.push_back(index);
    impl_->lower(i) = variable.lower;
    impl_->upper(i) = variable.upper;
  }
}

KdlPeer::~KdlPeer() = default;

std::optional<std::vector<double>> KdlPeer::solve(const Eigen::Isometry3d& pose, const std::vector<double>& state,
                                                  double tolerance, std::size_t max_attempts)
{
  const KDL::Frame wanted = frameOf(linkPose(impl_->robot, impl_->root, state.data()).inverse() * pose);
  KDL::ChainFkSolverPos_recursive forward(impl_->chain);
  KDL::ChainIkSolverVel_pinv velocity(impl_->chain);
  KDL::ChainIkSolverPos_NR_JL solver(impl_->chain, impl_->lower, impl_->upper, forward, velocity, kMaxSteps, tolerance);
  KDL::JntArray start(impl_->chain.getNrOfJoints());
  KDL::JntArray found(impl_->chain.getNrOfJoints());
  for (std::size_t attempt = 0; attempt < max_attempts; ++attempt)
  {
    for (unsigned int i = 0; i < start.rows(); ++i)
      start(i) = attempt == 0
                     ? state[static_cast<std::size_t>(impl_->variables[i])]
                     : std::uniform_real_distribution<double>(impl_->lower(i), impl_->upper(i))(impl_->generator);
    if (solver.CartToJnt(start, wanted, found) < 0)
      continue;
    std::vector<double> solution = state;
    for (unsigned int i = 0; i < found.rows(); ++i)
      solution[static_cast<std::size_t>(impl_->variables[i])] = found(i);
    return solution;
  }
  return std::nullopt;
}
}  // namespace gpu_planning_scene::core::benchmark
