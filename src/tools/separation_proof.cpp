#include "tools/separation_proof.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "collision/geometry/cpu_box_pair.h"
#include "collision/proofs/joint_chain.h"
#include "collision/proofs/moving_pair.h"

// The joint ranges between two links are a box. A box is proven if the surfaces stay apart while the joints move from
// its middle to its ends (moving_pair.h), and the links do not collide in the middle: then no surface can be crossed,
// so neither link can get into the other. Other boxes are halved, level by level. The halving is that of R. A. Brooks,
// T. Lozano-Perez: A subdivision algorithm in configuration space for findpath with rotation. IJCAI 1983.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

// A robot that holds a joint at its limit may report a position slightly outside of it, see reach.cpp.
constexpr double kBeyondLimit = 1e-3;  // radians or metres

// Halved boxes overlap by this share, against rounding.
constexpr double kWiden = 1e-9;

// A level with this many open boxes is given up if it has most_tests / kFewTests boxes, and more than this share of all
// joint values is open.
constexpr double kHopeless = 0.5;
constexpr std::size_t kFewTests = 16;

/// The axes in the frame of the second body, in the order from the second body to the first.
std::vector<JointAxis> seenFromSecond(const Isometry3d& second_in_first, const std::vector<JointAxis>& axes)
{
  const Isometry3d first_in_second = second_in_first.inverse();
  std::vector<JointAxis> seen(axes.rbegin(), axes.rend());
  for (JointAxis& axis : seen)
  {
    axis.point = first_in_second * axis.point;
    axis.direction = first_in_second.linear() * axis.direction;
  }
  return seen;
}

double displacementOf(const CpuTree& tree, const Isometry3d& pose, const std::vector<JointAxis>& axes)
{
  return displacementBound(axes, pose * tree.center, tree.half.norm());
}
}  // namespace

/// The joints between the two instances that can move, and the variables that move them.
struct SeparationProver::Chain
{
  const ShapeInstance* a;
  const ShapeInstance* b;
  std::vector<const Joint*> joints;
  std::vector<std::size_t> column;  // of each joint: index of its variable
  std::vector<TableVariable> variables;
};

SeparationProver::SeparationProver(std::shared_ptr<const RobotModel> robot, const CollisionProblem& problem,
                                   std::shared_ptr<const CpuForest> forest)
  : robot_(std::move(robot)),
    problem_(problem),
    forest_(std::move(forest)),
    pairs_(forest_),
    state_(robot_->defaultState()),
    poses_(robot_->links().size())
{
}

