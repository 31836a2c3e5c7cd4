#include "tools/run_program.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace gpu_planning_scene::core
{
namespace
{
std::string contentOf(std::FILE* file)
{
  std::rewind(file);
  std::string content;
  std::array<char, 4096> buffer;
  for (std::size_t count; (count = std::fread(buffer.data(), 1, buffer.size(), file)) > 0;)
    content.append(buffer.data(), count);
  std::fclose(file);
  return content;
}

/// Starts a program with these files as its output.
pid_t start(const std::string& path, const std::vector<std::string>& arguments, int out, int err)
{
  std::vector<char*> argv{const_cast<char*>(path.c_str())};
  for (const std::string& argument : arguments)
    argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child < 0)
    throw std::runtime_error("cannot run " + path);
  if (child > 0)
    return child;
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  execv(path.c_str(), argv.data());
  _exit(127);
}

int exitCodeOf(pid_t child)
{
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::FILE* temporaryFile()
{
  std::FILE* file = std::tmpfile();
  if (file == nullptr)
    throw std::runtime_error("cannot make a temporary file");
  return file;
}
}  // namespace

ProgramOutput runProgram(const std::string& path, const std::vector<std::string>& arguments)
{
  std::FILE* out = temporaryFile();
  std::FILE* err = temporaryFile();
  ProgramOutput output;
  output.exit_code = exitCodeOf(start(path, arguments, fileno(out), fileno(err)));
  output.out = contentOf(out);
  output.err = contentOf(err);
  return output;
}

ProgramOutput runOnTerminal(const std::string& path, const std::vector<std::string>& arguments)
{
  const int screen = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (screen < 0 || grantpt(screen) != 0 || unlockpt(screen) != 0)
    throw std::runtime_error("cannot make a terminal");
  const int terminal = open(ptsname(screen), O_RDWR | O_NOCTTY | O_CLOEXEC);
  std::FILE* err = temporaryFile();
  const pid_t child = start(path, arguments, terminal, fileno(err));
  close(terminal);
  ProgramOutput output;
  std::array<char, 4096> buffer;
  // At the end of the child, read() fails with EIO.
  for (ssize_t count; (count = read(screen, buffer.data(), buffer.size())) > 0;)
    output.out.append(buffer.data(), static_cast<std::size_t>(count));
  close(screen);
  output.exit_code = exitCodeOf(child);
  output.err = contentOf(err);
  return output;
}

std::vector<std::string> linesOf(const std::string& text)
{
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    lines.push_back(line);
  return lines;
}
}  // namespace gpu_planning_scene::core
