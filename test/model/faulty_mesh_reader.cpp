// A mesh reader that replaces read_mesh and fails. The name of the mesh file selects the failure.

#include <csignal>
#include <cstdio>
#include <string>

#include <unistd.h>

int main(int, char** argv)
{
  const std::string path = argv[1];
  const std::string fault = path.substr(path.rfind('/') + 1);
  if (fault == "crash.stl")
  {
    signal(SIGSEGV, SIG_DFL);
    raise(SIGSEGV);
  }
  if (fault == "hang.stl")
    pause();
  if (fault == "linger.stl")
  {
    close(STDOUT_FILENO);
    close(STDERR_FILENO);
    sleep(20);
  }
  if (fault == "babble.stl")
    while (std::fwrite(argv[0], 1, 4, stdout) == 4)
    {
    }
  if (fault == "complain.stl")
    while (std::fputs("no\n", stderr) >= 0)
    {
    }
  if (fault == "lie.stl")  // 2^62 triangles, which overflow when they are multiplied
    std::fwrite("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x40", 1, 16, stdout);
  if (fault == "short.stl")
    std::fwrite("\1\0\0", 1, 3, stdout);
  return fault == "exit.stl" ? 42 : 0;
}
