#pragma once

#include <string>
#include <vector>

#include "model/xml.h"

namespace gpu_planning_scene::core
{
// A URDF, an SRDF and a xacro file all have the root element <robot>. They are told apart by their content. A wrong one
// would be read as a robot without links, or without groups and allowed pairs.

/// Throws Error, with the place and the command to run, if the text is a xacro file or an SRDF. Some published URDFs
/// contain calls of macros that xacro did not know, for example that of the PR2 for Gazebo. Each such element gets a
/// line in `warnings`.
void requireUrdf(const XmlText& xml, std::vector<std::string>& warnings);

/// Throws Error, with the place and the command to run, if the text is a xacro file or a URDF.
void requireSrdf(const XmlText& xml);
}  // namespace gpu_planning_scene::core
