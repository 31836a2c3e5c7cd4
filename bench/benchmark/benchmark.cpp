// benchmark: speed and accuracy of the project's methods and of its peers; see --help. Needs no ROS.
//
// Robots and scenes from outside the project are read from one folder: --data DIR, or the environment variable
// GPU_PLANNING_SCENE_DATA, or the folders of the build (GPS_DART_DATA_DIR, GPS_SHARED_DIR). This folder contains
//   urdf/KR5, urdf/wam, urdf/drchubo                        as in data/ of Debian's package dart-doc
//   robots/ur5_robotiq, problems/ur5/SET/scene0001.yaml and request0001.yaml   as in ../shared
// If a robot or problem is missing, the program leaves out its scenes and reports this. The scenes arm_boxes and
// arm_shelf need no files: test/support/generated_arm generates their robot.

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "base/text/name_list.h"
#include "benchmark/csv_table.h"
#include "benchmark/machine.h"
#include "benchmark/settings.h"
#include "benchmark/state_kinds.h"
#include "benchmark/statistics.h"
#include "command_line/command_line.h"
#include "model/real_robots.h"
#include "peers/vamp/vamp_check.h"
#include "support/test_scenes.h"
#include "word_options.h"

using namespace gpu_planning_scene::core;
using namespace gpu_planning_scene::core::benchmark;

namespace
{
const std::vector<std::string> kParts = {"build",  "latency", "throughput", "stages", "updates",
                                         "growth", "meshes",  "distances",  "kernels"};
const std::vector<std::string> kQuickScenes = {"kr5_boxes", "ur5_cage", "arm_boxes", "arm_shelf"};
constexpr std::size_t kQuickSceneCount = 2;

std::vector<double> numbers(const CommandLine& arguments, const std::string& option, const std::string& fallback,
                            double min, double max)
{
  std::vector<double> result;
  for (const std::string& word : splitAtCommas(arguments.value(option, fallback)))
    result.push_back(CommandLine({{option, "X", ""}}, 3, std::array{"", option.c_str(), word.c_str()}.data())
                         .number(option, 0.0, min, max));
  return result;
}

/// The scenes that can be loaded. Throws Error if a scene named with --scenes is missing.
std::vector<std::string> chosenScenes(const CommandLine& arguments)
{
  const bool named = arguments.has("--scenes");
  std::vector<std::string> names = chosenWords(arguments, "--scenes", benchmarkSceneNames());
  if (!named && arguments.has("--quick"))
    names = kQuickScenes;
  std::vector<std::string> there;
  for (const std::string& name : names)
  {
    const std::string missing = missingFor(name);
    if (named && !missing.empty())
      throw Error("scene " + name + " needs " + missing + ", which is missing; give its folder with --data");
    if (!missing.empty())
      std::cerr << "scene " << name << " is left out, because it needs " << missing << '\n';
    else
      there.push_back(name);
  }
  if (!named && arguments.has("--quick"))
    there.resize(std::min(there.size(), kQuickSceneCount));
  return there;
}

/// Throws Error if --methods names a method that cannot be used here.
std::vector<MethodInfo> chosenMethods(const CommandLine& arguments)
{
  const std::vector<MethodInfo> all = allMethods();
  std::vector<std::string> names;
  if (const std::string reason = whyNoVamp(); !reason.empty())
  {
    const std::vector<std::string> named = splitAtCommas(arguments.value("--methods", ""));
    if (std::find(named.begin(), named.end(), kVampMethod) != named.end())
      throw Error(std::string("--methods: there is no ") + kVampMethod + " here: " + reason);
    if (named.empty())
      std::cerr << "method " << kVampMethod << " is left out: " << reason << '\n';
  }
  for (const MethodInfo& method : all)
    names.push_back(method.name);
  for (const MethodInfo& method : all)
    if (std::find(names.begin(), names.end(), method.family) == names.end())
      names.push_back(method.family);
  names = chosenWords(arguments, "--methods", names);
  const auto chosen = [&](const std::string& name)
  { return std::find(names.begin(), names.end(), name) != names.end(); };
  std::vector<MethodInfo> methods;
  for (const MethodInfo& method : all)
    if ((chosen(method.name) || chosen(method.family)) &&
        (method.in_quick_run || arguments.has("--methods") || !arguments.has("--quick")))
      methods.push_back(method);
  return methods;
}

Settings readSettings(const CommandLine& arguments)
{
  Settings settings;
  settings.quick = arguments.has("--quick");
  settings.out = arguments.value("--out", "benchmark");
  settings.method.device = arguments.value("--device", "auto");
  settings.method.max_batch = arguments.count("--max-batch", 0, 0, 1 << 24);
  settings.states = arguments.count("--states", settings.quick ? 256 : 16384, 16, 1 << 30);
  settings.repeats = arguments.count("--repeats", settings.quick ? 2 : 5, 1, 1000);
  settings.seconds = arguments.number("--seconds", settings.quick ? 0.03 : 0.5, 0.001, 1e4);
  settings.seed = arguments.count("--seed", 1, 0, 1ULL << 62);
  settings.paddings = numbers(arguments, "--padding", settings.quick ? "0" : "0,0.01", 0.0, 1.0);
  for (const double batch : numbers(arguments, "--batches", settings.quick ? "256" : "1024,16384", 1.0, 1e8))
    settings.batches.push_back(static_cast<std::size_t>(batch));
  settings.kinds = chosenWords(arguments, "--kinds", stateKinds());
  if (settings.quick && !arguments.has("--kinds"))
    settings.kinds = {"random", "near_contact"};
  settings.methods = chosenMethods(arguments);
  settings.scenes = chosenScenes(arguments);
  return settings;
}

/// Writes the conditions of the run: device, processor, and settings.
void writeRun(const Settings& settings)
{
  CsvTable table(settings.out, "run.csv", {"what", "value"});
  const Machine machine(settings.method.device);
  machine.write(table);
  table.add({"states", settings.states});
  table.add({"repeats", settings.repeats});
  table.add({"seed", static_cast<std::size_t>(settings.seed)});
  table.add({"quick", settings.quick ? "yes" : "no"});
  std::cerr << machine.line() << "\nscenes: " << nameList(settings.scenes) << std::endl;
}

void run(const CommandLine& arguments)
{
  if (arguments.has("--data"))
  {
    if (!std::filesystem::is_directory(arguments.required("--data")))
      throw Error("--data: there is no folder " + arguments.required("--data"));
    useDataFolder(std::filesystem::absolute(arguments.required("--data")).lexically_normal().string());
  }
  const std::vector<std::string> parts = chosenWords(arguments, "--parts", kParts);
  const Settings settings = readSettings(arguments);
  makeTableFolder(settings.out);
  writeRun(settings);

  std::size_t wrong = 0;
  for (const std::string& part : parts)
  {
    const double seconds = secondsOf(
        [&]
        {
          if (part == "throughput")
            wrong += measureThroughput(settings);
          else if (part == "stages")
            wrong += measureStages(settings);
          else if (part == "kernels")
            wrong += measureKernels(settings);
          else if (part == "latency")
            wrong += measureLatency(settings);
          else if (part == "build")
            wrong += measureBuilds(settings);
          else if (part == "updates")
            wrong += measureMovedObjects(settings);
          else if (part == "growth")
            wrong += measureGrowth(settings);
          else if (part == "meshes")
            wrong += measureMeshPairs(settings);
          else
            wrong += measureRequiredDistances(settings);
        });
    std::cerr << part << ": " << static_cast<int>(seconds) << " s" << std::endl;
  }
  std::cout << settings.out << '\n';
  if (wrong > 0)
    throw Error(std::to_string(wrong) + " wrong answers of methods that claim to be exact");
}
}  // namespace

