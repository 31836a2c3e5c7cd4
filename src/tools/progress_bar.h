#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace gpu_planning_scene::core
{
/// Shows a progress bar on stderr for work that takes longer than a second. Shows nothing if stderr is not a terminal.
class ProgressBar
{
 public:
  ProgressBar(std::string label, std::size_t total);
  ~ProgressBar();  ///< erases the bar
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(std::size_t done);

 private:
  std::string label_;
  std::size_t total_;
  bool terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point next_;
};
}  // namespace gpu_planning_scene::core
