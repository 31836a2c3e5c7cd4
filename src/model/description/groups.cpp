#include "model/description/groups.h"

#include <algorithm>
#include <map>

namespace gpu_planning_scene::core
{
namespace
{
class GroupResolver
{
 public:
  GroupResolver(const std::vector<SrdfGroup>& groups, const RobotModel& robot,
                const std::set<std::string>& ignored_joints, std::vector<std::string>& warnings)
    : robot_(robot), ignored_joints_(ignored_joints), warnings_(warnings)
  {
    for (const SrdfGroup& group : groups)
      if (by_name_.emplace(group.name, &group).second)
        order_.push_back(&group);
      else
        warnings_.push_back(group.where + ": group '" + group.name +
                            "' is defined twice; the first definition is used");
  }

  std::vector<Group> resolve()
  {
    leaveOutIncompleteGroups();
    std::vector<Group> result;
    for (const SrdfGroup* group : order_)
    {
      result.push_back(finish(group->name, jointsOf(*group)));
      if (result.back().variables.empty())
        warnings_.push_back(group->where + ": group '" + group->name +
                            "' has no joint that can move, so it cannot be planned for");
    }
    return result;
  }

 private:
  /// Removes the groups with subgroups that do not exist, with subgroups that are removed themselves, and in circles.
  void leaveOutIncompleteGroups()
  {
    std::set<std::string> complete;
    const auto missing = [&](const SrdfGroup& group)
    {
      return std::find_if(group.subgroups.begin(), group.subgroups.end(),
                          [&](const SrdfName& subgroup) { return complete.count(subgroup.name) == 0; });
    };
    for (bool grows = true; grows;)
    {
      grows = false;
      for (const SrdfGroup* group : order_)
        if (missing(*group) == group->subgroups.end())
          grows |= complete.insert(group->name).second;
    }
    for (const SrdfGroup* group : order_)
      if (const auto subgroup = missing(*group); subgroup != group->subgroups.end())
        warnings_.push_back(
            subgroup->where + ": group '" + group->name + "' is left out: its subgroup '" + subgroup->name +
            (by_name_.count(subgroup->name) == 0 ? "' does not exist" : "' is left out too, or contains this group"));
    order_.erase(std::remove_if(order_.begin(), order_.end(),
                                [&](const SrdfGroup* group) { return complete.count(group->name) == 0; }),
                 order_.end());
  }

  /// -1, with a warning, if the robot does not have the link.
  int linkIndex(const std::string& link, const std::string& where, const std::string& group) const
  {
    const int index = robot_.linkIndex(link);
    if (index < 0)
      warnings_.push_back(where + ": group '" + group + "' names link '" + link +
                          "', which the robot does not have; the entry is left out");
    return index;
  }

  const std::set<int>& jointsOf(const SrdfGroup& group)
  {
    const auto [position, is_new] = joints_.emplace(group.name, std::set<int>());
    std::set<int>& joints = position->second;
    if (!is_new)
      return joints;
    for (const SrdfName& joint : group.joints)
      addJoint(joint, group.name, joints);
    for (const SrdfName& link : group.links)
      addParentJoint(linkIndex(link.name, link.where, group.name), joints);
    for (const SrdfChain& chain : group.chains)
      addChain(chain, group.name, joints);
    for (const SrdfName& subgroup : group.subgroups)
    {
      const std::set<int>& added = jointsOf(*by_name_.at(subgroup.name));
      joints.insert(added.begin(), added.end());
    }
    return joints;
  }

  void addJoint(const SrdfName& joint, const std::string& group, std::set<int>& joints)
  {
    const int index = robot_.jointIndex(joint.name);
    if (index >= 0)
    {
      joints.insert(index);
    }
    else if (ignored_joints_.count(joint.name) != 0)
    {
      warnings_.push_back(joint.where + ": group '" + group + "' names virtual joint '" + joint.name +
                          "', which is ignored");
    }
    else
    {
      warnings_.push_back(joint.where + ": group '" + group + "' names joint '" + joint.name +
                          "', which the robot does not have; the entry is left out");
    }
  }

  void addParentJoint(int link, std::set<int>& joints) const
  {
    if (link >= 0 && robot_.links()[link].parent_joint >= 0)
      joints.insert(robot_.links()[link].parent_joint);
  }

  // The link and its ancestors, up to the root.
  std::vector<int> pathToRoot(int link) const
  {
    std::vector<int> path;
    while (link >= 0)
    {
      path.push_back(link);
      const int joint = robot_.links()[link].parent_joint;
      link = joint < 0 ? -1 : robot_.joints()[joint].parent_link;
    }
    return path;
  }

  // Adds the parent joints of the links from the tip up to the base, but not the base's parent joint. If the base is
  // not an ancestor of the tip, it adds both branches up to the link where they meet. As in MoveIt, this link's parent
  // joint is then added too.
  void addChain(const SrdfChain& chain, const std::string& group, std::set<int>& joints) const
  {
    const int base = linkIndex(chain.base_link, chain.where, group);
    const int tip = linkIndex(chain.tip_link, chain.where, group);
    if (base < 0 || tip < 0)
      return;
    const std::vector<int> from_base = pathToRoot(base);
    const std::vector<int> from_tip = pathToRoot(tip);
    if (std::find(from_tip.begin(), from_tip.end(), base) != from_tip.end())
    {
      for (auto link = from_tip.begin(); *link != base; ++link)
        addParentJoint(*link, joints);
      return;
    }
    auto tip_link = from_tip.begin();
    while (std::find(from_base.begin(), from_base.end(), *tip_link) == from_base.end())
      addParentJoint(*tip_link++, joints);
    for (auto link = from_base.begin(); *link != *tip_link; ++link)
      addParentJoint(*link, joints);
    addParentJoint(*tip_link, joints);
  }

  Group finish(const std::string& name, const std::set<int>& joints) const
  {
    Group group;
    group.name = name;
    group.joints.assign(joints.begin(), joints.end());
    std::set<int> active;  // first variables of the group's active joints
    for (const int index : joints)
    {
      const Joint& joint = robot_.joints()[index];
      if (joint.type == JointType::Fixed || joint.mimic)
        continue;
      active.insert(joint.first_variable);
      for (int i = 0; i < variableCount(joint.type); ++i)
        group.variables.push_back(joint.first_variable + i);
    }
    // A mimic joint has its leader's variable, so it moves with its leader. Parents come before children.
    std::vector<bool> moved(robot_.links().size(), false);
    for (std::size_t link = 0; link < moved.size(); ++link)
    {
      const int parent_joint = robot_.links()[link].parent_joint;
      if (parent_joint < 0)
        continue;
      const Joint& joint = robot_.joints()[parent_joint];
      moved[link] = active.count(joint.first_variable) != 0 || (joint.parent_link >= 0 && moved[joint.parent_link]);
      if (moved[link])
        group.moved_links.push_back(static_cast<int>(link));
    }
    return group;
  }

  const RobotModel& robot_;
  const std::set<std::string>& ignored_joints_;
  std::vector<std::string>& warnings_;
  std::map<std::string, const SrdfGroup*> by_name_;
  std::vector<const SrdfGroup*> order_;
  std::map<std::string, std::set<int>> joints_;
};
}  // namespace

std::vector<Group> resolveGroups(const std::vector<SrdfGroup>& groups, const RobotModel& robot,
                                 const std::set<std::string>& ignored_joints, std::vector<std::string>& warnings)
{
  return GroupResolver(groups, robot, ignored_joints, warnings).resolve();
}
}  // namespace gpu_planning_scene::core
