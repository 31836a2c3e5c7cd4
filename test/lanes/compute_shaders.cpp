#include "lanes/compute_shaders.h"

#include <cstdlib>

#include "collision/gpu/gpu_pair_checker.h"
#include "collision/gpu/problem/gpu_kinematics.h"
#include "gpu/float_arithmetic.h"
#include "lanes/gl_device.h"
#include "lanes/proof_shaders.h"

namespace gpu_planning_scene::core
{
namespace
{
const std::string kUntrusted = "#define FLOAT32_TRUSTED 0\n";

/// A robot with a joint of each type.
std::shared_ptr<const RobotModel> robotWithAllJoints()
{
  std::string xml = "<robot name='joints'><link name='l0'/>";
  const std::string ball = "<collision><geometry><sphere radius='0.1'/></geometry></collision>";
  int link = 0;
  for (const char* type : {"planar", "floating", "revolute", "continuous", "prismatic", "fixed"})
  {
    const std::string parent = "l" + std::to_string(link);
    const std::string child = "l" + std::to_string(++link);
    xml += "<link name='" + child + "'>" + ball + "</link><joint name='j" + child + "' type='" + type +
           "'><parent link='" + parent + "'/><child link='" + child +
           "'/><axis xyz='0 0.6 0.8'/><limit lower='-1' upper='1' effort='1' velocity='1'/></joint>";
  }
  return RobotModel::fromXml(xml + "</robot>", "", {});
}

}  // namespace

std::set<std::string> computeShaders(const std::string& folder)
{
  lanes::recordOnly();
  lanes::replaceOpenGl();
  setenv("GPU_PLANNING_SCENE_PROGRAM_CACHE", "off", 1);
  for (const Traversal traversal : {Traversal::BreadthFirst, Traversal::WorkQueue})
  {
    GpuPairChecker(folder, traversal, 64).prepareMargins();
    const auto programs = makeTraversal(traversal, folder, kUntrusted);
    for (const bool solids : {false, true})
      for (const bool padded : {false, true})
        programs->prepare({solids, padded, 1});
  }
  for (const std::string& definitions : {std::string(), kUntrusted})
    compileProofShaders(folder, robotWithAllJoints(), definitions);
  findDoubleFault(folder);
  findEmulatedDouble(folder);
  const GpuKinematics kinematics(folder, robotWithAllJoints());
  std::set<std::string> texts;
  for (const std::string& text : lanes::compiledShaders())
  {
    texts.insert(text);
    const std::size_t at = text.find(kUntrusted);
    if (at != std::string::npos)
      texts.insert(std::string(text).erase(at, kUntrusted.size()));
  }
  return texts;
}
}  // namespace gpu_planning_scene::core
