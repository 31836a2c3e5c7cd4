// literature: the methods that the literature names, side by side, with one truth; see --help. Needs no ROS.

#include <algorithm>
#include <iostream>

#include "base/text/name_list.h"
#include "benchmark/csv_table.h"
#include "benchmark/machine.h"
#include "command_line/command_line.h"
#include "literature/experiment.h"
#include "literature/families.h"
#include "literature/libraries/library_methods.h"
#include "literature/models.h"
#include "word_options.h"

using namespace gpu_planning_scene::core;
using namespace gpu_planning_scene::core::literature;

namespace
{
const std::vector<std::string> kParts = {"families", "experiment"};
const std::vector<std::string> kProtocols = {"turning", "clearance"};
constexpr std::size_t kMostTriangles = 10000000;

std::vector<MethodInfo> allMethods()
{
  std::vector<MethodInfo> methods = ourMethods();
  const auto add = [&](const std::vector<MethodInfo>& others)
  { methods.insert(methods.end(), others.begin(), others.end()); };
  add(deviceMethods());
  add(treeMethods());
  add(imageSpaceMethods());
  add(convexMethods());
  add(libraryMethods());
  return methods;
}

/// Each image takes milliseconds without a GPU, so the runs leave out some resolutions.
bool leftOut(const MethodInfo& info, const CommandLine& arguments)
{
  const Scope most = arguments.has("--quick") ? Scope::Always : Scope::FullRun;
  return !arguments.has("--methods") && info.scope > most;
}

std::vector<MethodInfo> chosenMethods(const CommandLine& arguments)
{
  std::vector<std::string> names;
  for (const MethodInfo& method : allMethods())
    names.push_back(method.name);
  names = chosenWords(arguments, "--methods", names);
  std::vector<MethodInfo> methods;
  for (const MethodInfo& method : allMethods())
    if (std::find(names.begin(), names.end(), method.name) != names.end() && !leftOut(method, arguments))
      methods.push_back(method);
  return methods;
}

std::vector<std::size_t> chosenTriangles(const CommandLine& arguments)
{
  std::vector<std::size_t> counts;
  const std::string all = arguments.has("--quick") ? "1000" : "1000,10000,100000,1000000";
  for (const std::string& word : splitAtCommas(arguments.value("--triangles", all)))
    counts.push_back(CommandLine({{"--triangles", "N", ""}}, 3, std::array{"", "--triangles", word.c_str()}.data())
                         .count("--triangles", 0, 100, kMostTriangles));
  return counts;
}

/// Writes the conditions of the run.
void writeRun(const Settings& settings)
{
  benchmark::CsvTable table(settings.out, "run.csv", {"what", "value"});
  const benchmark::Machine machine("auto");
  machine.write(table);
  table.add({"seed", static_cast<std::size_t>(settings.seed)});
  table.add({"quick", settings.quick ? "yes" : "no"});
  std::cerr << machine.line() << std::endl;
  for (const std::string& line : missingLibraryMethods())
    std::cerr << line << std::endl;
}

void run(const CommandLine& arguments)
{
  Settings settings;
  settings.quick = arguments.has("--quick");
  settings.out = arguments.value("--out", "literature");
  settings.methods = chosenMethods(arguments);
  settings.models = chosenWords(arguments, "--models", madeModelNames());
  settings.fixed_models = !arguments.has("--models");
  settings.triangles = chosenTriangles(arguments);
  settings.protocols = chosenWords(arguments, "--protocols", kProtocols);
  settings.seconds = arguments.number("--seconds", 0.02, 0.001, 1e4);
  settings.contacts = arguments.count("--contacts", settings.quick ? 2 : 8, 1, 10000);
  settings.seed = arguments.count("--seed", 1, 0, 1ULL << 62);
  benchmark::makeTableFolder(settings.out);
  writeRun(settings);
  writeMethods(settings);
  std::size_t wrong = 0;
  for (const std::string& part : chosenWords(arguments, "--parts", kParts))
    wrong += part == "experiment" ? measureExperiment(settings) : judgeFamilies(settings);
  std::cout << settings.out << '\n';
  if (wrong > 0)
    throw Error(std::to_string(wrong) + " wrong answers of this package");
}
}  // namespace

int main(int argc, char** argv)
{
  return runTool(
      {"literature",
       "[--quick] [--out DIR] [--methods A,B] [--models A,B] [--triangles N,M] ...",
       "Measures collision tests of two rigid meshes from the literature, this package among them: time a query\n"
       "and wrong answers for two copies of a model at many distances (part experiment), and wrong answers in hard\n"
       "cases (part families). The truth is the oracle of the tests, in quadruple precision.\n"
       "Writes run.csv, methods.csv, builds.csv, experiment.csv, work.csv, families.csv and refusals.csv. Exit status "
       "1 if\n"
       "this package gives a wrong answer.",
       {{"--quick", "", "small models and few poses: under two minutes"},
        {"--out", "DIR", "folder for the tables (default literature)"},
        {"--parts", "A,B", "of " + nameList(kParts) + " (default: both)"},
        {"--methods", "A,B", "an unknown name prints the list (default: all, but few resolutions)"},
        {"--models", "A,B", "of " + nameList(madeModelNames()) + " (default: all, a box, and links of robots)"},
        {"--triangles", "N,M", "of each model (default 1000 to 1000000 in powers of ten; with --quick 1000)"},
        {"--protocols", "A,B", "of " + nameList(kProtocols) + " (default: both)"},
        {"--seconds", "S", "a method that takes longer at a distance gets fewer poses (default 0.02)"},
        {"--contacts", "N", "of each family of hard cases (default 8; with --quick 2)"},
        {"--seed", "N", "seed of models and poses (default 1)"}},
       run},
      argc, argv);
}
