#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace gpu_planning_scene::core
{
struct ChildLimits
{
  double seconds;   ///< above 0 and below 1e6
  std::size_t out;  ///< bytes of the standard output
  std::size_t err;  ///< bytes of the standard error
};

/// The output and the end of a child process.
struct ChildAnswer
{
  std::string out;
  std::string err;
  bool late = false;       ///< it was killed, because the time was over
  bool too_long = false;   ///< it was killed, because it wrote more than allowed
  bool has_status = true;  ///< false: the process has ended, but its status is lost, see kNoStatus
  int status = 0;          ///< the status of waitpid
};

/// The system reaps the child processes of a program that ignores SIGCHLD, and a program may reap children of others.
constexpr char kNoStatus[] =
    "its exit status is lost, because this program ignores SIGCHLD or waits for all of its child processes; let it "
    "handle SIGCHLD by SIG_DFL, and wait only for its own child processes";

/// Runs a program without a shell, with /dev/null as its standard input, and waits for its end. `what`: the program's
/// name in messages. `command`: the path of the program, then its arguments. The program is the leader of a process
/// group of its own. If it is killed, all processes of this group are. The program inherits files that are open without
/// O_CLOEXEC. Throws Error if the program cannot be started. Thread-safe.
ChildAnswer runChild(const std::string& what, const std::vector<std::string>& command, const ChildLimits& limits);
}  // namespace gpu_planning_scene::core
