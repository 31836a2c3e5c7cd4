// check_states: checks many robot states for collision, on the command line.

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <limits>

#include <unistd.h>

#include "collision/checkers/open_checker.h"
#include "collision/report/scene_text.h"
#include "command_line/robot_arguments.h"
#include "command_line/scene_arguments.h"
#include "tools/progress_bar.h"
#include "tools/state_source.h"
#include "tools/state_table.h"

namespace gpu_planning_scene::core
{
namespace
{
std::vector<Option> options()
{
  std::vector<Option> all = robotOptions();
  for (const Option& option : sceneOptions())
    all.push_back(option);
  for (const Option& option : stateOptions())
    all.push_back(option);
  all.push_back({"--group", "NAME", "check only pairs with a link that this group moves"});
  for (const Option& option : deviceOptions())
    all.push_back(option);
  all.push_back({"--out", "FILE", "file for the answers (default: the standard output)"});
  all.push_back({"--save-states", "FILE", "file for the states, in the form that --states reads"});
  return all;
}

/// Finds wrong options before large files are read.
void checkUsage(const CommandLine& arguments)
{
  arguments.required("--urdf");
  packagesFrom(arguments);
  checkerOptionsFrom(arguments);
  checkStateUsage(arguments);
}

/// Fewer states get no rate, because most of their time is preparation.
constexpr std::size_t kFewestStatesWithRate = 100;

/// A terminal gets no more answers than it can show. The summary has the counts.
constexpr std::size_t kMostRowsOfTerminal = 30;

// So many states of a source are in memory at once.
constexpr std::size_t kStatesInMemory = 524'288;

BatchResult checkAll(StateChecker& checker, StateSource& source, const std::string& group)
{
  BatchResult all;
  all.valid.reserve(source.count());
  all.colliding.reserve(source.count());
  ProgressBar progress("checking", source.count());
  for (std::size_t begin = 0; begin < source.count(); begin += kStatesInMemory)
  {
    StateBatch batch{source.next(std::min(kStatesInMemory, source.count() - begin)),
                     std::min(kStatesInMemory, source.count() - begin), group};
    batch.go_on = [&](std::size_t answered)
    {
      progress.update(begin + answered);
      return true;
    };
    all.append(checker.checkBatch(batch));
    progress.update(all.valid.size());
  }
  return all;
}

/// Who decided the states of the result.
std::string workersText(const BatchResult& result, const std::string& device)
{
  const std::size_t decided_by_cpu = result.valid.size() - result.device_states;
  if (result.device_states == 0)
    return "CPU";
  return decided_by_cpu > result.undecided_states ? "CPU + " + device : device;
}

void writeAnswers(std::ostream& out, const BatchResult& result, const PlanningScene& scene)
{
  std::vector<std::string> names;
  const std::size_t bodies = scene.robot->links().size() + scene.objects.size() + scene.attached.size();
  for (std::size_t body = 0; body < bodies; ++body)
    names.push_back(csvCell(scene.bodyName(static_cast<int>(body))));
  out << "valid,body_1,body_2\n";
  for (std::size_t i = 0; i < result.valid.size(); ++i)
    if (result.valid[i])
      out << "1,,\n";
    else
      out << "0," << names[result.colliding[i][0]] << ',' << names[result.colliding[i][1]] << '\n';
}

void writeStates(const std::string& path, StateSource& source, const RobotModel& robot)
{
  std::ofstream file(path);
  file.precision(std::numeric_limits<double>::max_digits10);
  const std::size_t width = robot.variables().size();
  for (std::size_t v = 0; v < width; ++v)
    file << (v == 0 ? "" : ",") << csvCell(robot.variables()[v].name);
  file << '\n';
  for (std::size_t i = 0; i < source.count(); ++i)
  {
    const double* state = source.next(1);
    for (std::size_t v = 0; v < width; ++v)
      file << (v == 0 ? "" : ",") << state[v];
    file << '\n';
  }
  if (!file.flush())
    throw Error(path + ": cannot write the file");
}

std::size_t countValid(const BatchResult& result)
{
  return static_cast<std::size_t>(std::count(result.valid.begin(), result.valid.end(), 1));
}

void printSummary(const PlanningScene& scene, const SceneReport& report, const StateSource& source,
                  const BatchResult& result, const std::string& device)
{
  const std::size_t count = source.count();
  const std::size_t valid = countValid(result);
  char line[128];
  for (const std::string& text : describeScene(scene, report, device))
    std::cerr << text << "\n";
  std::cerr << "states: " << source.text() << "\n";
  std::snprintf(line, sizeof line, " (%.1f %%)\n", 100.0 * static_cast<double>(valid) / static_cast<double>(count));
  std::cerr << "valid: " << valid << " of " << counted(count, "state") << line;
  if (result.undecided_states != 0)
    std::cerr << "decided by the exact checker: " << counted(result.undecided_states, "state") << "\n";
  PairCounts pairs;
  pairs.add(result);
  for (const std::string& text : pairs.describe(scene, 5))
    std::cerr << text << "\n";
  std::cerr << counted(count, "state") << ", " << valid << " valid, ";
  if (count >= kFewestStatesWithRate)
  {
    std::snprintf(line, sizeof line, "%.0f states/s, ", static_cast<double>(count) / std::max(result.seconds, 1e-9));
    std::cerr << line;
  }
  std::cerr << workersText(result, device) << "\n";
}

void run(const CommandLine& arguments)
{
  checkUsage(arguments);
  std::vector<std::string> warnings;
  const auto scene = std::make_shared<const PlanningScene>(sceneFrom(arguments, &warnings));
  printWarnings(warnings);
  const std::string group = arguments.value("--group", "");
  if (!group.empty())
    scene->robot->group(group);
  const auto source = stateSourceFrom(arguments, *scene);
  if (const std::string warning = source->warning(); !warning.empty())
    printWarnings({warning});
  // The same source gives the same states again.
  if (arguments.has("--save-states"))
    writeStates(arguments.required("--save-states"), *stateSourceFrom(arguments, *scene), *scene->robot);
  const std::string out_path = arguments.value("--out", "");
  std::ofstream out_file;
  if (!out_path.empty())
  {
    out_file.open(out_path, std::ios::app);  // find out before the work whether the file is writable; keep its content
    if (!out_file)
      throw Error(out_path + ": cannot write the file");
  }

  const BatchCheckerOptions options = checkerOptionsFrom(arguments);
  const auto checker = openChecker(scene, options, [](const std::string& warning) { printWarnings({warning}); });
  const std::string at_start = checker->deviceWarning();
  if (!at_start.empty())
    std::cerr << "warning: " << at_start << "\n";
  const BatchResult result = checkAll(*checker, *source, group);
  if (const std::string warning = checker->deviceWarning(); warning != at_start)
    std::cerr << "warning: " << warning << "\n";

  if (out_path.empty() && isatty(STDOUT_FILENO) != 0 && source->count() > kMostRowsOfTerminal)
  {
    std::cerr << "answers: " << counted(source->count(), "row") << ", not printed to the terminal; give --out FILE, or "
              << "redirect the output\n";
  }
  else if (out_path.empty())
  {
    writeAnswers(std::cout, result, *scene);
  }
  else
  {
    out_file.close();
    out_file.open(out_path, std::ios::trunc);
    writeAnswers(out_file, result, *scene);
    if (!out_file.flush())
      throw Error(out_path + ": writing the file failed");
  }
  std::cout.flush();
  const SceneReport report = checker->report(group);
  printWarnings(warningsOfScene(*scene, report));
  printSummary(*scene, report, *source, result, checker->deviceName());
}
}  // namespace
}  // namespace gpu_planning_scene::core

int main(int argc, char** argv)
{
  using namespace gpu_planning_scene::core;
  const Tool tool{"check_states",
                  "--urdf FILE [--srdf FILE] [--package NAME=DIR]... [--scene FILE] [--object ID=FILE]...\n"
                  "                    (--states FILE.csv | --state ready | --random N [--seed S]) [options]",
                  "Checks which states of a robot are free of collision. Answers in CSV: the header\n"
                  "valid,body_1,body_2, then one line per state: 1 and two empty names, or 0 and a pair of\n"
                  "bodies that collide.\n"
                  "More than 30 answers are not printed to a terminal, only to a file or a pipe.\n"
                  "A summary goes to the standard error; its last line is\n"
                  "  N states, V valid, R states/s, DEVICE\n"
                  "For fewer than 100 states, 'R states/s' is left out, because most of the time is preparation.\n"
                  "DEVICE is CPU, the device, or both: those that checked the states.\n"
                  "Exit code: 0 success, 2 bad usage, 1 any other error.",
                  options(), run};
  return runTool(tool, argc, argv);
}
