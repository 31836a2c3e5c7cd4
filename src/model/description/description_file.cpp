#include "model/description/description_file.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

#include "base/text/one_line.h"
#include "base/text/utf8.h"
#include "gpu_planning_scene/error.h"
#include "model/description/xacro_packages.h"
#include "model/description/xml.h"
#include "model/description/xml_kind.h"
#include "model/files/child_process.h"
#include "model/files/open_file.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kMaxDescriptionBytes = std::size_t(256) << 20;
constexpr std::size_t kMaxXacroMessageBytes = std::size_t(1) << 20;

std::string readFile(const std::string& path, const std::string& kind)
{
  std::string text;
  try
  {
    std::ifstream file = openFile(path);
    text.assign(std::istreambuf_iterator<char>(file), {});
  }
  catch (const Error& error)
  {
    throw Error(kind + " " + error.what());
  }
  return xmlInUtf8(std::move(text));
}

/// Whether xacro must expand a text. Returns false for malformed XML: RobotModel reports the fault.
bool isXacroText(const std::string& text, const std::string& name)
{
  try
  {
    return needsXacro(XmlText(text, name, "robot"));
  }
  catch (const Error&)
  {
    return false;
  }
}

/// The path of a program in PATH; empty if there is none. Relative folders of PATH are passed over: a file in the
/// current folder must not be run by accident.
std::string programOnPath(const std::string& name)
{
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
  {
    std::error_code failure;
    std::string program = (std::filesystem::path(folder) / name).string();
    if (!folder.empty() && folder.front() == '/' && std::filesystem::is_regular_file(program, failure) &&
        access(program.c_str(), X_OK) == 0)
      return program;
  }
  return "";
}

std::string expanded(const std::string& program, const std::string& path, const std::string& kind,
                     const std::map<std::string, std::string>& folders,
                     const std::function<void(const std::string& line)>& info, double seconds)
{
  const std::string start = kind + " '" + path + "' is a xacro file: ";
  const std::string advice = "; expand it by hand, and give the result: xacro FILE [NAME:=VALUE] > expanded." +
                             std::string(kind == "SRDF" ? "srdf" : "urdf");
  const XacroPackages packages(folders);
  std::vector<std::string> command;
  if (!folders.empty())
    command = {"/usr/bin/env", "ROS_PACKAGE_PATH=" + packages.searchPath()};
  command.push_back(program);
  command.push_back(path.front() == '-' ? "./" + path : path);  // a hyphen would begin an option
  ChildAnswer answer = runChild("xacro", command, {seconds, kMaxDescriptionBytes, kMaxXacroMessageBytes});
  answer.out = packages.withGivenFolders(std::move(answer.out));
  answer.err = packages.withGivenFolders(std::move(answer.err));
  if (answer.late)
  {
    std::ostringstream limit;
    limit << seconds;
    throw Error(start + program + " takes longer than " + limit.str() + " s" + advice);
  }
  if (answer.too_long)
    throw Error(start + program + " printed more than " + std::to_string(kMaxDescriptionBytes) +
                " bytes, or messages of more than " + std::to_string(kMaxXacroMessageBytes) + " bytes" + advice);
  const std::string said = answer.err.substr(0, answer.err.find_last_not_of(" \t\r\n") + 1);
  const std::string messages = said.empty() ? "it printed no message" : shortLine(said);
  if (!answer.has_status)
    throw Error(start + program + " has ended, but " + kNoStatus);
  if (WIFSIGNALED(answer.status))
    throw Error(start + program + " crashed (signal " + std::to_string(WTERMSIG(answer.status)) + "): " + messages +
                advice);
  if (WEXITSTATUS(answer.status) != 0)
    throw Error(start + program + " failed with exit code " + std::to_string(WEXITSTATUS(answer.status)) + ": " +
                messages + advice);
  if (answer.out.empty())
    throw Error(start + program + " printed nothing: " + messages + advice);
  if (info)
    info(start + "it was expanded with its default arguments by " + program +
         (said.empty() ? "" : ", which says: " + messages));
  return answer.out;
}
}  // namespace

DescriptionText readDescription(const std::string& path, const std::string& kind,
                                const std::map<std::string, std::string>& packages,
                                const std::function<void(const std::string& line)>& info, double xacro_seconds)
{
  DescriptionText description{path, readFile(path, kind)};
  if (!isXacroText(description.text, path))
    return description;
  const std::string program = programOnPath("xacro");
  if (program.empty())
    return description;
  return {"xacro " + path, xmlInUtf8(expanded(program, path, kind, packages, info, xacro_seconds))};
}

RobotDescription readRobotDescription(const std::string& urdf_path, const std::string& srdf_path,
                                      const std::map<std::string, std::string>& packages,
                                      const std::function<void(const std::string& line)>& info)
{
  RobotDescription description;
  const std::filesystem::path folder = std::filesystem::path(urdf_path).parent_path();
  description.urdf_folder = folder.empty() ? "." : folder.string();
  description.urdf = readDescription(urdf_path, "URDF", packages, info);
  if (!srdf_path.empty())
    description.srdf = readDescription(srdf_path, "SRDF", packages, info);
  return description;
}
}  // namespace gpu_planning_scene::core
