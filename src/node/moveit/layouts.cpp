#include "node/moveit/layouts.h"

#include <algorithm>
#include <array>
#include <map>
#include <sstream>

#include "gpu_planning_scene/error.h"
#include "node/moveit/moveit_messages.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr char kSeparator[] = "MSG: ";  // before the type of each message of a definition, except for the first one

/// The lines of each message of a definition, by type without package. The first message has the type "". Of a type
/// that is defined twice, the first definition counts.
std::map<std::string, std::vector<std::string>> sectionsOf(const std::string& definition)
{
  std::map<std::string, std::vector<std::string>> sections;
  std::vector<std::string>* section = &sections[""];
  std::istringstream text(definition);
  for (std::string line; std::getline(text, line);)
    if (line.rfind(kSeparator, 0) == 0)
    {
      const auto [type, is_new] = sections.emplace(line.substr(line.rfind('/') + 1), std::vector<std::string>());
      section = is_new ? &type->second : nullptr;
    }
    else if (section != nullptr && !line.empty() && line.front() != '=')
      section->push_back(line.substr(0, line.find('#')));
  return sections;
}

/// Two names of one type get one name. Packages are left out: our messages have the names of MoveIt's.
std::string plainType(const std::string& type)
{
  std::string base = type.substr(type.find('/') + 1);
  if (base.rfind("byte", 0) == 0)
    return "int8" + base.substr(4);
  if (base.rfind("char", 0) == 0)
    return "uint8" + base.substr(4);
  return base;
}

bool isBuiltIn(const std::string& type)
{
  constexpr std::array<const char*, 14> kBuiltIn = {{"bool", "int8", "uint8", "int16", "uint16", "int32", "uint32",
                                                     "int64", "uint64", "float32", "float64", "string", "time",
                                                     "duration"}};
  return std::find(kBuiltIn.begin(), kBuiltIn.end(), type) != kBuiltIn.end();
}

class LayoutReader
{
 public:
  explicit LayoutReader(const std::string& definition) : sections_(sectionsOf(definition)) {}

  std::vector<std::string> read()
  {
    add("", "");
    return std::move(layout_);
  }

 private:
  void add(const std::string& type, const std::string& prefix)
  {
    const auto section = sections_.find(type);
    if (section == sections_.end())
      throw Error("the definition of a message lacks the type '" + type + "'");
    for (const std::string& line : section->second)
    {
      std::istringstream words(line);
      std::string field_type;
      std::string name;
      if (!(words >> field_type >> name))
        continue;
      field_type = plainType(field_type);
      if (const std::size_t equals = line.find('='); equals != std::string::npos)
      {
        std::string constant = line.substr(line.find(name));
        constant.erase(std::remove(constant.begin(), constant.end(), ' '), constant.end());
        layout_.push_back(field_type + " " + prefix + constant);
        continue;
      }
      layout_.push_back(field_type + " " + prefix + name);
      const std::string element = field_type.substr(0, field_type.find('['));
      if (!isBuiltIn(element))
        add(element, prefix + name + ".");
    }
  }

  const std::map<std::string, std::vector<std::string>> sections_;
  std::vector<std::string> layout_;
};

template <class Message>
std::string definitionOf()
{
  return ros::message_traits::Definition<Message>::value();
}

template <class Ours, class Theirs>
LayoutPair pairOf(const std::string& first_own = {})
{
  return {ros::message_traits::DataType<Theirs>::value(), definitionOf<Ours>(), definitionOf<Theirs>(), first_own};
}

/// StateValidityRequest is no message of ROS, so it has no definition of its own.
std::string stateValidityDefinition()
{
  const std::string separator = std::string("\n") + kSeparator;
  return "RobotState robot_state\nstring group_name\nConstraints constraints" + separator +
         "gpu_planning_scene/RobotState\n" + definitionOf<RobotState>() + separator + "moveit_msgs/Constraints\n" +
         definitionOf<moveit_msgs::Constraints>();
}

/// The response of our service without the fields before its scene: MoveIt's response has only the scene.
std::string sceneOfResponse()
{
  return "PlanningScene scene" + std::string("\n") + kSeparator + "gpu_planning_scene/PlanningScene\n" +
         definitionOf<PlanningSceneMessage>();
}
}  // namespace

std::vector<std::string> layoutOf(const std::string& definition)
{
  return LayoutReader(definition).read();
}

void requireEqualLayouts(const LayoutPair& pair)
{
  std::vector<std::string> our_layout = layoutOf(pair.ours);
  const std::vector<std::string> their_layout = layoutOf(pair.theirs);
  const auto is_first_own = [&pair](const std::string& field)
  { return !pair.first_own.empty() && field.substr(field.find_last_of(" .") + 1) == pair.first_own; };
  our_layout.erase(std::find_if(our_layout.begin(), our_layout.end(), is_first_own), our_layout.end());
  const auto [our, their] =
      std::mismatch(our_layout.begin(), our_layout.end(), their_layout.begin(), their_layout.end());
  if (our == our_layout.end() && their == their_layout.end())
    return;
  const auto text = [](const auto& at, const auto& end) { return at == end ? "no further field" : "'" + *at + "'"; };
  throw Error(pair.name + " has " + text(their, their_layout.end()) + " where the message of this package has " +
              text(our, our_layout.end()) + "; build this package with moveit_msgs 0.11 or without moveit_msgs");
}

std::vector<LayoutPair> moveItLayouts()
{
  const std::string own_of_scene = "scene_revision";
  return {pairOf<PlanningSceneMessage, moveit_msgs::PlanningScene>(own_of_scene),
          pairOf<CollisionObject, moveit_msgs::CollisionObject>(),
          pairOf<AttachedCollisionObject, moveit_msgs::AttachedCollisionObject>(),
          pairOf<PlanningSceneWorld, moveit_msgs::PlanningSceneWorld>(),
          pairOf<GetPlanningScene::Request, moveit_msgs::GetPlanningScene::Request>(),
          {ros::message_traits::DataType<moveit_msgs::GetPlanningScene::Response>::value(), sceneOfResponse(),
           definitionOf<moveit_msgs::GetPlanningScene::Response>(), own_of_scene},
          pairOf<ApplyPlanningScene::Request, moveit_msgs::ApplyPlanningScene::Request>(own_of_scene),
          {ros::message_traits::DataType<moveit_msgs::GetStateValidity::Request>::value(), stateValidityDefinition(),
           definitionOf<moveit_msgs::GetStateValidity::Request>(), ""}};
}

void requireMoveItLayouts()
{
  for (const LayoutPair& pair : moveItLayouts())
    requireEqualLayouts(pair);
}
}  // namespace gpu_planning_scene::core
