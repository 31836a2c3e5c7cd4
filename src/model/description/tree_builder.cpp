#include "model/description/tree_builder.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <urdf_model/model.h>

#include "base/math_constants.h"
#include "gpu_planning_scene/error.h"
#include "model/description/collision_shapes.h"
#include "model/description/position_limits.h"
#include "model/description/velocity_limits.h"

namespace gpu_planning_scene::core
{
namespace
{
class TreeBuilder
{
 public:
  TreeBuilder(const UrdfText& urdf, const RobotModelOptions& options, std::vector<std::string>& warnings)
    : urdf_(urdf), options_(options), warnings_(warnings), meshes_(options.meshes.read)
  {
  }

  RobotTree build(const SrdfVirtualJoint* virtual_joint)
  {
    const urdf::Link& root = *urdf_.model->getRoot();
    if (virtual_joint != nullptr)
      addVirtualJoint(*virtual_joint);
    addSubtree(root);
    resolveMimics();
    applyJointLimits(options_.joint_limits, tree_, warnings_);
    limitVariables(tree_);
    return std::move(tree_);
  }

 private:
  std::string whereJoint(const std::string& name) const
  {
    return urdf_.xml.where("joint", name) + ": joint '" + name + "'";
  }

  void addVirtualJoint(const SrdfVirtualJoint& virtual_joint)
  {
    if (urdf_.model->getJoint(virtual_joint.name))
    {
      throw Error(virtual_joint.where + ": virtual joint '" + virtual_joint.name +
                  "' has the name of a joint of the URDF");
    }
    Joint joint;
    joint.name = virtual_joint.name;
    joint.type = virtual_joint.type == "planar"     ? JointType::Planar
                 : virtual_joint.type == "floating" ? JointType::Floating
                                                    : JointType::Fixed;
    joint.child_link = 0;
    joint.axis = Eigen::Vector3d::UnitZ();
    addVariables(joint);
    tree_.joints.push_back(joint);
  }

  void addLink(const urdf::Link& link)
  {
    const std::string where = urdf_.xml.where("link", link.name);
    Link result;
    result.name = link.name;
    result.parent_joint = static_cast<int>(tree_.joints.size()) - 1;
    result.shapes = collisionShapes(link, where, options_, meshes_, warnings_);
    if (result.shapes.empty() && urdf_.xml.hasChild("link", link.name, "visual"))
    {
      warnings_.push_back(where + ": link '" + link.name +
                          "' has visual but no collision geometry: it collides with nothing; if it should, " +
                          "give it a <collision>");
    }
    tree_.links.push_back(std::move(result));
  }

  void addSubtree(const urdf::Link& link)
  {
    const int index = static_cast<int>(tree_.links.size());
    addLink(link);
    for (const urdf::LinkSharedPtr& child : link.child_links)
    {
      addJoint(*child->parent_joint, index);
      addSubtree(*child);
    }
  }

  void addJoint(const urdf::Joint& joint, int parent_link)
  {
    Joint result;
    result.name = joint.name;
    result.type = jointType(joint);
    result.parent_link = parent_link;
    result.child_link = static_cast<int>(tree_.links.size());
    result.origin = toIsometry(joint.parent_to_joint_origin_transform, whereJoint(joint.name));
    if (result.type != JointType::Fixed && result.type != JointType::Floating)
    {
      const Eigen::Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
      if (axis.stableNorm() == 0.0)
        throw Error(whereJoint(joint.name) + " has an axis of zero length");
      result.axis = axis.stableNormalized();
    }
    if (result.type == JointType::Planar && !urdf_.xml.hasChild("joint", joint.name, "axis"))
    {
      warnings_.push_back(whereJoint(joint.name) +
                          " is planar and has no <axis>: its normal is x, the default of the URDF format");
    }
    if (joint.mimic && result.type == JointType::Fixed)
      warnings_.push_back(whereJoint(joint.name) + " is fixed, its <mimic> is ignored");
    else if (joint.mimic)
      result.mimic = true;
    if (!result.mimic)
      addVariables(result, &joint);
    tree_.joints.push_back(result);
  }

  JointType jointType(const urdf::Joint& joint) const
  {
    switch (joint.type)
    {
      case urdf::Joint::REVOLUTE:
        return JointType::Revolute;
      case urdf::Joint::CONTINUOUS:
        return JointType::Continuous;
      case urdf::Joint::PRISMATIC:
        return JointType::Prismatic;
      case urdf::Joint::PLANAR:
        return JointType::Planar;
      case urdf::Joint::FLOATING:
        return JointType::Floating;
      case urdf::Joint::FIXED:
        return JointType::Fixed;
      default:
        throw Error(whereJoint(joint.name) + " has an unknown type");
    }
  }

