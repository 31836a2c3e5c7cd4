#pragma once

#include <string>
#include <utility>
#include <vector>

namespace gpu_planning_scene::core
{
/// A name and its place in the file ("FILE:LINE").
struct SrdfName
{
  std::string name;
  std::string where;
};

struct SrdfChain
{
  std::string base_link;
  std::string tip_link;
  std::string where;
};

struct SrdfGroup
{
  std::string name;
  std::string where;
  std::vector<SrdfName> joints;
  std::vector<SrdfName> links;
  std::vector<SrdfName> subgroups;
  std::vector<SrdfChain> chains;
};

struct SrdfVirtualJoint
{
  std::string name;
  std::string type;  ///< fixed, planar or floating
  std::string parent_frame;
  std::string child_link;
  std::string where;
};

struct SrdfNamedState
{
  std::string name;
  std::string group;
  std::string where;
  std::vector<std::pair<SrdfName, std::string>> values;  ///< joints and the text of their values
};

struct SrdfJointProperty
{
  std::string joint;
  std::string property;
  std::string value;
  std::string where;
};

struct SrdfPair
{
  std::string link_1;
  std::string link_2;
  std::string reason;
  std::string where;
};

/// The content of an SRDF. Its names have not been looked up in the robot yet.
struct Srdf
{
  std::string robot_name;
  std::string where;
  std::vector<SrdfVirtualJoint> virtual_joints;
  std::vector<SrdfGroup> groups;
  std::vector<SrdfNamedState> named_states;
  std::vector<SrdfName> passive_joints;
  std::vector<SrdfJointProperty> joint_properties;
  std::vector<SrdfPair> disabled;
  std::vector<SrdfPair> enabled;
  std::vector<SrdfName> disabled_by_default;
};

/// Reads an SRDF. As in MoveIt, an element that lacks an attribute is left out, and gets a line in `warnings`. Throws
/// Error with `name` and line for malformed XML, and for faults after which the robot would stand elsewhere or fewer
/// pairs would be checked than the file says: an incomplete <virtual_joint> or <enable_collisions>, a virtual joint of
/// an unknown type, and misspelt elements that mean these or the content of a group.
Srdf readSrdf(const std::string& text, const std::string& name, std::vector<std::string>& warnings);
}  // namespace gpu_planning_scene::core
