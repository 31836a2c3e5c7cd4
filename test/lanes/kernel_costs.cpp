// kernel_costs write FOLDER: writes each compute shader that the program gives to OpenGL to a file in FOLDER, with its
// definitions in the file name, and the kinematics of each real robot that is there.
// kernel_costs compile FILE...: compiles these files on the device that `auto` takes. Prints one line for each file:
// its name, the seconds of processor time to compile it, and the messages of the driver, separated by tabs. Mesa's
// drivers report instructions, registers and spills of each shader in messages to a debug context. Nothing runs on the
// device.

#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include <epoxy/gl.h>

#include "collision/gpu/problem/gpu_kinematics.h"
#include "gpu/egl_context.h"
#include "gpu/program.h"
#include "gpu_planning_scene/error.h"
#include "lanes/compute_shaders.h"
#include "lanes/gl_device.h"
#include "model/real_robots.h"

using namespace gpu_planning_scene::core;

namespace
{
const std::string kShaders = GPS_SOURCE_DIR "/shaders";
const std::string kVersion = "#version 450\n";

void write(const std::string& folder, const std::string& name, const std::string& text)
{
  std::ofstream file(folder + "/" + name + ".comp");
  if (!(file << text))
    throw Error("cannot write to " + folder);
}

/// "A=1,B=2" for the lines "#define A 1" and "#define B 2".
std::string shortened(const std::string& definitions)
{
  std::istringstream lines(definitions);
  std::string all;
  std::string define, name, value;
  while (lines >> define >> name && std::getline(lines, value))
    all += (all.empty() ? "" : ",") + name + "=" + value.substr(std::min<std::size_t>(1, value.size()));
  return all;
}

void writeShaders(const std::string& folder)
{
  std::filesystem::create_directories(folder);
  std::map<std::string, std::string> files;  // text without the version and the definitions -> name
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kShaders))
    if (entry.path().extension() == ".comp")
    {
      const std::string name = std::filesystem::relative(entry.path(), kShaders).string();
      files[readShader(kShaders, name)] = entry.path().stem().string();
    }
  for (const std::string& text : computeShaders(kShaders))
    for (const auto& [body, name] : files)
      if (text.size() >= kVersion.size() + body.size() &&
          text.compare(text.size() - body.size(), body.size(), body) == 0)
      {
        const std::string definitions =
            shortened(text.substr(kVersion.size(), text.size() - body.size() - kVersion.size()));
        write(folder, definitions.empty() ? name : name + " " + definitions, text);
      }
  for (const RealRobot& robot : realRobots())
  {
    const GpuKinematics kinematics(kShaders, robot.load());
    write(folder, "kinematics " + robot.name, lanes::compiledShaders().back());
  }
}

void GLAPIENTRY append(GLenum /*source*/, GLenum /*type*/, GLuint /*id*/, GLenum /*severity*/, GLsizei length,
                       const GLchar* text, const void* messages)
{
  std::string line(text, static_cast<std::size_t>(length));
  while (!line.empty() && line.back() == '\n')
    line.pop_back();
  *static_cast<std::string*>(const_cast<void*>(messages)) += "\t" + line;
}

/// Returns whether the shader compiles and links.
bool compile(const std::string& file)
{
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  std::string messages;
  glDebugMessageCallback(append, &messages);
  const std::clock_t start = std::clock();
  const std::string source = text.str();
  const char* const sources = source.c_str();
  const GLuint program = glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &sources);
  GLint good = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  // Some drivers generate code only when a program is used. The device executes nothing.
  if (good)
  {
    glUseProgram(program);
    glDispatchCompute(1, 1, 1);
    glFinish();
  }
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  if (!good)
  {
    std::string log(10000, '\0');
    GLsizei length = 0;
    glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), &length, log.data());
    messages += "\tfailed: " + log.substr(0, static_cast<std::size_t>(length));
  }
  std::cout << std::filesystem::path(file).stem().string() << "\t" << seconds << messages << std::endl;
  glDeleteProgram(program);
  return good != 0;
}
}  // namespace

int main(int argc, char** argv)
{
  try
  {
    const std::string mode = argc > 2 ? argv[1] : "";
    if (mode == "write" && argc == 3)
    {
      writeShaders(argv[2]);
      return EXIT_SUCCESS;
    }
    if (mode != "compile")
      throw Error("usage: kernel_costs write FOLDER, or kernel_costs compile FILE...");
    setenv("GPU_PLANNING_SCENE_GL_DEBUG", "log", 1);
    const EglContext context("auto");
    std::cerr << context.device().renderer << ", OpenGL " << context.device().version << std::endl;
    bool good = true;
    for (int i = 2; i < argc; ++i)
      good = compile(argv[i]) && good;
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
  }
  catch (const std::exception& error)
  {
    std::cerr << "kernel_costs: " << error.what() << std::endl;
    return EXIT_FAILURE;
  }
}
