// An arbitrary .scene text becomes a scene or one line of error.

#include "fuzz/fuzz_target.h"
#include "gpu_planning_scene/planning_scene.h"
#include "model/model_testing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace gpu_planning_scene::core;
  static const auto robot = robotOf(armUrdf());
  static const TemporaryFolder folder;
  const std::string path = folder.write("fuzzed.scene", textOf(data, size));
  acceptOrRefuse(
      [&]
      {
        std::vector<std::string> warnings;
        loadSceneFile(path, robot, fuzzedPackages(), &warnings, fuzzedMeshes());
      });
  return 0;
}
