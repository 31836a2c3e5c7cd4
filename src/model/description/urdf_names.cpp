#include "model/description/urdf_names.h"

#include <cstring>
#include <map>

#include <tinyxml2.h>

#include "base/text/name_list.h"
#include "gpu_planning_scene/error.h"

// The elements and attributes are those of URDF 1.0 (http://wiki.ros.org/urdf/XML), and those of newer versions and of
// Gazebo that change no collision geometry.
namespace gpu_planning_scene::core
{
namespace
{
using tinyxml2::XMLElement;
using Names = std::vector<std::string>;

/// Whether a name belongs to another program, such as drake:capsule.
bool hasPrefix(const std::string& name)
{
  return name.find(':') != std::string::npos;
}

/// Elements whose loss removes geometry, links or joints, or moves them. <pose> is SDF's word for <origin>.
const Names kPlaces = {"link",    "joint",  "collision", "geometry", "box",   "sphere", "cylinder", "mesh",
                       "capsule", "origin", "pose",      "parent",   "child", "axis",   "limit",    "mimic"};

/// The names that an element may hold.
struct ElementKind
{
  Names once;  ///< children that urdfdom reads once
  Names many;  ///< other children that are read, or that are harmless though their names are similar to known ones
  Names attributes;
  bool only_attributes = false;  ///< it has no content
  bool strict = false;           ///< each attribute says where something is: an unknown one is an error
};

/// The kind of an element of URDF; null for any other element.
const ElementKind* kindOf(const std::string& name)
{
  static const std::map<std::string, ElementKind> kinds = {
      {"robot", {{}, {"link", "joint", "material", "gazebo", "transmission", "sensor"}, {"name", "version", "path"}}},
      {"link", {{}, {"collision", "visual", "inertial", "gazebo", "sensor", "contact"}, {"name", "type"}}},
      {"joint",
       {{"origin", "parent", "child", "axis", "limit", "mimic", "safety_controller"},
        {"dynamics", "calibration", "gazebo"},
        {"name", "type"}}},
      {"collision",
       {{"origin", "geometry"}, {"verbose", "contact_coefficients", "material", "surface"}, {"name", "group"}}},
      {"origin", {{}, {}, {"xyz", "rpy"}, true, true}},
      {"axis", {{}, {}, {"xyz"}, true, true}},
      {"box", {{}, {}, {"size"}, true}},
      {"sphere", {{}, {}, {"radius"}, true}},
      {"cylinder", {{}, {}, {"radius", "length"}, true}},
      {"mesh", {{}, {}, {"filename", "scale"}, true}},
      {"parent", {{}, {}, {"link"}, true}},
      {"child", {{}, {}, {"link"}, true}},
      {"limit", {{}, {}, {"lower", "upper", "effort", "velocity", "acceleration", "deceleration", "jerk"}, true}},
      {"mimic", {{}, {}, {"joint", "multiplier", "offset"}, true}},
      {"safety_controller", {{}, {}, {"soft_lower_limit", "soft_upper_limit", "k_position", "k_velocity"}, true}},
  };
  const auto found = kinds.find(name);
  return found == kinds.end() ? nullptr : &found->second;
}

class UrdfNames
{
 public:
  UrdfNames(const XmlText& xml, std::vector<std::string>& warnings) : xml_(xml), warnings_(warnings) {}

