// The library of the simulated device for whole programs: LD_PRELOAD=liblanes_device.so PROGRAM. The environment
// variables are described in docs/gpu.md.

#include <cstdio>
#include <cstdlib>
#include <string>

#include <unistd.h>

#include "lanes/gl_device.h"

namespace
{
unsigned long number(const char* name, unsigned long otherwise)
{
  const char* text = std::getenv(name);
  return text ? std::strtoul(text, nullptr, 0) : otherwise;
}

struct Preload
{
  Preload()
  {
    setenv("GPU_PLANNING_SCENE_PROGRAM_CACHE", "off", 1);
    lanes::device().setSeed(number("GPS_LANES_SEED", 1));
    if (number("GPS_LANES_EXACT", 0) != 0)
      lanes::device().useExactArithmetic();
    lanes::device().setResidentGroups(number("GPS_LANES_GROUPS", 3));
    const char* const before = std::getenv("GPS_LANES_IGNORE_BEFORE");
    lanes::ignoreBarrierBits(static_cast<std::uint32_t>(number("GPS_LANES_IGNORE_BITS", 0)), before ? before : "");
    lanes::replaceOpenGl();
  }
  ~Preload()
  {
    lanes::device().commands().finish();
    const auto& faults = lanes::device().faults();
    for (const std::string& fault : faults)
      std::fprintf(stderr, "lanes: %s\n", fault.c_str());
    if (faults.empty())
      return;
    std::fflush(nullptr);
    _exit(1);
  }
};
Preload preload;
}  // namespace
