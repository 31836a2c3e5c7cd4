// lanes_workload SHADERS SEEDS [NAME...]: runs small tasks on the simulated device, with the seeds 1 to SEEDS, until
// one is wrong. Prints the task, the seed and what was wrong, and then has exit status 1. The environment variables are
// those of docs/gpu.md.

#include <cstdlib>
#include <exception>
#include <iostream>

#include "lanes/gl_device.h"
#include "lanes/workloads.h"

using namespace gpu_planning_scene::core;

int main(int argc, char** argv)
{
  try
  {
    if (argc < 3)
      throw std::runtime_error("usage: lanes_workload SHADERS SEEDS [NAME...]");
    setenv("GPU_PLANNING_SCENE_PROGRAM_CACHE", "off", 1);
    const char* const bits = std::getenv("GPS_LANES_IGNORE_BITS");
    const char* const before = std::getenv("GPS_LANES_IGNORE_BEFORE");
    lanes::ignoreBarrierBits(bits ? static_cast<std::uint32_t>(std::strtoul(bits, nullptr, 0)) : 0U,
                             before ? before : "");
    lanes::replaceOpenGl();
    const std::vector<std::string> names = argc > 3 ? std::vector<std::string>(argv + 3, argv + argc) : workloadNames();
    char* rest = nullptr;
    const std::uint64_t number = std::strtoull(argv[2], &rest, 10);
    const std::uint64_t first = *rest == '-' ? number : 1;
    const std::uint64_t last = *rest == '-' ? std::strtoull(rest + 1, nullptr, 10) : number;
    for (std::uint64_t seed = first; seed <= last; ++seed)
      for (const std::string& name : names)
      {
        const std::vector<std::string> wrong = runWorkload(name, argv[1], seed);
        if (wrong.empty())
          continue;
        std::cout << name << "\t" << seed;
        for (const std::string& line : wrong)
          std::cout << "\t" << line;
        std::cout << std::endl;
        return 1;
      }
    return 0;
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << std::endl;
    return 2;
  }
}
