#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/description/xml.h"

namespace urdf
{
class ModelInterface;
}

namespace gpu_planning_scene::core
{
/// A URDF as urdfdom reads it, without visuals and inertias. `xml` finds the lines of elements for messages.
struct UrdfText
{
  /// `text`: the URDF. `name`: its file or parameter, for messages. Throws Error with name and line.
  UrdfText(const std::string& text, const std::string& name);

  XmlText xml;
  std::shared_ptr<const urdf::ModelInterface> model;
  std::vector<std::string> warnings;  ///< elements of xacro, and urdfdom's messages about a text that it accepted
};
}  // namespace gpu_planning_scene::core
