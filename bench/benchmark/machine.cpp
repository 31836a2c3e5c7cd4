#include "benchmark/machine.h"

#include <fstream>
#include <thread>

#include "gpu/egl_context.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
std::string processorName()
{
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0)
      return line.substr(line.find(':') + 2);
  return "unknown";
}
}  // namespace

Machine::Machine(const std::string& device)
  : device_(EglContext(device).device()), processor_(processorName()), cores_(std::thread::hardware_concurrency())
{
}

void Machine::write(CsvTable& table) const
{
  table.add({"device", device_.renderer});
  table.add({"opengl", device_.version});
  table.add({"processor", processor_});
  table.add({"cores", cores_});
}

std::string Machine::line() const
{
  return "device: " + device_.renderer + "; " + std::to_string(cores_) + " cores, " + processor_;
}
}  // namespace gpu_planning_scene::core::benchmark