  void check(const XMLElement& element)
  {
    const std::string name = element.Name();
    if (name == "link" || name == "joint")
      owner_ = name + " '" + (element.Attribute("name") != nullptr ? element.Attribute("name") : "") + "': ";
    if (name == "geometry")
      return checkGeometry(element);
    if (name == "visual" || name == "inertial")
      return requireNoneOf(element, {"link", "joint", "collision"});
    const ElementKind* kind = kindOf(name);
    if (kind == nullptr)
      return;
    checkAttributes(element, *kind);
    if (kind->only_attributes)
      return requireNoContent(element, *kind);
    std::map<std::string, int> lines;
    for (const auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
      checkChild(element, *kind, *child, lines);
  }

 private:
  [[noreturn]] void fail(const XMLElement& element, const std::string& what) const
  {
    throw Error(xml_.where(element) + ": " + owner_ + what);
  }

  void checkChild(const XMLElement& parent, const ElementKind& kind, const XMLElement& child,
                  std::map<std::string, int>& lines)
  {
    const std::string name = child.Name();
    const std::string in = " in <" + std::string(parent.Name()) + ">";
    if (contains(kind.once, name))
    {
      const auto [first, is_first] = lines.emplace(name, child.GetLineNum());
      if (!is_first)
        fail(child, "a second <" + name + ">" + in + " (the first is in line " + std::to_string(first->second) +
                        "); only the first would be read. Remove one of them" +
                        (name == "geometry" ? ", or give it a <collision> of its own" : ""));
    }
    else if (!contains(kind.many, name))
    {
      Names known = kind.once;
      known.insert(known.end(), kind.many.begin(), kind.many.end());
      const std::string meant = meantName(name, known);
      if (contains(kPlaces, meant) || meant == "safety_controller")
        fail(child, "unknown element <" + name + ">" + in + "; did you mean <" + meant + ">?");
      if (contains(kPlaces, name))
        fail(child, "<" + name + "> does not belong" + in + ", and would not be read" +
                        (name == "pose" ? "; write <origin xyz=\"...\" rpy=\"...\"/>" : ""));
      requireNothingLost(child, child);
    }
    check(child);
    if (std::strcmp(parent.Name(), "robot") == 0)
      owner_.clear();
  }

  /// Elements of other programs pass, such as <ros2_control> with its <joint>. Not so if they hold parts of a robot.
  void requireNothingLost(const XMLElement& unknown, const XMLElement& inside) const
  {
    if (hasPrefix(inside.Name()))
      return;
    for (const auto* child = inside.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
    {
      const std::string name = child->Name();
      if ((name == "collision" && child->FirstChildElement("geometry") != nullptr) ||
          (name == "joint" && child->FirstChildElement("parent") != nullptr))
        fail(*child, "<" + name + "> in the unknown element <" + unknown.Name() + "> would not be read; remove <" +
                         unknown.Name() + ">, or move its content out of it");
      requireNothingLost(unknown, *child);
    }
  }

  /// <geometry> has one shape. urdfdom refuses an unknown first one itself.
  void checkGeometry(const XMLElement& geometry)
  {
    const XMLElement* shape = geometry.FirstChildElement();
    if (shape == nullptr)
      return;
    const XMLElement* second = shape->NextSiblingElement();
    while (second != nullptr && hasPrefix(second->Name()))
      second = second->NextSiblingElement();
    if (second != nullptr)
      fail(*second, "a second shape, <" + std::string(second->Name()) + ">, in <geometry>; only the first would be " +
                        "read. Give each shape a <collision> of its own");
    check(*shape);
  }

  void requireNoneOf(const XMLElement& element, const Names& names) const
  {
    for (const auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
      if (contains(names, child->Name()) || contains(names, meantName(child->Name(), names)))
        fail(*child,
             "<" + std::string(child->Name()) + "> does not belong in <" + element.Name() + ">, and would not be read");
  }

  void requireNoContent(const XMLElement& element, const ElementKind& kind) const
  {
    for (const auto* child = element.FirstChild(); child != nullptr; child = child->NextSibling())
      if (child->ToText() != nullptr || (child->ToElement() != nullptr && !hasPrefix(child->ToElement()->Name())))
        fail(element, "the content of <" + std::string(element.Name()) +
                          "> would not be read; write it as attributes: " + attributeList(kind));
  }

  static std::string attributeList(const ElementKind& kind)
  {
    std::string text;
    for (const std::string& attribute : kind.attributes)
      text += (text.empty() ? "" : ", ") + attribute;
    return text;
  }

  void checkAttributes(const XMLElement& element, const ElementKind& kind)
  {
    for (const auto* attribute = element.FirstAttribute(); attribute != nullptr; attribute = attribute->Next())
    {
      const std::string name = attribute->Name();
      const std::string of = "attribute '" + name + "' of <" + element.Name() + ">";
      if (contains(kind.attributes, name) || hasPrefix(name))
        continue;
      if (name == "quat_xyzw")
        fail(element, "the " + of +
                          " is not supported: this package reads URDF 1.0, as MoveIt does; write the rotation " +
                          "as rpy=\"ROLL PITCH YAW\" (radians)");
      if (!kind.only_attributes)
        continue;  // a name or a type: urdfdom refuses an element without them
      if (const std::string meant = meantName(name, kind.attributes); !meant.empty())
        fail(element, "unknown " + of + "; did you mean '" + meant + "'?");
      if (kind.strict)
        fail(element, "unknown " + of + "; it has " + attributeList(kind));
      warnings_.push_back(xml_.where(element) + ": " + owner_ + "unknown " + of + " is not used; it has " +
                          attributeList(kind));
    }
  }

  const XmlText& xml_;
  std::vector<std::string>& warnings_;
  std::string owner_;  // the link or joint that is being checked, for messages
};
}  // namespace

void checkUrdfNames(const XmlText& xml, std::vector<std::string>& warnings)
{
  UrdfNames(xml, warnings).check(xml.root());
}
}  // namespace gpu_planning_scene::core
