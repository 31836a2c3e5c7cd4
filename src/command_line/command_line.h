#pragma once

#include <map>
#include <string>
#include <vector>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
/// An error in the command line; the exit code is 2, not 1.
class UsageError : public Error
{
 public:
  using Error::Error;
};

struct Option
{
  std::string name;      ///< as typed, "--urdf"
  std::string argument;  ///< name of the value in --help; empty for a switch
  std::string help;
  bool repeatable = false;
};

/// Long options: `--name value` or `--name=value`.
class CommandLine
{
 public:
  /// Throws UsageError for an unknown option, a missing value, an option given twice, and an argument that is no
  /// option.
  CommandLine(const std::vector<Option>& options, int argc, const char* const* argv);

  bool has(const std::string& name) const { return values_.count(name) != 0; }
  /// Throws UsageError if it was not given.
  const std::string& required(const std::string& name) const;
  std::string value(const std::string& name, const std::string& fallback) const;
  std::vector<std::string> values(const std::string& name) const;
  /// Throws UsageError unless it is an integer from `min` to `max`.
  long long integer(const std::string& name, long long fallback, long long min, long long max) const;
  /// The same for an integer that is never negative. `max`: below 2^63.
  std::size_t count(const std::string& name, std::size_t fallback, std::size_t min, std::size_t max) const;
  /// Throws UsageError unless it is a number from `min` to `max`.
  double number(const std::string& name, double fallback, double min, double max) const;

 private:
  std::map<std::string, std::vector<std::string>> values_;
};

/// A command-line tool: its options, its help text and its work.
struct Tool
{
  std::string name;
  std::string synopsis;  ///< text after the name in the first line of --help
  std::string description;
  std::vector<Option> options;  ///< without --help and --version, which runTool adds
  void (*run)(const CommandLine& arguments);
};

/// The body of main(): handles --help, --version and errors. Returns 0 on success, 2 on bad usage, 1 on any other
/// error, with one line on stderr.
int runTool(const Tool& tool, int argc, const char* const* argv);
}  // namespace gpu_planning_scene::core
