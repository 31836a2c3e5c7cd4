// Compiles all compute shaders as C++ into the cache of loadKernel, so that no test has to.

#include <exception>
#include <iostream>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

#include "gpu/program.h"
#include "lanes/compute_shaders.h"
#include "lanes/kernel_library.h"

int main()
{
  constexpr int kProcesses = 2;
  const auto shaders = gpu_planning_scene::core::computeShaders(GPS_SOURCE_DIR "/shaders");
  const std::vector<std::string> texts(shaders.begin(), shaders.end());
  std::vector<pid_t> children;
  for (int process = 0; process < kProcesses; ++process)
  {
    const pid_t child = fork();
    if (child != 0)
    {
      children.push_back(child);
      continue;
    }
    try
    {
      for (std::size_t i = process; i < texts.size(); i += kProcesses)
        lanes::loadKernel(texts[i]);
    }
    catch (const std::exception& error)
    {
      std::cerr << error.what() << std::endl;
      _exit(1);
    }
    _exit(0);
  }
  int failures = 0;
  for (const pid_t child : children)
  {
    int status = 0;
    waitpid(child, &status, 0);
    failures += status != 0;
  }
  return failures == 0 ? 0 : 1;
}