  /// `description`: the joint of the URDF; null for a virtual joint.
  void addVariables(Joint& joint, const urdf::Joint* description = nullptr)
  {
    const double reach = options_.unbounded_translation;
    const auto add = [&](const std::string& suffix, double range) {
      tree_.variables.push_back({joint.name + suffix, false, -range, range});
    };

    if (joint.type == JointType::Fixed)
      return;
    joint.first_variable = static_cast<int>(tree_.variables.size());
    if (joint.type == JointType::Continuous)
    {
      add("", kPi);
      tree_.variables.back().max_velocity = velocityLimit(*description);
    }
    else if (joint.type == JointType::Planar)
    {
      add("/x", reach);
      add("/y", reach);
      add("/theta", kPi);
    }
    else if (joint.type == JointType::Floating)
    {
      for (const char* suffix : {"/trans_x", "/trans_y", "/trans_z"})
        add(suffix, reach);
      for (const char* suffix : {"/rot_x", "/rot_y", "/rot_z", "/rot_w"})
        add(suffix, 1.0);
    }
    else
    {
      tree_.variables.push_back(limitedVariable(*description, whereJoint(joint.name), warnings_));
    }
  }

  // Resolves chains of mimic joints: position = m2 (m1 x + o1) + o2, where x is the variable of the last leader.
  void resolveMimics()
  {
    std::map<std::string, const Joint*> joints;
    for (const Joint& joint : tree_.joints)
      joints[joint.name] = &joint;
    for (Joint& joint : tree_.joints)
    {
      if (!joint.mimic)
        continue;
      requireOneVariable(joint, joint);
      const Joint* leader = &joint;
      for (std::size_t steps = 0; leader->mimic; ++steps)
      {
        const urdf::JointMimic& mimic = *urdf_.model->getJoint(leader->name)->mimic;
        joint.offset += joint.multiplier * mimic.offset;
        joint.multiplier *= mimic.multiplier;
        const auto found = joints.find(mimic.joint_name);
        if (found == joints.end())
          throw Error(whereJoint(leader->name) + " mimics joint '" + mimic.joint_name + "', which does not exist");
        if (steps == tree_.joints.size())
          throw Error(whereJoint(joint.name) + " mimics itself, directly or through other joints");
        leader = found->second;
      }
      requireOneVariable(joint, *leader);
      if (!std::isfinite(joint.multiplier) || !std::isfinite(joint.offset))
        throw Error(whereJoint(joint.name) + " has a <mimic> whose multiplier or offset is not finite");
      joint.first_variable = leader->first_variable;
    }
  }

  void requireOneVariable(const Joint& follower, const Joint& joint) const
  {
    if (joint.type != JointType::Revolute && joint.type != JointType::Continuous && joint.type != JointType::Prismatic)
    {
      throw Error(whereJoint(follower.name) + " has a <mimic>, but joint '" + joint.name +
                  "' is not revolute, continuous or prismatic");
    }
  }

  const UrdfText& urdf_;
  const RobotModelOptions& options_;
  std::vector<std::string>& warnings_;
  MeshCache meshes_;
  RobotTree tree_;
};
}  // namespace

void limitVariables(RobotTree& tree)
{
  constexpr double kLargestAngle = 1e300;  // the sine of an infinite angle is not a number
  for (const Joint& joint : tree.joints)
  {
    const int count = joint.type == JointType::Prismatic  ? 1
                      : joint.type == JointType::Planar   ? 2
                      : joint.type == JointType::Floating ? 3
                                                          : 0;
    if (joint.type == JointType::Revolute || joint.type == JointType::Continuous)
    {
      double& largest = tree.variables[static_cast<std::size_t>(joint.first_variable)].largest;
      largest = std::min(largest, (kLargestAngle - std::abs(joint.offset)) / std::max(std::abs(joint.multiplier), 1.0));
      continue;
    }
    const double limit =
        std::max(0.0, kLargestLength - std::abs(joint.offset)) / std::max(std::abs(joint.multiplier), 1e-300);
    for (int i = 0; i < count; ++i)
    {
      const int variable = joint.first_variable + i;
      double& largest = tree.variables[static_cast<std::size_t>(variable)].largest;
      largest = std::min(largest, limit);
    }
  }
}

RobotTree buildTree(const UrdfText& urdf, const SrdfVirtualJoint* virtual_joint, const RobotModelOptions& options,
                    std::vector<std::string>& warnings)
{
  return TreeBuilder(urdf, options, warnings).build(virtual_joint);
}
}  // namespace gpu_planning_scene::core
