// An arbitrary URDF becomes a robot or one line of error.

#include "fuzz/fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace gpu_planning_scene::core;
  acceptOrRefuse(
      [&]
      {
        RobotModelOptions options;
        options.packages = fuzzedPackages();
        options.meshes = fuzzedMeshes();
        std::vector<std::string> warnings;
        useRobot(*RobotModel::fromXml(textOf(data, size), "", options, &warnings));
      });
  return 0;
}
