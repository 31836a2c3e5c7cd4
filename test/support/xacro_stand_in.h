#pragma once

#include <string>

#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
/// Sets PATH. The destructor sets the earlier value.
class PathVariable
{
 public:
  explicit PathVariable(const std::string& value);
  ~PathVariable();
  PathVariable(const PathVariable&) = delete;
  PathVariable& operator=(const PathVariable&) = delete;

 private:
  std::string before_;
};

/// A script with the name xacro, in a folder that comes first on PATH. Debian 12 has no package of xacro. The script
/// sees the path of the xacro file as "$1".
class XacroStandIn
{
 public:
  /// `script`: lines for /bin/sh.
  explicit XacroStandIn(const std::string& script);

  std::string program() const { return folder_.path("xacro"); }

 private:
  TemporaryFolder folder_;
  PathVariable path_;
};

/// A script that removes the elements of xacro and replaces ${height} by 2.
extern const char* const kExpandingXacro;
}  // namespace gpu_planning_scene::core
