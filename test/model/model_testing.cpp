#include "model/model_testing.h"

#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
const char* const kLimits = R"(<limit lower="-1" upper="2" effort="1" velocity="1"/>)";

TemporaryFolder::TemporaryFolder()
{
  std::string name = (std::filesystem::temp_directory_path() / "gpu_planning_scene_test_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw std::runtime_error("cannot make a temporary folder");
  folder_ = name;
}

TemporaryFolder::~TemporaryFolder()
{
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::string TemporaryFolder::write(const std::string& name, const std::string& content) const
{
  std::filesystem::create_directories((folder_ / name).parent_path());
  std::ofstream(folder_ / name, std::ios::binary) << content;
  return path(name);
}

std::string errorOf(const std::function<void()>& action)
{
  try
  {
    action();
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "";
}

std::shared_ptr<const RobotModel> robotOf(const std::string& urdf, const std::string& srdf,
                                          std::vector<std::string>* warnings)
{
  RobotModelOptions options;
  options.urdf_name = "test.urdf";
  options.srdf_name = "test.srdf";
  const auto wrap = [](const std::string& text) { return "<robot name=\"test\">" + text + "</robot>"; };
  return RobotModel::fromXml(wrap(urdf), srdf.empty() ? srdf : wrap(srdf), options, warnings);
}

std::string boxLink(const std::string& name)
{
  return "<link name=\"" + name + R"("><collision><geometry><box size="1 1 1"/></geometry></collision></link>)" + "\n";
}

std::string jointXml(const std::string& name, const std::string& type, const std::string& parent,
                     const std::string& child, const std::string& inside)
{
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/>" + inside + "</joint>\n";
}

std::string armUrdf()
{
  std::string urdf;
  for (const char* link : {"base", "upper", "fore", "hand", "finger_left", "finger_right", "head"})
    urdf += boxLink(link);
  return urdf + jointXml("arm_1", "revolute", "base", "upper", kLimits) +
         jointXml("arm_2", "revolute", "upper", "fore", kLimits) + jointXml("hand_fix", "fixed", "fore", "hand") +
         jointXml("left", "prismatic", "hand", "finger_left", kLimits) +
         jointXml("right", "prismatic", "hand", "finger_right", kLimits + std::string("<mimic joint=\"left\"/>")) +
         jointXml("pan", "continuous", "base", "head");
}

std::string srdfError(const std::string& srdf)
{
  return errorOf([&] { robotOf(armUrdf(), srdf); });
}

std::vector<std::string> linkNames(const RobotModel& robot, const std::vector<int>& links)
{
  std::vector<std::string> names;
  for (const int link : links)
    names.push_back(robot.links()[link].name);
  return names;
}

std::vector<std::string> jointNames(const RobotModel& robot, const std::vector<int>& joints)
{
  std::vector<std::string> names;
  for (const int joint : joints)
    names.push_back(robot.joints()[joint].name);
  return names;
}
}  // namespace gpu_planning_scene::core
