#pragma once

#include <cstdint>
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include "lanes/host.h"

namespace lanes
{
/// The invocations of a warp, which a GPU runs together.
constexpr std::size_t kWarp = 32;
/// A cache moves memory in pieces of this size.
constexpr std::size_t kSectorBytes = 32;

/// The largest numbers that one invocation reaches. Between two barriers of its work group, the slowest invocation of
/// the group counts.
struct LongestPath
{
  std::uint64_t operations = 0;
  std::uint64_t accesses = 0;  ///< to texels and storage buffers
  LongestPath& operator+=(const LongestPath& other);
};

/// The work of dispatches of one program.
struct ProgramWork
{
  std::uint64_t dispatches = 0;
  std::uint64_t invocations = 0;
  Work work;
  /// Operations and accesses of all invocations. `steps_of_warps`: as if each invocation took as long as the slowest
  /// one of its warp between two barriers.
  std::uint64_t steps = 0;
  std::uint64_t steps_of_warps = 0;
  /// Different pieces of kSectorBytes of textures and storage buffers that a warp accesses between two barriers: what
  /// moves if each warp has a cache.
  std::uint64_t sectors = 0;
  LongestPath longest;  ///< summed over the dispatches
  ProgramWork& operator+=(const ProgramWork& other);
};

/// What the host asks of the device.
struct HostWork
{
  std::uint64_t calls = 0;  ///< of OpenGL
  std::uint64_t uploads = 0;
  std::uint64_t uploaded_bytes = 0;
  std::uint64_t downloads = 0;  ///< copies to mapped buffers included
  std::uint64_t downloaded_bytes = 0;
  std::uint64_t waits = 0;  ///< for fences and for downloads
};

/// Counts the work of a simulated device.
class WorkCounts
{
 public:
  /// Begins the next dispatch. The work that follows belongs to it.
  void begin(const std::string& program);

  /// Adds the work of a work group between two barriers: of its invocations, in their order, and the sectors of its
  /// warps. Adds the slowest invocation to the path of the group.
  void add(const std::vector<Work>& invocations, std::size_t sectors, LongestPath& path);

  /// Ends a work group.
  void endGroup(std::size_t invocations, const LongestPath& path);

  /// By the names of the programs.
  const std::map<std::string, ProgramWork>& programs();

  /// Prints tables with tabs: one row for each program and one for all, then the work of the host.
  void print(std::ostream& out);

  HostWork host;

 private:
  void endDispatch();

  std::map<std::string, ProgramWork> programs_;
  ProgramWork* current_ = nullptr;
  LongestPath longest_;  // of the current dispatch
};
}  // namespace lanes