/// `box`: the middle and the half width of each variable's range. `widest` is set to the variable whose range moves the
/// bodies the most, if the result is Unknown.
Separation SeparationProver::test(const Chain& chain, const double* box, std::size_t& widest)
{
  for (std::size_t k = 0; k < chain.variables.size(); ++k)
    state_[static_cast<std::size_t>(chain.variables[k].variable)] = box[2 * k];
  robot_->linkPoses(state_.data(), poses_.data());
  const Isometry3d pose_a = poses_[static_cast<std::size_t>(chain.a->link)] * chain.a->pose;
  const Isometry3d pose_b = poses_[static_cast<std::size_t>(chain.b->link)] * chain.b->pose;
  const CpuTree& tree_a = forest_->tree(chain.a->tree);
  const CpuTree& tree_b = forest_->tree(chain.b->tree);
  const Isometry3d b_in_a = relativePose(pose_a, pose_b);
  std::vector<JointAxis> axes;
  for (std::size_t i = 0; i < chain.joints.size(); ++i)
  {
    const Joint& joint = *chain.joints[i];
    const Isometry3d parent =
        joint.parent_link < 0 ? Isometry3d::Identity() : poses_[static_cast<std::size_t>(joint.parent_link)];
    const Isometry3d origin = relativePose(pose_a, parent * joint.origin);
    axes.push_back({joint.type == JointType::Prismatic, origin.translation(),
                    (origin.linear() * joint.axis).normalized(),
                    std::abs(joint.multiplier) * box[2 * chain.column[i] + 1] * (1.0 + kWiden)});
  }
  // The bound holds for either body as the moving one. The body nearer to the axes has the smaller bound.
  const std::vector<JointAxis> from_b = seenFromSecond(b_in_a, axes);
  const Isometry3d a_in_b = b_in_a.inverse();
  const bool moves_b = displacementOf(tree_b, b_in_a, axes) <= displacementOf(tree_a, a_in_b, from_b);
  const double required = problem_.tessellations[chain.a->tree].sagitta + problem_.tessellations[chain.b->tree].sagitta;
  std::uint64_t steps = 0;
  const bool apart = moves_b ? surfacesApartWhileMoving(tree_a, tree_b, b_in_a, axes, required, steps, {})
                             : surfacesApartWhileMoving(tree_b, tree_a, a_in_b, from_b, required, steps, {});
  if (pairs_.collide(chain.a->tree, pose_a, chain.b->tree, pose_b, 0.0, scratch_))
    return Separation::Meet;
  if (apart)
    return Separation::Apart;
  std::vector<double> moved(chain.variables.size(), 0.0);
  const Vector3d center = moves_b ? b_in_a * tree_b.center : a_in_b * tree_a.center;
  const double radius = moves_b ? tree_b.half.norm() : tree_a.half.norm();
  for (std::size_t i = 0; i < chain.joints.size(); ++i)
  {
    const JointAxis& axis = moves_b ? axes[i] : from_b[chain.joints.size() - 1 - i];
    const Vector3d offset = center - axis.point;
    const double arm = (offset - axis.direction * axis.direction.dot(offset)).norm() + radius;
    moved[chain.column[i]] += axis.travel * (axis.prismatic ? 1.0 : arm);
  }
  widest = static_cast<std::size_t>(std::max_element(moved.begin(), moved.end()) - moved.begin());
  return Separation::Unknown;
}

Separation SeparationProver::prove(const InstancePair& pair, std::size_t most_tests)
{
  Chain chain;
  chain.a = &problem_.robot[pair[0]];
  chain.b = &problem_.robot[pair[1]];
  const std::vector<ChainJoint> joints = jointsBetween(*robot_, chain.a->link, chain.b->link);
  const std::optional<std::vector<TableVariable>> variables = chainVariables(*robot_, joints);
  if (!variables)
    return Separation::Unknown;
  chain.variables = *variables;
  for (const ChainJoint& part : joints)
    if (part.joint->type != JointType::Fixed)
    {
      chain.joints.push_back(part.joint);
      const auto is_its = [&](const TableVariable& v) { return v.variable == part.joint->first_variable; };
      chain.column.push_back(static_cast<std::size_t>(
          std::find_if(chain.variables.begin(), chain.variables.end(), is_its) - chain.variables.begin()));
    }

  const std::size_t width = 2 * chain.variables.size();
  std::vector<double> boxes;  // rows: see test()
  for (const TableVariable& variable : chain.variables)
  {
    boxes.push_back(variable.lower + 0.5 * variable.cell_width);
    boxes.push_back(0.5 * variable.cell_width + (variable.wraps ? 0.0 : kBeyondLimit));
  }
  std::size_t tests = 0;
  std::size_t open = 1;
  for (double share = 1.0; open != 0; share *= 0.5)  // of a box of this level, of all joint values
  {
    if (tests + open > most_tests || (open > most_tests / kFewTests && static_cast<double>(open) * share > kHopeless))
      return Separation::Unknown;
    tests += open;
    std::vector<double> halves;
    for (std::size_t i = 0; i < open; ++i)
    {
      const double* box = boxes.data() + i * width;
      std::size_t widest = 0;
      const Separation result = test(chain, box, widest);
      if (result == Separation::Meet)
        return result;
      if (result == Separation::Apart)
        continue;
      if (width == 0)
        return Separation::Unknown;
      for (const double side : {-0.5, 0.5})
      {
        halves.insert(halves.end(), box, box + width);
        double* const half = halves.data() + halves.size() - width + 2 * widest;
        half[0] += side * half[1];
        half[1] *= 0.5;
      }
    }
    open = width == 0 ? 0 : halves.size() / width;
    boxes = std::move(halves);
  }
  return Separation::Apart;
}
}  // namespace gpu_planning_scene::core
