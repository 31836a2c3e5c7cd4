// Any content of a mesh file becomes a mesh or one line of error. The first byte chooses the format, because the name
// of a file does so otherwise.

#include "fuzz/fuzz_target.h"
#include "model/meshes/mesh_formats.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace gpu_planning_scene::core;
  const std::string input = textOf(data, size);
  const char format = input.empty() ? 's' : input[0];
  const auto read = format == 'o' ? readObj : format == 'p' ? readPly : format == 'd' ? readCollada : readStl;
  acceptOrRefuse(
      [&]
      {
        MeshBuilder mesh("fuzzed", Eigen::Vector3d::Ones());
        read(std::string_view(input).substr(std::min<std::size_t>(1, input.size())), mesh);
        validateMesh(*mesh.finish());
      });
  return 0;
}
