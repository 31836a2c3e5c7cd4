#include <algorithm>
#include <set>
#include <utility>

#include <urdf_model/model.h>

#include "base/text/name_list.h"
#include "base/text/one_line.h"
#include "base/text/utf8.h"
#include "gpu_planning_scene/error.h"
#include "model/description/description_file.h"
#include "model/description/groups.h"
#include "model/description/named_states.h"
#include "model/description/proof_limits.h"
#include "model/description/robot_parts.h"
#include "model/description/srdf_reader.h"
#include "model/description/tree_builder.h"
#include "model/description/urdf_reader.h"
#include "model/kinematics.h"
#include "model/robot_text.h"

namespace gpu_planning_scene::core
{
/// Builds a RobotModel from a URDF and an SRDF, or from parts.
class RobotModelBuilder
{
 public:
  explicit RobotModelBuilder(const RobotModelOptions& options) : options_(options), model_(new RobotModel) {}

  std::shared_ptr<const RobotModel> build(const std::string& urdf_text, const std::string& srdf_text)
  {
    const UrdfText urdf(urdf_text, options_.urdf_name);
    warnings_ = urdf.warnings;
    const bool has_srdf = !srdf_text.empty();
    const Srdf srdf = has_srdf ? readSrdf(srdf_text, options_.srdf_name, warnings_) : Srdf();

    const std::string root = urdf.model->getRoot()->name;
    const SrdfVirtualJoint* virtual_joint = findVirtualJoint(srdf, root);
    RobotTree tree = buildTree(urdf, virtual_joint, options_, warnings_);
    model_->name_ = urdf.model->getName();
    model_->planning_frame_ = virtual_joint == nullptr ? root : virtual_joint->parent_frame;
    const std::vector<int> widened = tree.widened;
    take(std::move(tree));

    model_->srdf_collisions_.has_srdf = has_srdf;
    if (has_srdf)
    {
      addSrdf(srdf);
      checkUnprovenPairs(widened, srdf_text);
    }
    return model_;
  }

  std::shared_ptr<const RobotModel> build(RobotParts parts)
  {
    limitVariables(parts.tree);
    model_->name_ = std::move(parts.name);
    model_->planning_frame_ = std::move(parts.planning_frame);
    take(std::move(parts.tree));
    model_->groups_ = std::move(parts.groups);
    return model_;
  }

  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  const SrdfVirtualJoint* findVirtualJoint(const Srdf& srdf, const std::string& root)
  {
    const SrdfVirtualJoint* found = nullptr;
    for (const SrdfVirtualJoint& joint : srdf.virtual_joints)
    {
      const bool fits = joint.child_link == root && !joint.parent_frame.empty();
      if (fits && found == nullptr)
      {
        found = &joint;
        continue;
      }
      ignored_joints_.insert(joint.name);
      warnings_.push_back(joint.where + ": virtual joint '" + joint.name + "' is ignored: " +
                          (fits ? "a virtual joint was defined before it"
                           : joint.parent_frame.empty()
                               ? "its parent frame is empty"
                               : "its child link '" + joint.child_link + "' is not the root link '" + root + "'"));
    }
    return found;
  }

  void take(RobotTree tree)
  {
    model_->links_ = std::move(tree.links);
    model_->joints_ = std::move(tree.joints);
    model_->variables_ = std::move(tree.variables);
    model_->kinematics_ = std::make_shared<Kinematics>(model_->links_, model_->joints_);
    const auto number = [](const auto& items, std::unordered_map<std::string, int>& indices)
    {
      for (std::size_t i = 0; i < items.size(); ++i)
        indices[items[i].name] = static_cast<int>(i);
    };
    number(model_->links_, model_->link_indices_);
    number(model_->joints_, model_->joint_indices_);
    number(model_->variables_, model_->variable_indices_);
  }

  void addSrdf(const Srdf& srdf)
  {
    if (srdf.robot_name != model_->name_)
    {
      const std::string other = srdf.where + ": the SRDF is for robot '" + srdf.robot_name +
                                "', but the URDF is of robot '" + model_->name_ + "'";
      if (!srdf.disabled.empty() &&
          std::none_of(srdf.disabled.begin(), srdf.disabled.end(),
                       [this](const SrdfPair& pair) { return hasLink(pair.link_1) || hasLink(pair.link_2); }))
        throw Error(other +
                    ", which has none of the links in the disable_collisions entries; give the SRDF of this robot");
      warnings_.push_back(other);
    }
    for (const SrdfName& passive : srdf.passive_joints)
    {
      const int joint = model_->jointIndex(passive.name);
      if (joint >= 0)
        model_->joints_[joint].passive = true;
      else
        warnings_.push_back(passive.where + ": passive joint '" + passive.name + "' is not in the robot");
    }
    for (const SrdfJointProperty& property : srdf.joint_properties)
      if (property.property == "motion_model")
        setMotionModel(property);
      else if (property.property != "angular_distance_weight" && property.property != "min_translational_distance")
        warnings_.push_back(property.where + ": joint '" + property.joint + "' has the unknown property '" +
                            property.property + "', which is not used (the one for its motion is motion_model)");
    SrdfCollisions& collisions = model_->srdf_collisions_;
    collisions.disabled = resolvePairs(srdf.disabled, "disable_collisions");
    collisions.enabled = resolvePairs(srdf.enabled, "enable_collisions");
    for (const SrdfName& link : srdf.disabled_by_default)
      if (hasLink(link.name))
        collisions.disabled_by_default.push_back(model_->linkIndex(link.name));
      else
        warnings_.push_back(link.where + ": link '" + link.name + "' is not in the robot, the entry is ignored");
    model_->groups_ = resolveGroups(srdf.groups, *model_, ignored_joints_, warnings_);
    model_->named_states_ = resolveNamedStates(srdf.named_states, *model_, ignored_joints_, warnings_);
  }

