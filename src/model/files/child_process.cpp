#include "model/files/child_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
using Clock = std::chrono::steady_clock;

class Pipe
{
 public:
  explicit Pipe(const std::string& what)
  {
    if (pipe2(ends_.data(), O_CLOEXEC) != 0)
      throw Error("cannot make a pipe to " + what + ": " + std::strerror(errno));
  }
  ~Pipe()
  {
    closeEnd(0);
    closeEnd(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int readEnd() const { return ends_[0]; }
  int writeEnd() const { return ends_[1]; }
  void closeWriteEnd() { closeEnd(1); }

 private:
  void closeEnd(std::size_t end)
  {
    if (ends_[end] >= 0)
      close(ends_[end]);
    ends_[end] = -1;
  }
  std::array<int, 2> ends_{{-1, -1}};
};

/// A child process with `out` and `err` as its standard output and error. It leads a process group of its own, because
/// it may start processes too. The destructor kills the group if the child still runs, and reaps the child.
class Child
{
 public:
  Child(const std::string& what, const std::vector<std::string>& command, const Pipe& out, const Pipe& err)
  {
    std::vector<char*> arguments;
    for (const std::string& word : command)
      arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files, out.writeEnd(), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, err.writeEnd(), STDERR_FILENO);
    // A ROS node ignores broken pipes and may block signals; its child must not.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigset_t all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    const int error = posix_spawn(&id_, command[0].c_str(), &files, &attributes, arguments.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    if (error != 0)
      throw Error("cannot start " + what + " '" + command[0] + "': " + std::strerror(error));
  }
  ~Child()
  {
    kill();
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void kill() const
  {
    if (id_ > 0)
      ::kill(-id_, SIGKILL);
  }

  /// Waits for the end of the process, at most until `end`. Returns true if it has ended.
  bool endsBy(Clock::time_point end) const
  {
    for (;; std::this_thread::sleep_for(std::chrono::milliseconds(1)))
    {
      siginfo_t ended{};  // wait() still needs its status
      const int result = waitid(P_PID, static_cast<id_t>(id_), &ended, WEXITED | WNOHANG | WNOWAIT);
      if ((result == 0 && ended.si_pid == id_) || (result != 0 && errno == ECHILD))
        return true;
      if (Clock::now() >= end)
        return false;
    }
  }

  /// Waits for the process and returns the status of waitpid. Returns nothing if the status is lost.
  std::optional<int> wait()
  {
    int status = 0;
    pid_t waited = -1;
    while (id_ > 0 && (waited = waitpid(id_, &status, 0)) < 0 && errno == EINTR)
    {
    }
    id_ = -1;
    return waited > 0 ? std::optional<int>(status) : std::nullopt;
  }

 private:
  pid_t id_ = -1;
};

/// Reads the output of the child until it closes both pipes, the time is over, or it writes more than allowed.
ChildAnswer readAnswer(const Pipe& out, const Pipe& err, Clock::time_point end, const ChildLimits& limits)
{
  ChildAnswer answer;
  std::array<pollfd, 2> ends{{{out.readEnd(), POLLIN, 0}, {err.readEnd(), POLLIN, 0}}};
  std::vector<char> buffer(1 << 16);
  while (ends[0].fd >= 0 || ends[1].fd >= 0)
  {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0)
    {
      answer.late = true;
      return answer;
    }
    if (poll(ends.data(), ends.size(), static_cast<int>(std::min<long long>(left, 1000))) <= 0)
      continue;
    for (std::size_t i = 0; i < ends.size(); ++i)
    {
      if (ends[i].fd < 0 || ends[i].revents == 0)
        continue;
      const ssize_t count = read(ends[i].fd, buffer.data(), buffer.size());
      if (count < 0 && errno == EINTR)
        continue;
      if (count <= 0)
      {
        ends[i].fd = -1;
        continue;
      }
      (i == 0 ? answer.out : answer.err).append(buffer.data(), static_cast<std::size_t>(count));
      if (answer.out.size() > limits.out || answer.err.size() > limits.err)
      {
        answer.too_long = true;
        return answer;
      }
    }
  }
  return answer;
}
}  // namespace

ChildAnswer runChild(const std::string& what, const std::vector<std::string>& command, const ChildLimits& limits)
{
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits.seconds));
  Pipe out(what);
  Pipe err(what);
  Child child(what, command, out, err);
  out.closeWriteEnd();
  err.closeWriteEnd();
  ChildAnswer answer = readAnswer(out, err, end, limits);
  if (!answer.late && !answer.too_long)
    answer.late = !child.endsBy(end);  // the child may close its pipes and run on
  if (answer.late || answer.too_long)
    child.kill();
  const std::optional<int> status = child.wait();
  answer.has_status = status.has_value();
  answer.status = status.value_or(0);
  return answer;
}
}  // namespace gpu_planning_scene::core
