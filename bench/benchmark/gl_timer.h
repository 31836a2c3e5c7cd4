#pragma once

#include <cstddef>
#include <map>
#include <string>

namespace gpu_planning_scene::core::benchmark
{
/// The time on the device of a kind of command.
struct CommandTime
{
  std::size_t calls = 0;
  double seconds = 0.0;
  double longest = 0.0;  ///< seconds
};

/// Times each dispatch, copy and clear of this process on the device, while the object lives. Each command gets a
/// timestamp (GL_TIMESTAMP) before and after it, and the results are read when the host has waited for a fence. The
/// timestamps take time themselves, so do not time the host meanwhile. There is one object at a time.
class GlTimer
{
 public:
  /// Each function of OpenGL that is timed must have been called before: libepoxy looks a function up at its first
  /// call, and would then forget this object.
  GlTimer();
  ~GlTimer();
  GlTimer(const GlTimer&) = delete;
  GlTimer& operator=(const GlTimer&) = delete;

  /// The times of the commands that have ended, by kind: the label of a program (see Program), "clear", "copy",
  /// "upload" (a copy from mapped memory) or "readback" (a copy to it).
  static std::map<std::string, CommandTime> times();
};
}  // namespace gpu_planning_scene::core::benchmark
