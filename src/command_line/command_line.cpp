#include "command_line/command_line.h"

#include <algorithm>
#include <iostream>
#include <new>

#include "base/text/parse_number.h"

namespace gpu_planning_scene::core
{
namespace
{
std::string helpText(const Tool& tool, const std::vector<Option>& options)
{
  std::string text = "usage: " + tool.name + " " + tool.synopsis + "\n\n" + tool.description + "\n\noptions:\n";
  for (const Option& option : options)
  {
    std::string line = "  " + option.name + (option.argument.empty() ? "" : " " + option.argument);
    constexpr std::size_t kHelpColumn = 30;
    if (line.size() + 2 > kHelpColumn)
      line += "\n" + std::string(kHelpColumn, ' ');
    else
      line.resize(kHelpColumn, ' ');
    for (const char c : option.help)
      line += c == '\n' ? "\n" + std::string(kHelpColumn, ' ') : std::string(1, c);
    text += line + "\n";
  }
  return text;
}
}  // namespace

CommandLine::CommandLine(const std::vector<Option>& options, int argc, const char* const* argv)
{
  for (int i = 1; i < argc; ++i)
  {
    const std::string word = argv[i];
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const auto option = std::find_if(options.begin(), options.end(), [&](const Option& o) { return o.name == name; });
    if (option == options.end())
      throw UsageError((word[0] == '-' ? "unknown option '" : "unexpected argument '") + word + "'; see --help");
    if (has(name) && !option->repeatable)
      throw UsageError(name + " is given twice");
    if (option->argument.empty())
    {
      if (equals != std::string::npos)
        throw UsageError(name + " takes no value");
      values_[name];
      continue;
    }
    if (equals == std::string::npos && ++i == argc)
      throw UsageError(name + " needs a value: " + option->argument);
    values_[name].push_back(equals == std::string::npos ? argv[i] : word.substr(equals + 1));
  }
}

const std::string& CommandLine::required(const std::string& name) const
{
  if (!has(name))
    throw UsageError(name + " is missing; see --help");
  return values_.at(name).front();
}

std::string CommandLine::value(const std::string& name, const std::string& fallback) const
{
  return has(name) ? values_.at(name).front() : fallback;
}

std::vector<std::string> CommandLine::values(const std::string& name) const
{
  return has(name) ? values_.at(name) : std::vector<std::string>();
}

long long CommandLine::integer(const std::string& name, long long fallback, long long min, long long max) const
{
  if (!has(name))
    return fallback;
  const auto result = parseInteger(required(name));
  if (!result || *result < min || *result > max)
    throw UsageError(name + ": '" + required(name) + "' is not an integer from " + std::to_string(min) + " to " +
                     std::to_string(max));
  return *result;
}

std::size_t CommandLine::count(const std::string& name, std::size_t fallback, std::size_t min, std::size_t max) const
{
  return static_cast<std::size_t>(
      integer(name, static_cast<long long>(fallback), static_cast<long long>(min), static_cast<long long>(max)));
}

double CommandLine::number(const std::string& name, double fallback, double min, double max) const
{
  if (!has(name))
    return fallback;
  const auto result = parseNumber(required(name));
  if (!result || !(*result >= min && *result <= max))
    throw UsageError(name + ": '" + required(name) + "' is not a number from " + std::to_string(min) + " to " +
                     std::to_string(max));
  return *result;
}

int runTool(const Tool& tool, int argc, const char* const* argv)
{
  std::vector<Option> options = tool.options;
  options.push_back({"--help", "", "print this text"});
  options.push_back({"--version", "", "print the version"});
  try
  {
    const CommandLine arguments(options, argc, argv);
    if (arguments.has("--help"))
      std::cout << helpText(tool, options);
    else if (arguments.has("--version"))
      std::cout << tool.name << " " GPS_VERSION "\n";
    else
      tool.run(arguments);
    if (!std::cout.flush())
      throw Error("cannot write to the standard output");
    return 0;
  }
  catch (const UsageError& error)
  {
    std::cerr << tool.name << ": " << error.what() << "\n";
    return 2;
  }
  catch (const std::bad_alloc&)
  {
    std::cerr << tool.name << ": out of memory\n";
    return 1;
  }
  catch (const std::exception& error)
  {
    std::cerr << tool.name << ": " << error.what() << "\n";
    return 1;
  }
}
}  // namespace gpu_planning_scene::core
