#include "lanes/kernel_library.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <dlfcn.h>
#include <unistd.h>

namespace lanes
{
namespace
{
const std::string kFolder = GPS_SOURCE_DIR "/test/lanes/";
/// Without unique symbols, each library has variables of its own. The classes of numbers in arithmetic.h have many
/// small functions. Inlined and not exported, they take an eighth less time.
const std::string kCompile = GPS_LANES_COMPILER
    " -std=c++20 -O1 -finline-small-functions -fvisibility-inlines-hidden -w -fPIC -shared"
    " -fno-gnu-unique -I" GPS_SOURCE_DIR "/test ";

std::string contents(const std::string& file)
{
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// FNV-1a (G. Fowler, L. C. Noll, K.-P. Vo).
std::uint64_t hashOf(const std::string& text)
{
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char letter : text)
    hash = (hash ^ static_cast<unsigned char>(letter)) * 1099511628211ULL;
  return hash;
}

/// The definitions of a shader, and the first sentence of its comment.
std::string nameOf(const std::string& shader)
{
  std::istringstream lines(shader);
  std::string name;
  for (std::string line; std::getline(lines, line);)
    if (line.rfind("#define ", 0) == 0)
      name += line.substr(8) + ", ";
    else if (line.rfind("// ", 0) == 0)
      return name + line.substr(3, 60);
  return name + "a kernel";
}

void run(const std::string& command, const std::string& log)
{
  if (std::system((command + " > " + log + " 2>&1").c_str()) != 0)
    throw TranslationError("a shader does not become C++: " + command + "\n" + contents(log));
}
}  // namespace

Simulator::Program loadKernel(const std::string& shader)
{
  static const std::string sources = contents(kFolder + "kernel.h") + contents(kFolder + "arithmetic.h") +
                                     contents(kFolder + "host.h") + contents(kFolder + "glsl_to_cpp.py") + kCompile;
  const char* chosen = std::getenv("GPS_LANES_CACHE");
  const std::string cache = chosen ? chosen : GPS_LANES_CACHE;
  std::filesystem::create_directories(cache);
  char name[32];
  std::snprintf(name, sizeof(name), "/%016llx", static_cast<unsigned long long>(hashOf(shader + sources)));
  const std::string library = cache + name + ".so";
  if (!std::filesystem::exists(library))
  {
    const std::string work = cache + name + "." + std::to_string(getpid());
    // The preprocessor does not know #version.
    std::ofstream(work + ".comp") << shader.substr(shader.find('\n') + 1);
    run(GPS_LANES_COMPILER " -E -P -undef -x c " + work + ".comp -o " + work + ".glsl", work + ".log");
    run(GPS_LANES_PYTHON " " + kFolder + "glsl_to_cpp.py " + work + ".glsl " + work + ".cpp", work + ".log");
    run(kCompile + work + ".cpp -o " + work + ".so", work + ".log");
    std::filesystem::rename(work + ".so", library);
    for (const char* ending : {".comp", ".glsl", ".cpp", ".log"})
      std::filesystem::remove(work + ending);
  }
  void* const handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle)
    throw std::runtime_error(dlerror());
  Simulator::Program program;
  program.kernel = reinterpret_cast<Kernel* (*)()>(dlsym(handle, "lanesKernel"))();
  program.main = reinterpret_cast<void (*)()>(dlsym(handle, "lanesMain"));
  program.name = nameOf(shader);
  program.tests_arithmetic = shader.find("src/gpu/float_arithmetic.cpp checks them") != std::string::npos;
  return program;
}
}  // namespace lanes
