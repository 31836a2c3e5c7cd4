#include "tools/srdf_writer.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include <tinyxml2.h>

#include "base/text/name_list.h"
#include "gpu_planning_scene/error.h"
#include "model/description/proof_limits.h"
#include "model/robot_text.h"
#include "tools/chain_groups.h"

namespace gpu_planning_scene::core
{
namespace
{
std::string commentText(const GeneratedMatrix& matrix, const RobotModel& robot, const GeneratorOptions& options)
{
  std::ostringstream text;
  text.precision(3);
  text << kGeneratedComment << " for robot " << robot.name() << " from " << options.samples << " random states, seed "
       << options.seed
       << ".\n    Adjacent: one is the nearest link with shapes above the other, and at most one joint between them "
       << "moves.\n    Always: they collide in at least " << 100.0 * options.always_share
       << " % of the states. Default: also in the default state (every variable\n    is 0, or in the middle of its "
       << "limits if 0 is outside). Never: a proof shows that they collide in no state within\n    the limits of the "
       << "joints. " << matrix.remaining_pairs << " pairs of links remain to be checked. ";
  // A proof does not hold beyond the limits of this run, and the URDF or joint_limits may widen them later. A robot
  // that is read with this comment compares its limits with them (limitsBeyondProofs).
  std::vector<std::string> limits;
  for (const Variable& variable : robot.variables())
    if (variable.bounded)
      limits.push_back(describeVariable(variable));
  if (!limits.empty())
    text << "\n    The limits are: " << nameList(limits) << ". ";
  return text.str();
}

/// The entries are written in the order of their groups.
std::pair<bool, NeverProof> groupOf(const DisabledPair& pair)
{
  const bool never = pair.reason == DisabledReason::Never;
  return {never, never ? pair.proof : NeverProof::Reach};
}

/// The text before the entries of a group: what they have in common. Empty: there is no such text.
std::string groupText(const DisabledPair& pair)
{
  if (pair.reason != DisabledReason::Never)
    return "";
  return std::string(kGeneratedComment) +
         (pair.proof == NeverProof::Reach
              ? ": Never, because the regions that the two links can reach are apart. No state within the joint limits "
                "collides. "
              : ": Never, because all joint values between the two links were proven free, part by part. No state "
                "within\n    the joint limits collides. ");
}

/// XML comments must not contain two hyphens in a row, but a robot's name may.
bool isGenerated(const tinyxml2::XMLNode& node)
{
  if (const tinyxml2::XMLComment* comment = node.ToComment())
    return std::string(comment->Value()).rfind(kGeneratedComment, 0) == 0;
  const tinyxml2::XMLElement* element = node.ToElement();
  if (!element || std::string(element->Name()) != "disable_collisions")
    return false;
  const char* reason = element->Attribute("reason");
  return reason && !isUsersReason(reason);
}

void addGroups(const std::vector<std::string>& tips, const RobotModel& robot, tinyxml2::XMLDocument& document)
{
  tinyxml2::XMLElement* root = document.RootElement();
  if (!tips.empty())
    root->InsertEndChild(
        document.NewComment(" Planning groups by generate_acm: a chain from the root link to each tip, "
                            "with the name of the tip. Change them as you\n    need; they are kept. "));
  for (const std::string& tip : tips)
  {
    tinyxml2::XMLElement* group = root->InsertNewChildElement("group");
    group->SetAttribute("name", tip.c_str());
    tinyxml2::XMLElement* chain = group->InsertNewChildElement("chain");
    chain->SetAttribute("base_link", robot.links().front().name.c_str());
    chain->SetAttribute("tip_link", tip.c_str());
  }
}
}  // namespace

std::string robotNameOf(const std::string& srdf)
{
  tinyxml2::XMLDocument document;
  const bool is_robot = document.Parse(srdf.c_str()) == tinyxml2::XML_SUCCESS && document.RootElement() != nullptr &&
                        std::string(document.RootElement()->Name()) == "robot";
  const char* const name = is_robot ? document.RootElement()->Attribute("name") : nullptr;
  return name ? name : "";
}

std::vector<std::string> groupNamesOf(const std::string& srdf)
{
  tinyxml2::XMLDocument document;
  document.Parse(srdf.c_str());
  std::vector<std::string> names;
  const tinyxml2::XMLElement* const root = document.RootElement();
  for (const auto* group = root == nullptr ? nullptr : root->FirstChildElement("group"); group != nullptr;
       group = group->NextSiblingElement("group"))
    if (const char* const name = group->Attribute("name"); name != nullptr)
      names.emplace_back(name);
  return names;
}

std::string srdfWith(const GeneratedMatrix& matrix, const RobotModel& robot, const GeneratorOptions& options,
                     const std::string& srdf)
{
  tinyxml2::XMLDocument document;
  if (srdf.empty())
  {
    document.InsertEndChild(document.NewDeclaration("xml version=\"1.0\""));
    document.InsertEndChild(document.NewElement("robot"));
    document.RootElement()->SetAttribute("name", robot.name().c_str());
  }
  else if (document.Parse(srdf.data(), srdf.size()) != tinyxml2::XML_SUCCESS)
  {
    throw Error(std::string("the SRDF is not XML: ") + document.ErrorStr());
  }
  tinyxml2::XMLElement* root = document.RootElement();
  for (tinyxml2::XMLNode* node = root->FirstChild(); node != nullptr;)
  {
    tinyxml2::XMLNode* next = node->NextSibling();
    if (isGenerated(*node))
      root->DeleteChild(node);
    node = next;
  }
  if (root->FirstChildElement("group") == nullptr)
    addGroups(chainTips(robot), robot, document);
  root->InsertEndChild(document.NewComment(withoutDoubleHyphens(commentText(matrix, robot, options)).c_str()));
  std::vector<DisabledPair> disabled = matrix.disabled;
  std::stable_sort(disabled.begin(), disabled.end(),
                   [](const DisabledPair& a, const DisabledPair& b) { return groupOf(a) < groupOf(b); });
  for (std::size_t i = 0; i < disabled.size(); ++i)
  {
    const DisabledPair& pair = disabled[i];
    const std::string text = groupText(pair);
    if (!text.empty() && (i == 0 || groupOf(disabled[i - 1]) != groupOf(pair)))
      root->InsertEndChild(document.NewComment(text.c_str()));
    tinyxml2::XMLElement* entry = root->InsertNewChildElement("disable_collisions");
    entry->SetAttribute("link1", robot.links()[pair.first].name.c_str());
    entry->SetAttribute("link2", robot.links()[pair.second].name.c_str());
    entry->SetAttribute("reason", nameOf(pair.reason));
  }
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}
}  // namespace gpu_planning_scene::core
