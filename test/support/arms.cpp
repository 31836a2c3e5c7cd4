#include "support/arms.h"

#include <filesystem>

#include "model/real_robots.h"
#include "tools/acm_generator.h"
#include "tools/srdf_writer.h"

namespace gpu_planning_scene::core
{
namespace
{
std::shared_ptr<const RobotModel> load(const RealRobot& robot, const std::string& srdf)
{
  RobotModelOptions options;
  options.packages = packageResolver(robot.packages);
  options.urdf_folder = std::filesystem::path(robot.urdf).parent_path().string();
  return RobotModel::fromXml(robot.urdfText(), srdf, options);
}

std::string replaced(std::string text, const std::string& what, const std::string& by)
{
  const std::size_t at = text.find(what);
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}
/// The robot with an SRDF without matrix, and the matrix that MoveIt's Setup Assistant would add.
std::shared_ptr<const RobotModel> withMatrix(const RealRobot& robot, const std::string& srdf)
{
  GeneratorOptions generator;
  generator.samples = 300;
  generator.proof_tests = 0;
  const std::shared_ptr<const RobotModel> bare = load(robot, "");
  GeneratedMatrix matrix = generateMatrix(bare, generator);
  for (const auto& [first, second] : matrix.unproven)
    matrix.disabled.push_back({first, second, DisabledReason::Never});
  return load(robot, srdfWith(matrix, *bare, generator, srdf));
}

std::vector<Arm> loadArms()
{
  std::vector<Arm> arms;
  if (panda().available())
    arms.push_back({"panda", panda().load(), "panda_arm", panda().urdfText(), "panda_link0"});
  if (ur5Robotiq().available())
    arms.push_back({"ur5", ur5Robotiq().load(), "manipulator", ur5Robotiq().urdfText(), "base_link"});
  if (kr5().available())
  {
    const std::string srdf =
        "<robot name='KR5'><group name='palm'><chain base_link='world' tip_link='palm'/></group></robot>";
    arms.push_back({"kr5", withMatrix(kr5(), srdf), "palm", kr5().urdfText(), "world"});
  }
  if (pr2().available())
    arms.push_back({"pr2", withMatrix(pr2(), pr2().srdfText()), "right_arm", pr2().urdfText(), "torso_lift_link"});
  if (panda().available())
  {
    const std::string planar = replaced(panda().srdfText(), "type=\"floating\"", "type=\"planar\"");
    const std::string group = "<group name='mobile_arm'><joint name='virtual_joint'/><group name='panda_arm'/></group>";
    arms.push_back({"panda_on_base", load(panda(), replaced(planar, "</robot>", group + "</robot>")), "mobile_arm",
                    panda().urdfText(), ""});
  }
  return arms;
}
}  // namespace

const std::vector<Arm>& realArms()
{
  static const std::vector<Arm> arms = loadArms();
  return arms;
}
}  // namespace gpu_planning_scene::core
