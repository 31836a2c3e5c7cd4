#pragma once

#include <string>

#include "benchmark/csv_table.h"
#include "gpu_planning_scene/device.h"

namespace gpu_planning_scene::core::benchmark
{
/// The device and the processor of a run.
class Machine
{
 public:
  /// `device`: a selector, see BatchCheckerOptions. Throws Error as EglContext does.
  explicit Machine(const std::string& device);
  /// Adds rows of what and value.
  void write(CsvTable& table) const;
  /// All of it in one line.
  std::string line() const;

 private:
  Device device_;
  std::string processor_;
  std::size_t cores_;
};
}  // namespace gpu_planning_scene::core::benchmark
