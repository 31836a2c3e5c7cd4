#pragma once

#include <string>
#include <vector>

namespace gpu_planning_scene::core
{
/// A name and where it stands ("FILE:LINE").
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

struct SrdfPair
{
  std::string link_1;
  std::string link_2;
  std::string reason;
  std::string where;
};

/// What a SRDF says, by name: nothing is looked up in the robot yet.
struct Srdf
{
  std::string robot_name;
  std::string where;
  std::vector<SrdfVirtualJoint> virtual_joints;
  std::vector<SrdfGroup> groups;
  std::vector<SrdfName> passive_joints;
  std::vector<SrdfPair> disabled;
  std::vector<SrdfPair> enabled;
  std::vector<SrdfName> disabled_by_default;
};

/// Throws Error with `name` and line: malformed XML, a missing attribute, an unknown type of virtual joint.
Srdf readSrdf(const std::string& text, const std::string& name);
}  // namespace gpu_planning_scene::core