int main(int argc, char** argv)
{
  return runTool(
      {"benchmark",
       "[--quick] [--out DIR] [--data DIR] [--scenes A,B] [--methods A,B] ...",
       "Measures states per second, wrong answers and their size, latency, build and update times, memory, work\n"
       "and growth, of this project's methods, of FCL, Bullet, fitted spheres and VAMP, and of the methods of\n"
       "bench/literature, and writes them as CSV tables.\n"
       "Work is counted outside the timing, and only if counting costs nothing: on the CPU the visited nodes per\n"
       "state, on the GPU the candidates, root pairs and traversed pairs per state. The peers have no counts.\n"
       "The part kernels times each kernel, copy and clear of ours_work_queue and ours_breadth_first on the device.\n"
       "scripts/charts draws the tables. Exit status 1 if a method that claims to be exact gives a wrong answer.\n"
       "Without the robots of Debian's dart-doc (see --data), their scenes are left out.",
       {{"--quick", "", "two scenes, few states, no methods of bench/literature: under a minute"},
        {"--out", "DIR", "folder for the tables (default benchmark)"},
        {"--data", "DIR", "folder with urdf/KR5, urdf/drchubo, urdf/wam, robots/ur5_robotiq, problems/ur5"},
        {"--parts", "A,B", "of " + nameList(kParts) + " (default all)"},
        {"--scenes", "A,B", "of " + nameList(benchmarkSceneNames())},
        {"--methods", "A,B", "names of methods or of families of methods; an unknown name prints the list"},
        {"--kinds", "A,B", "of states: " + nameList(stateKinds())},
        {"--padding", "X,Y", "metres (default 0,0.01; with --quick 0); values after the first only with random states"},
        {"--batches", "N,M", "sizes of batches of the GPU's methods (default 1024,16384)"},
        {"--max-batch", "N", "states that go to the GPU at once (default: the library's)"},
        {"--states", "N", "number of states of each kind (default 16384)"},
        {"--repeats", "N", "number of repeats (default 5)"},
        {"--seconds", "S", "a method that takes longer in a repeat gets fewer states (default 0.5)"},
        {"--seed", "N", "seed of the states (default 1)"},
        {"--device", "D", "auto, software, an index or part of a renderer's name"}},
       run},
      argc, argv);
}
