#include "tools/run_program.h"

#include <array>
#include <cstdio>
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
}  // namespace

ProgramOutput runProgram(const std::string& path, const std::vector<std::string>& arguments)
{
  std::vector<char*> argv{const_cast<char*>(path.c_str())};
  for (const std::string& argument : arguments)
    argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  std::FILE* out = std::tmpfile();
  std::FILE* err = std::tmpfile();
  const pid_t child = out && err ? fork() : -1;
  if (child < 0)
    throw std::runtime_error("cannot run " + path);
  if (child == 0)
  {
    dup2(fileno(out), STDOUT_FILENO);
    dup2(fileno(err), STDERR_FILENO);
    execv(path.c_str(), argv.data());
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ProgramOutput output;
  output.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  output.out = contentOf(out);
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
