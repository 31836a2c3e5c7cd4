// read_mesh: reads one mesh file under limits on time and memory, and writes the mesh to the standard output, for
// childMeshReader. A hostile file can crash or hang only this process.
//
// It ends with its parent.
//
//   read_mesh FILE SCALE_X SCALE_Y SCALE_Z SECONDS MEMORY FILE_SIZE TRIANGLES
//
// Exit code: 0 with the mesh on the standard output; 1 with one line on the standard error; 3 out of memory; 2 bad
// usage.

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <string>
#include <vector>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/mesh_reader.h"
#include "model/files/mesh_pipe.h"

namespace
{
using namespace gpu_planning_scene::core;

/// Closes all files but the standard ones. The parent's sockets and devices must not stay open in this process.
void closeInheritedFiles()
{
  std::vector<int> inherited;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd"))
    inherited.push_back(std::stoi(entry.path().filename().string()));
  for (const int file : inherited)
    if (file > STDERR_FILENO)
      close(file);
}

/// Only a privileged process can raise a limit that its parent has set.
void limit(__rlimit_resource_t resource, rlim_t max)
{
  rlimit value{};
  getrlimit(resource, &value);
  value.rlim_max = std::min(max, value.rlim_max);
  value.rlim_cur = value.rlim_max;
  if (setrlimit(resource, &value) != 0)
    throw Error("the mesh reader cannot set its limits of memory and time");
}

void limitThisProcess(unsigned seconds, rlim_t memory)
{
  limit(RLIMIT_CPU, seconds);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);
  alarm(seconds + 1);
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // ends this process if the thread that waits for it has ended
#ifndef __SANITIZE_ADDRESS__         // the sanitizer's shadow memory takes terabytes of address space
  limit(RLIMIT_AS, memory);
#else
  static_cast<void>(memory);
#endif
}

void write(const std::string& bytes)
{
  if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() || std::fflush(stdout) != 0)
    throw Error("the mesh reader cannot write its answer");
}

std::size_t number(const char* text)
{
  return std::strtoull(text, nullptr, 10);
}

void read(const char* const* arguments)
{
  closeInheritedFiles();
  const std::string path = arguments[1];
  const Eigen::Vector3d scale(std::atof(arguments[2]), std::atof(arguments[3]), std::atof(arguments[4]));
  limitThisProcess(static_cast<unsigned>(number(arguments[5])), number(arguments[6]));
  const std::size_t max_bytes = number(arguments[7]);
  const std::size_t max_triangles = number(arguments[8]);
  std::error_code none;
  const auto bytes = std::filesystem::file_size(path, none);
  if (!none && bytes > max_bytes)
    throw Error("mesh file '" + path + "': it has " + std::to_string(bytes) + " bytes; at most " +
                std::to_string(max_bytes) + " are allowed (~mesh/file_size)");
  const auto mesh = readMeshFile(path, scale);
  if (mesh->triangles.size() > max_triangles)
    throw Error("mesh file '" + path + "': it has " + std::to_string(mesh->triangles.size()) + " triangles; at most " +
                std::to_string(max_triangles) + " are allowed (~limits/triangles_of_mesh)");
  write(meshBytes(*mesh));
}
}  // namespace

int main(int argc, char** argv)
{
  if (argc != 9)
  {
    const bool asks_for_help = argc == 2 && std::string(argv[1]) == "--help";
    std::fputs("usage: read_mesh FILE SCALE_X SCALE_Y SCALE_Z SECONDS MEMORY FILE_SIZE TRIANGLES\n",
               asks_for_help ? stdout : stderr);
    return asks_for_help ? 0 : 2;
  }
  try
  {
    read(argv);
    return 0;
  }
  catch (const std::bad_alloc&)
  {
    return 3;
  }
  catch (const std::exception& error)
  {
    std::fputs(error.what(), stderr);
    return 1;
  }
}
