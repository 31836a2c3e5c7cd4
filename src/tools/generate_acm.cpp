// generate_acm: finds the pairs of links that need not be checked, and writes them into an SRDF.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <limits>
#include <sstream>

#include "base/text/name_list.h"
#include "collision/report/scene_text.h"
#include "command_line/robot_arguments.h"
#include "model/description/description_file.h"
#include "tools/acm_generator.h"
#include "tools/srdf_writer.h"

namespace gpu_planning_scene::core
{
namespace
{
std::vector<Option> options()
{
  std::vector<Option> all = {{"--urdf", "FILE", "the robot"},
                             {"--srdf", "FILE",
                              "an SRDF to start from: its groups and the user's own entries are\nkept, and the pairs "
                              "that it checks stay checked"}};
  for (const Option& option : robotOptions())
    if (option.name != "--urdf" && option.name != "--srdf")
      all.push_back(option);
  all.push_back({"--drop-checked", "", "with --srdf: also disable pairs that this SRDF checks"});
  all.push_back({"--samples", "N", "random states, at least 100 (default 10000)"});
  all.push_back({"--seed", "S", "seed of the random states (default 0)"});
  all.push_back(
      {"--always-share", "P", "pairs that collide in at least this share of the states\nare Always (default 0.95)"});
  all.push_back({"--proof-tests", "N",
                 "to prove that a pair never collides, test at most so many boxes of\njoint values (default 100000)"});
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

/// The file `srdf` exists, and the tool would replace it.
void requireSameRobot(const std::string& urdf, const std::string& srdf,
                      const std::map<std::string, std::string>& packages)
{
  const std::string robot = robotNameOf(readDescription(urdf, "URDF", packages, {}).text);
  if (robotNameOf(readDescription(srdf, "SRDF", packages, {}).text) != robot)
    throw Error(srdf + ": the file exists and is not an SRDF of robot '" + robot + "'; choose another name");
}

std::string nameOf(const DisabledPair& pair)
{
  std::string text = nameOf(pair.reason);
  if (pair.reason == DisabledReason::Never)
    text += pair.proof == NeverProof::Reach ? ", proven by their reach" : ", proven by the ranges of their joints";
  return text;
}

std::string percent(double share)
{
  std::ostringstream text;
  text.precision(share < 0.995 ? 2 : 3);
  text << 100.0 * share << " %";
  return text.str();
}

/// What the SRDF, from which the tool started, decides otherwise.
void printChanges(const RobotModel& robot, const GeneratedMatrix& matrix, bool drop_checked)
{
  const auto names = [&robot](int first, int second)
  {
    return "  " + robot.links()[static_cast<std::size_t>(first)].name + " - " +
           robot.links()[static_cast<std::size_t>(second)].name;
  };
  if (!matrix.checked_by_srdf.empty())
    std::cerr << (drop_checked ? "disabled, although the SRDF checks them:\n"
                               : "the SRDF checks these pairs, so they stay checked; --drop-checked disables them:\n");
  for (const DisabledPair& pair : matrix.checked_by_srdf)
    std::cerr << names(pair.first, pair.second) << ": " << nameOf(pair) << "\n";
  std::size_t without_collision = 0;
  for (const CheckedLinks& pair : matrix.no_longer_disabled)
    without_collision += pair.colliding_share == 0.0 ? 1 : 0;
  if (without_collision < matrix.no_longer_disabled.size())
    std::cerr << "the SRDF disables these pairs, but they can collide, so they are checked now:\n";
  for (const CheckedLinks& pair : matrix.no_longer_disabled)
    if (pair.colliding_share > 0.0)
      std::cerr << names(pair.first, pair.second) << ": " << percent(pair.colliding_share) << " of " << pair.states
                << " random states\n";
  if (without_collision != 0)
    std::cerr << counted(without_collision, "other pair")
              << " that the SRDF disables: checked now, because no proof was found that they never collide\n";
}

void printWarningsOf(const RobotModel& robot, const GeneratedMatrix& matrix)
{
  if (!matrix.colliding_in_default_state.empty())
    std::cerr << "warning: these pairs collide in the default state, and in a part of the random states, so they stay "
                 "checked. For pairs that may collide, add their lines to the SRDF:\n";
  for (const CheckedLinks& pair : matrix.colliding_in_default_state)
    std::cerr << "  <disable_collisions link1=\"" << robot.links()[static_cast<std::size_t>(pair.first)].name
              << "\" link2=\"" << robot.links()[static_cast<std::size_t>(pair.second)].name << "\" reason=\"User\"/>  "
              << percent(pair.colliding_share) << " of " << pair.states << " random states\n";
  for (const DisabledPair& pair : matrix.disabled)
    if (pair.free_share > 0.0 && (pair.reason == DisabledReason::Default || pair.reason == DisabledReason::Always))
      std::cerr << "warning: '" << robot.links()[static_cast<std::size_t>(pair.first)].name << "' and '"
                << robot.links()[static_cast<std::size_t>(pair.second)].name << "' are disabled as "
                << nameOf(pair.reason) << ", but they are free in " << percent(pair.free_share)
                << " of many random states. If they must not collide, add an enable_collisions entry, or give a larger "
                   "--always-share\n";
}

/// `groups`: the names of the planning groups in the SRDF.
void printSummary(const GeneratedMatrix& matrix, const GeneratorOptions& options,
                  const std::vector<std::string>& groups)
{
  std::cerr << counted(options.samples, "random state") << ", seed " << options.seed << "\ndisabled pairs of links: ";
  for (const DisabledReason reason :
       {DisabledReason::Adjacent, DisabledReason::Default, DisabledReason::Always, DisabledReason::Never})
    std::cerr << (reason == DisabledReason::Adjacent ? "" : ", ")
              << std::count_if(matrix.disabled.begin(), matrix.disabled.end(),
                               [&](const DisabledPair& pair) { return pair.reason == reason; })
              << " " << nameOf(reason);
  std::cerr << "\npairs that remain to be checked: " << matrix.remaining_pairs;
  if (!matrix.unproven.empty())
    std::cerr << "; " << matrix.unproven.size() << " of them collide in no random state, which proves nothing";
  std::cerr << "\nplanning groups: " << (groups.empty() ? "none" : nameList(groups)) << "\n";
}

void run(const CommandLine& arguments)
{
  arguments.required("--urdf");
  GeneratorOptions generator;
  generator.samples = arguments.count("--samples", generator.samples, 100, 1000000000);
  generator.seed = arguments.count("--seed", 0, 0, std::numeric_limits<long long>::max());
  generator.always_share = arguments.number("--always-share", generator.always_share, 0.0, 1.0);
  generator.proof_tests = arguments.count("--proof-tests", generator.proof_tests, 0, 1000000000);
  generator.drop_checked = arguments.has("--drop-checked");

  const std::string out_path = arguments.value("--out", "");
  const bool goes_on = !arguments.has("--srdf") && !out_path.empty() && std::filesystem::exists(out_path);
  const std::string base_path = goes_on ? out_path : arguments.value("--srdf", "");
  if (!goes_on && out_path != base_path && std::filesystem::exists(out_path) &&
      readFile(out_path) != readFile(base_path))
    throw Error(out_path +
                ": the file exists and differs from the one given as --srdf; remove it, or choose another "
                "name");
  if (goes_on)
    requireSameRobot(arguments.required("--urdf"), out_path, packageFoldersFrom(arguments));
  std::vector<std::string> warnings;
  const auto robot = robotFrom(arguments, base_path, &warnings);
  printWarnings(warnings);
  const std::string base = baseOf(base_path, out_path, packageFoldersFrom(arguments));
  const GeneratedMatrix matrix = generateMatrix(robot, generator);
  const std::string srdf = srdfWith(matrix, *robot, generator, base);
  if (arguments.has("--out"))
  {
    std::ofstream file(out_path);
    if (!(file << srdf).flush())
      throw Error(out_path + ": cannot write the file");
  }
  else
  {
    std::cout << srdf;
  }
  printChanges(*robot, matrix, generator.drop_checked);
  printWarningsOf(*robot, matrix);
  printSummary(matrix, generator, groupNamesOf(srdf));
}
}  // namespace
}  // namespace gpu_planning_scene::core

int main(int argc, char** argv)
{
  using namespace gpu_planning_scene::core;
  const Tool tool{
      "generate_acm", "--urdf FILE [--srdf FILE] [--package NAME=DIR]... [options]",
      "Finds the pairs of a robot's links that need not be checked for collision, and writes them as\n"
      "disable_collisions of an SRDF, with one of the reasons of MoveIt's Setup Assistant:\n"
      "  Adjacent  one is the nearest link with shapes above the other, and at most one joint between\n"
      "            them moves\n"
      "  Default   they collide in the default state and in nearly all of many random states\n"
      "  Always    they collide in nearly all of the random states, but not in the default state\n"
      "  Never     a proof shows that they collide in no state within the joint limits\n"
      "The Setup Assistant also disables pairs that collide in no random state, and all pairs that collide\n"
      "in the default state. This tool keeps checking them, unless there is a reason as above. A pair that\n"
      "the SRDF given as --srdf checks stays checked, too; the tool lists it. Runs on the CPU, on all\n"
      "cores, in double precision.\n"
      "If there is no SRDF yet, or none with groups, it also writes planning groups: a chain from the root\n"
      "link to each tip, with the name of the tip.\n"
      "Exit code: 0 success, 2 bad usage, 1 any other error.",
      options(), run};
  return runTool(tool, argc, argv);
}
