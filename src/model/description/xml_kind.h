#pragma once

#include <string>
#include <vector>

#include "model/description/xml.h"

namespace gpu_planning_scene::core
{
// A URDF, an SRDF and a xacro file all have the root element <robot>. Only their content tells which kind a file is. A
// file of the wrong kind would be read as a robot without links, or without groups and allowed pairs.

/// Whether the robot would be incomplete or wrong without the program xacro.
bool needsXacro(const XmlText& xml);

/// Throws Error, with the place and the command to run, if the text is a xacro file or an SRDF. Some published URDFs
/// contain calls of macros that xacro did not know, for example the URDF of the PR2 (macros for Gazebo). Each such
/// element gets a line in `warnings`.
void requireUrdf(const XmlText& xml, std::vector<std::string>& warnings);

/// Throws Error, with the place and the command to run, if the text is a xacro file or a URDF.
void requireSrdf(const XmlText& xml);
}  // namespace gpu_planning_scene::core
