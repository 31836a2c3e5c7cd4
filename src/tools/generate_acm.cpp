// generate_acm: finds the pairs of links that need not be checked, and writes them into an SRDF.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <limits>

#include "collision/checkers/scene_text.h"
#include "command_line/robot_arguments.h"
#include "model/description/description_file.h"
#include "model/text/name_list.h"
#include "tools/acm_generator.h"
#include "tools/srdf_writer.h"

namespace gpu_planning_scene::core
{
namespace
{
std::vector<Option> options()
{
  std::vector<Option> all = {
      {"--urdf", "FILE", "the robot"},
      {"--srdf", "FILE", "an SRDF to start from: its groups and the user's own entries are kept"}};
  for (const Option& option : robotOptions())
    if (option.name != "--urdf" && option.name != "--srdf")
      all.push_back(option);
  all.push_back({"--samples", "N", "random states (default 10000)"});
  all.push_back({"--seed", "S", "seed of the random states (default 0)"});
  all.push_back(
      {"--always-share", "P", "pairs that collide in at least this share of the states\nare Always (default 0.95)"});
  all.push_back({"--out", "FILE",
                 "the SRDF to write (default: the standard output). If it exists and\n--srdf is not given, its "
                 "other content is kept"});
  return all;
}

std::string readFile(const std::string& path)
{
  std::ifstream file(path);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

/// The text of the SRDF `path`; empty if `path` is empty. robotFrom has already said that it ran xacro.
std::string baseOf(const std::string& path, const std::string& out_path,
                   const std::map<std::string, std::string>& packages)
{
  if (path.empty())
    return "";
  const DescriptionText srdf = readDescription(path, "SRDF", packages, {});
  std::error_code missing;  // equivalent() is false for a file that does not exist
  if (srdf.name != path && std::filesystem::equivalent(path, out_path, missing))
    throw Error(path + ": this is a xacro file, and the expanded SRDF would replace it; give another file as --out");
  return srdf.text;
}

/// `groups`: the names of the planning groups in the SRDF.
void printSummary(const RobotModel& robot, const GeneratedMatrix& matrix, const SamplingOptions& sampling,
                  const std::vector<std::string>& groups)
{
  for (const auto& [first, second] : matrix.colliding_in_default_state)
    std::cerr << "warning: in the default state, '" << robot.links()[first].name << "' and '"
              << robot.links()[second].name
              << "' collide, but in many random states they do not; so this pair stays checked. If it may collide, add "
                 "a disable_collisions entry with a reason of your own\n";
  std::cerr << counted(sampling.samples, "random state") << ", seed " << sampling.seed << "\ndisabled pairs of links: ";
  for (const DisabledReason reason :
       {DisabledReason::Adjacent, DisabledReason::Default, DisabledReason::Always, DisabledReason::Never})
    std::cerr << (reason == DisabledReason::Adjacent ? "" : ", ")
              << std::count_if(matrix.disabled.begin(), matrix.disabled.end(),
                               [&](const DisabledPair& pair) { return pair.reason == reason; })
              << " " << nameOf(reason);
  std::cerr << "\npairs that remain to be checked: " << matrix.remaining_pairs
            << "\nplanning groups: " << (groups.empty() ? "none" : nameList(groups)) << "\n";
}

void run(const CommandLine& arguments)
{
  arguments.required("--urdf");
  SamplingOptions sampling;
  sampling.samples = arguments.count("--samples", sampling.samples, 1, 1000000000);
  sampling.seed = arguments.count("--seed", 0, 0, std::numeric_limits<long long>::max());
  sampling.always_share = arguments.number("--always-share", sampling.always_share, 0.0, 1.0);

  std::vector<std::string> warnings;
  const auto robot = robotFrom(arguments, &warnings);
  printWarnings(warnings);
  const GeneratedMatrix matrix = generateMatrix(robot, sampling);
  const std::string out_path = arguments.value("--out", "");
  const bool goes_on = !arguments.has("--srdf") && !out_path.empty() && std::filesystem::exists(out_path);
  const std::string base =
      baseOf(goes_on ? out_path : arguments.value("--srdf", ""), out_path, packageFoldersFrom(arguments));
  if (goes_on && robotNameOf(base) != robot->name())
    throw Error(out_path + ": the file exists and is not an SRDF of robot '" + robot->name() +
                "'; choose another name");
  const std::string srdf = srdfWith(matrix, *robot, sampling, base);
  if (arguments.has("--out"))
  {
    const std::string& path = arguments.required("--out");
    if (arguments.has("--srdf") && path != arguments.required("--srdf") && std::filesystem::exists(path) &&
        readFile(path) != readFile(arguments.required("--srdf")))
      throw Error(path +
                  ": the file exists and differs from the one given as --srdf; remove it, or choose another name");
    std::ofstream file(path);
    if (!(file << srdf).flush())
      throw Error(path + ": cannot write the file");
  }
  else
  {
    std::cout << srdf;
  }
  printSummary(*robot, matrix, sampling, groupNamesOf(srdf));
}
}  // namespace
}  // namespace gpu_planning_scene::core

int main(int argc, char** argv)
{
  using namespace gpu_planning_scene::core;
  const Tool tool{
      "generate_acm", "--urdf FILE [--srdf FILE] [--package NAME=DIR]... [options]",
      "Finds the pairs of a robot's links that need not be checked for collision, as MoveIt's Setup\n"
      "Assistant does, and writes them as disable_collisions of an SRDF, with one of these reasons:\n"
      "  Adjacent  one is the nearest link with shapes above the other\n"
      "  Default   they collide in the default state and in nearly all of many random states\n"
      "  Always    they collide in nearly all of the random states, but not in the default state\n"
      "  Never     they collide in none of the random states\n"
      "The Setup Assistant disables all pairs that collide in the default state; this tool keeps checking\n"
      "those that can be apart, and warns with their names. Runs on the CPU, on all cores, in double\n"
      "precision.\n"
      "If there is no SRDF yet, or none with groups, it also writes planning groups: a chain from the root\n"
      "link to each tip, with the name of the tip.\n"
      "Exit code: 0 success, 2 bad usage, 1 any other error.",
      options(), run};
  return runTool(tool, argc, argv);
}