  void setMotionModel(const SrdfJointProperty& property)
  {
    if (property.value != "holonomic" && property.value != "diff_drive")
      throw Error(property.where + ": the motion_model of joint '" + property.joint + "' is '" + property.value +
                  "'; it must be holonomic or diff_drive");
    const int joint = model_->jointIndex(property.joint);
    const bool is_planar = joint >= 0 && model_->joints_[joint].type == JointType::Planar;
    if (is_planar)
      model_->joints_[joint].diff_drive = property.value == "diff_drive";
    else if (ignored_joints_.count(property.joint) == 0)
      warnings_.push_back(property.where + ": the motion_model of joint '" + property.joint + "' has no effect: " +
                          (joint < 0 ? "the joint is not in the robot" : "the joint is not planar"));
  }

  /// A pair with the reason Never was found free within some limits. If the limits are wider, these pairs are checked.
  void checkUnprovenPairs(const std::vector<int>& widened, const std::string& srdf)
  {
    const std::vector<std::string> beyond = limitsBeyondProofs(model_->joints_, model_->variables_, widened, srdf);
    if (beyond.empty())
      return;
    SrdfCollisions& collisions = model_->srdf_collisions_;
    std::vector<LinkPair>& disabled = collisions.disabled;
    const auto first = std::stable_partition(disabled.begin(), disabled.end(),
                                             [](const LinkPair& pair) { return pair.reason != "Never"; });
    if (first == disabled.end())
      return;
    collisions.unproven.assign(first, disabled.end());
    disabled.erase(first, disabled.end());
    warnings_.push_back(options_.srdf_name + ": " + std::to_string(collisions.unproven.size()) +
                        " pairs of links that are disabled with the reason Never are checked, because limits are " +
                        "wider than those for which the pairs were found free (those that the SRDF's comment names, " +
                        "or else those of the URDF): " + nameList(beyond) +
                        ". To save their checks, run generate_acm --srdf OLD --out NEW with these limits (--planning)");
  }

  bool hasLink(const std::string& link) const { return model_->linkIndex(link) >= 0; }

  /// The pairs of links that the robot has. One warning names the links that it lacks.
  std::vector<LinkPair> resolvePairs(const std::vector<SrdfPair>& pairs, const std::string& element)
  {
    std::vector<LinkPair> result;
    std::vector<std::string> ignored;  // where
    std::vector<std::string> missing;
    for (const SrdfPair& pair : pairs)
    {
      for (const std::string& link : {pair.link_1, pair.link_2})
        if (!hasLink(link) && !contains(missing, link))
          missing.push_back(link);
      const int link_1 = model_->linkIndex(pair.link_1);
      const int link_2 = model_->linkIndex(pair.link_2);
      if (link_1 < 0 || link_2 < 0)
        ignored.push_back(pair.where);
      else if (link_1 == link_2)
        warnings_.push_back(pair.where + ": link '" + pair.link_1 + "' is paired with itself, the entry is ignored");
      else
        result.push_back({std::min(link_1, link_2), std::max(link_1, link_2), pair.reason});
    }
    if (ignored.size() == 1)
      warnings_.push_back(ignored.front() + ": the robot does not have " + nameList(missing) +
                          "; the entry is ignored");
    else if (!ignored.empty())
      warnings_.push_back(ignored.front() + ": this and " + std::to_string(ignored.size() - 1) + " more " + element +
                          " are ignored, because the robot does not have " + nameList(missing));
    return result;
  }

  const RobotModelOptions& options_;
  std::shared_ptr<RobotModel> model_;
  std::vector<std::string> warnings_;
  std::set<std::string> ignored_joints_;
};

std::shared_ptr<const RobotModel> makeRobot(RobotParts parts)
{
  return RobotModelBuilder({}).build(std::move(parts));
}

std::shared_ptr<const RobotModel> RobotModel::fromXml(const std::string& urdf, const std::string& srdf,
                                                      const RobotModelOptions& options,
                                                      std::vector<std::string>* warnings)
{
  RobotModelBuilder builder(options);
  std::shared_ptr<const RobotModel> model;
  try
  {
    model = builder.build(xmlInUtf8(urdf), xmlInUtf8(srdf));
  }
  catch (const Error& error)
  {
    throw Error(onOneLine(error.what()));
  }
  if (warnings != nullptr)
    warnings->insert(warnings->end(), builder.warnings().begin(), builder.warnings().end());
  return model;
}

std::shared_ptr<const RobotModel> RobotModel::fromFiles(const std::string& urdf_path, const std::string& srdf_path,
                                                        RobotModelOptions options, std::vector<std::string>* warnings)
{
  const RobotDescription files = readRobotDescription(urdf_path, srdf_path, options.package_folders, options.info);
  options.urdf_folder = files.urdf_folder;
  options.urdf_name = files.urdf.name;
  options.srdf_name = files.srdf.name;
  return fromXml(files.urdf.text, files.srdf.text, options, warnings);
}
}  // namespace gpu_planning_scene::core
