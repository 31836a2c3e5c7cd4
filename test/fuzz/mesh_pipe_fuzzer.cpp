// Any bytes of a mesh reader, even of a compromised one, become a mesh or one line of error.

#include "fuzz/fuzz_target.h"
#include "model/files/mesh_pipe.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace gpu_planning_scene::core;
  acceptOrRefuse([&] { validateMesh(*meshFromBytes(textOf(data, size), "fuzzed.stl", 1000)); });
  return 0;
}
