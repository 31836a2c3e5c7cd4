#pragma once

#include <string>
#include <vector>

#include "model/description/xml.h"

namespace gpu_planning_scene::core
{
/// Finds what urdfdom would drop in silence: the second of two elements where it reads one, misspelt elements and
/// attributes, elements in the wrong place, text in place of attributes. Throws Error, with the line and the link or
/// joint, if the loss would remove collision geometry, a link or a joint, or move one of them. Other unknown attributes
/// of URDF's own elements get a line in `warnings`. Extensions (<gazebo>, <transmission>, vendors' elements, names with
/// a prefix such as drake:) pass in silence.
void checkUrdfNames(const XmlText& xml, std::vector<std::string>& warnings);
}  // namespace gpu_planning_scene::core
