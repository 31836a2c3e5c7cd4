#pragma once

#include <functional>
#include <map>
#include <string>

namespace gpu_planning_scene::core
{
/// The text of a URDF or SRDF file, in UTF-8.
struct DescriptionText
{
  std::string name;  ///< for messages: the path, or "xacro PATH" if xacro expanded the file
  std::string text;
};

/// Reads a URDF or SRDF file. If it is a xacro file, and the program xacro is in an absolute folder of the environment
/// variable PATH, this program expands it. Without it, the text is that of the file, and RobotModel refuses it.
/// `kind`: "URDF" or "SRDF". `packages`: folders of packages by their names; xacro's $(find NAME) finds these first.
/// `info` (may be empty) receives a line if xacro was run. A file that is not UTF-8 is read as ISO-8859-1. Throws Error
/// if the file cannot be read, and if xacro fails, prints nothing, or takes longer than `xacro_seconds`. Thread-safe.
DescriptionText readDescription(const std::string& path, const std::string& kind,
                                const std::map<std::string, std::string>& packages,
                                const std::function<void(const std::string& line)>& info, double xacro_seconds = 60.0);

/// The two files of a robot, each read once.
struct RobotDescription
{
  DescriptionText urdf;
  DescriptionText srdf;     ///< empty without an SRDF
  std::string urdf_folder;  ///< base folder of relative mesh paths
};

/// Reads both files as readDescription does. `srdf_path` may be empty.
RobotDescription readRobotDescription(const std::string& urdf_path, const std::string& srdf_path,
                                      const std::map<std::string, std::string>& packages,
                                      const std::function<void(const std::string& line)>& info);
}  // namespace gpu_planning_scene::core
