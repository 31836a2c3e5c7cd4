// An arbitrary scene file in YAML becomes a scene or one line of error.

#include "fuzz/fuzz_target.h"
#include "gpu_planning_scene/planning_scene.h"
#include "model/model_testing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace gpu_planning_scene::core;
  static const auto robot = robotOf(
      armUrdf(), R"(<virtual_joint name="base_joint" type="floating" parent_frame="world" child_link="base"/>)");
  static const TemporaryFolder folder;
  const std::string path = folder.write("scene.yaml", textOf(data, size));
  acceptOrRefuse(
      [&]
      {
        std::vector<std::string> warnings;
        loadSceneFile(path, robot, fuzzedPackages(), &warnings, fuzzedMeshes());
      });
  return 0;
}
