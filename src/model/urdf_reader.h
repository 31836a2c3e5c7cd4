#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/xml.h"

namespace urdf
{
class ModelInterface;
}

namespace gpu_planning_scene::core
{
/// A URDF as urdfdom reads it, without its visuals and inertias, and with the text's lines for messages.
struct UrdfText
{
  UrdfText(const std::string& text, const std::string& name);

  XmlText xml;
  std::shared_ptr<const urdf::ModelInterface> model;
  std::vector<std::string> warnings;  ///< what urdfdom said although it took the text
};
}  // namespace gpu_planning_scene::core
