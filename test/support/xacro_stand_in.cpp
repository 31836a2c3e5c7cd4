#include "support/xacro_stand_in.h"

#include <cstdlib>
#include <filesystem>

namespace gpu_planning_scene::core
{
namespace
{
std::string pathVariable()
{
  const char* path = std::getenv("PATH");
  return path == nullptr ? "" : path;
}
}  // namespace

const char* const kExpandingXacro = R"(sed -e 's/<xacro:[^>]*>//' -e 's/${height}/2/' "$1")";

PathVariable::PathVariable(const std::string& value) : before_(pathVariable())
{
  setenv("PATH", value.c_str(), 1);
}

PathVariable::~PathVariable()
{
  setenv("PATH", before_.c_str(), 1);
}

XacroStandIn::XacroStandIn(const std::string& script) : path_(folder_.path("") + ":" + pathVariable())
{
  folder_.write("xacro", "#!/bin/sh\n" + script + "\n");
  std::filesystem::permissions(program(), std::filesystem::perms::owner_all);
}
}  // namespace gpu_planning_scene::core
