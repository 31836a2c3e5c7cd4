#include "model/description/urdf_reader.h"

#include <algorithm>
#include <map>
#include <mutex>

#include <console_bridge/console.h>
#include <tinyxml2.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include "gpu_planning_scene/error.h"
#include "model/description/urdf_names.h"
#include "model/description/xml_kind.h"

namespace gpu_planning_scene::core
{
namespace
{
// Collects urdfdom's messages. urdfdom reports errors only to the one log handler of console_bridge, so this object
// replaces that handler while it exists.
class LogCapture : public console_bridge::OutputHandler
{
 public:
  LogCapture() : lock_(mutex()), previous_(console_bridge::getOutputHandler()), level_(console_bridge::getLogLevel())
  {
    console_bridge::useOutputHandler(this);
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_WARN);
  }

  ~LogCapture() override
  {
    console_bridge::setLogLevel(level_);
    console_bridge::useOutputHandler(previous_);
  }

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override
  {
    (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR ? errors : warnings).push_back(text);
  }

  std::vector<std::string> errors;
  std::vector<std::string> warnings;

 private:
  static std::mutex& mutex()
  {
    static std::mutex instance;
    return instance;
  }

  std::lock_guard<std::mutex> lock_;
  console_bridge::OutputHandler* previous_;
  console_bridge::LogLevel level_;
};

// The place of the first joint or link that a message names: urdfdom writes names as [name].
std::string whereOf(const std::vector<std::string>& messages, const XmlText& xml)
{
  for (const std::string& message : messages)
  {
    for (std::size_t begin = message.find('['); begin != std::string::npos; begin = message.find('[', begin + 1))
    {
      const std::string name = message.substr(begin + 1, message.find(']', begin) - begin - 1);
      for (const char* tag : {"joint", "link"})
      {
        std::string where = xml.where(tag, name);
        if (where != xml.name())
          return where;
      }
    }
  }
  return xml.name();
}

std::string joined(const std::vector<std::string>& messages)
{
  std::string text;
  for (const std::string& message : messages)
    text += (text.empty() ? "" : "; ") + message;
  return text.empty() ? "urdfdom refused the text and gave no reason" : text;
}

void removeChildren(tinyxml2::XMLElement& parent, const char* tag)
{
  while (tinyxml2::XMLElement* child = parent.FirstChildElement(tag))
    parent.DeleteChild(child);
}

// Removes the parts that are not used. If urdfdom rejects a link's inertia or visuals, it also drops the link's
// collision elements.
std::string withoutLooksAndInertia(const std::string& text)
{
  tinyxml2::XMLDocument document;
  document.Parse(text.data(), text.size());
  tinyxml2::XMLElement& root = *document.RootElement();
  removeChildren(root, "material");
  for (auto* link = root.FirstChildElement("link"); link != nullptr; link = link->NextSiblingElement("link"))
  {
    removeChildren(*link, "inertial");
    removeChildren(*link, "visual");
  }
  tinyxml2::XMLPrinter printer(nullptr, true);
  document.Print(&printer);
  return printer.CStr();
}

int childCount(const tinyxml2::XMLElement& parent, const char* tag)
{
  int count = 0;
  for (const auto* child = parent.FirstChildElement(tag); child != nullptr; child = child->NextSiblingElement(tag))
    ++count;
  return count;
}

// Each link is the child of at most one joint, and no link is its own ancestor. urdfdom does not check this.
void requireTree(const XmlText& xml)
{
  std::map<std::string, std::pair<std::string, const tinyxml2::XMLElement*>> parents;  // with the joint to the parent
  for (const auto* joint = xml.root().FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint"))
  {
    const auto* parent = joint->FirstChildElement("parent");
    const auto* child = joint->FirstChildElement("child");
    if (parent == nullptr || child == nullptr)
      throw Error(xml.where(*joint) + ": joint '" + xml.attribute(*joint, "name") + "' lacks a parent or a child link");
    const std::string link = xml.attribute(*child, "link");
    if (!parents.emplace(link, std::pair(xml.attribute(*parent, "link"), joint)).second)
    {
      throw Error(xml.where(*joint) + ": link '" + link +
                  "' is the child of several joints, the links must form a tree");
    }
  }
  for (const auto& [link, parent] : parents)
  {
    std::size_t steps = 0;
    for (auto above = parents.find(parent.first); above != parents.end(); above = parents.find(above->second.first))
    {
      if (++steps > parents.size())
      {
        throw Error(xml.where(*parent.second) + ": the joints above link '" + link +
                    "' form a loop, the links must form a tree");
      }
    }
  }
}

// urdfdom skips collision elements that it cannot read. The robot would then pass through obstacles.
void requireAllCollisionElements(const XmlText& xml, const urdf::ModelInterface& model,
                                 const std::vector<std::string>& errors)
{
  const tinyxml2::XMLElement& root = xml.root();
  for (const auto* link = root.FirstChildElement("link"); link != nullptr; link = link->NextSiblingElement("link"))
  {
    const std::string name = xml.attribute(*link, "name");
    const urdf::LinkConstSharedPtr read = model.getLink(name);
    if (read && static_cast<int>(read->collision_array.size()) != childCount(*link, "collision"))
    {
      throw Error(xml.where(*link) + ": link '" + name +
                  "' has a collision element that cannot be read: " + joined(errors));
    }
  }
}
}  // namespace

UrdfText::UrdfText(const std::string& text, const std::string& name) : xml(text, name, "robot")
{
  requireUrdf(xml, warnings);
  checkUrdfNames(xml, warnings);
  requireTree(xml);
  LogCapture log;
  try
  {
    model = urdf::parseURDF(withoutLooksAndInertia(text));
  }
  catch (const std::exception& exception)
  {
    log.errors.push_back(exception.what());
  }
  if (!model)
    throw Error(whereOf(log.errors, xml) + ": not a valid URDF: " + joined(log.errors));
  requireAllCollisionElements(xml, *model, log.errors);
  for (const auto* messages : {&log.errors, &log.warnings})
  {
    for (const std::string& message : *messages)
    {
      const std::string warning = name + ": " + message;
      if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end())
        warnings.push_back(warning);
    }
  }
}
}  // namespace gpu_planning_scene::core
