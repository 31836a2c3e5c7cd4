#include <cmath>
#include <csignal>
#include <filesystem>
#include <limits>
#include <sstream>

#include <dlfcn.h>
#include <sys/wait.h>

#include "base/text/memory_text.h"
#include "base/text/number_text.h"
#include "base/text/one_line.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/mesh_reader.h"
#include "model/files/child_process.h"
#include "model/files/mesh_pipe.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kMaxErrorBytes = 4096;
constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

MeshLimits noLimits()
{
  MeshLimits limits;
  limits.seconds = 9e5;
  limits.memory = kNoLimit;
  limits.file = kNoLimit;
  limits.triangles = 0x7fffffff;  // as many as a mesh can have
  return limits;
}

std::shared_ptr<const Mesh> readInChild(const std::string& program, const MeshLimits& limits, const std::string& path,
                                        const Eigen::Vector3d& scale)
{
  const std::string file = "mesh file '" + path + "': ";
  // read_mesh itself closes the files that it inherits.
  const ChildAnswer answer =
      runChild("the mesh reader",
               {program, path, exactText(scale.x()), exactText(scale.y()), exactText(scale.z()),
                std::to_string(static_cast<long>(std::ceil(limits.seconds))), std::to_string(limits.memory),
                std::to_string(limits.file), std::to_string(limits.triangles)},
               {limits.seconds, maxMeshBytes(limits.triangles), kMaxErrorBytes});
  const int status = answer.status;
  if (!answer.late && !answer.too_long && !answer.has_status)
  {
    // The reader writes its answer as its last action, so a complete answer needs no status.
    if (!answer.err.empty())
      throw Error(onOneLine(answer.err));
    if (!answer.out.empty())
      return meshFromBytes(answer.out, path, limits.triangles);
    throw Error(file + "the reader has ended, but " + kNoStatus);
  }
  if (answer.late || (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGALRM)))
  {
    std::ostringstream seconds;
    seconds << limits.seconds;
    throw Error(file + "reading it takes longer than " + seconds.str() + " s (~mesh/seconds)");
  }
  if (answer.too_long)
    throw Error(file + "the reader sent more data than a mesh of " + std::to_string(limits.triangles) +
                " triangles has");
  if (WIFSIGNALED(status))
    throw Error(file + "the reader crashed (signal " + std::to_string(WTERMSIG(status)) + ")");
  switch (WEXITSTATUS(status))
  {
    case 0:
      return meshFromBytes(answer.out, path, limits.triangles);
    case 1:
      throw Error(onOneLine(answer.err));
    case 3:
      if (limits.memory == kNoLimit)
        throw Error(file + "there is not enough memory to read it");
      throw Error(file + "reading it needs more than " + megabytes(limits.memory) + " of memory (~mesh/memory)");
    default:
      throw Error(file + "the reader failed with exit code " + std::to_string(WEXITSTATUS(status)));
  }
}
}  // namespace

ReadMesh childMeshReader(std::string program, const MeshLimits& limits)
{
  if (!(limits.seconds > 0.0 && limits.seconds < 1e6))
    throw Error("the time for a mesh file (~mesh/seconds) must be above 0 and below 1e6 seconds");
  return [program = std::move(program), limits](const std::string& path, const Eigen::Vector3d& scale)
  { return readInChild(program, limits, path, scale); };
}

/// The folder relative to the file of this library, so that an installation can be moved.
std::string meshReaderProgram()
{
  namespace fs = std::filesystem;
  Dl_info library;
  fs::path installed;
  if (dladdr(reinterpret_cast<const void*>(&meshReaderProgram), &library) != 0)
    installed = (fs::canonical(library.dli_fname).parent_path() / GPS_PROGRAMS_FROM_LIBRARY).lexically_normal();
  std::error_code unreadable;
  for (const fs::path& folder : {installed, fs::path(GPS_BUILT_PROGRAMS)})  // the latter is empty in a binary package
    if (!folder.empty() && fs::exists(folder / "read_mesh", unreadable))
      return (folder / "read_mesh").string();
  throw Error("the program read_mesh, which reads mesh files, is not in " + installed.string() +
              "; install the whole package, or build the target read_mesh");
}

ReadMesh defaultMeshReader()
{
  return [](const std::string& path, const Eigen::Vector3d& scale)
  { return readInChild(meshReaderProgram(), noLimits(), path, scale); };
}
}  // namespace gpu_planning_scene::core
