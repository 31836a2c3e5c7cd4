// volume_study: compares the work and the time of different bounding volumes and traversal schemes. Gress and Zachmann
// (2003) leave this choice open. See --help.

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "benchmark/csv_table.h"
#include "benchmark/state_kinds.h"
#include "benchmark/statistics.h"
#include "command_line/command_line.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "model/text/name_list.h"
#include "volumes/methods.h"

using namespace gpu_planning_scene::core;
using namespace gpu_planning_scene::core::volumes;
using benchmark::Cell;

namespace
{
/// The free states, or the colliding states.
struct Part
{
  std::string name;
  std::vector<std::size_t> states;
  WorkCount work;
  std::vector<double> microseconds;  // per state, for each repeat

  double perState(std::size_t value) const
  {
    return static_cast<double>(value) / static_cast<double>(std::max<std::size_t>(states.size(), 1));
  }
};

struct Row
{
  std::unique_ptr<Method> method;
  std::vector<Part> parts;
};

struct Tables
{
  explicit Tables(const std::string& folder)
    : totals(folder, "volume_totals.csv",
             {"scene", "kind", "volume", "scheme", "bytes", "part", "states", "volume_pairs", "overlaps", "leaf_pairs",
              "triangle_pairs", "microseconds", "microseconds_least", "microseconds_most"}),
      levels(folder, "volume_levels.csv",
             {"scene", "kind", "volume", "scheme", "part", "level", "volume_pairs", "overlaps", "leaf_pairs",
              "triangle_pairs"})
  {
  }
  benchmark::CsvTable totals;
  benchmark::CsvTable levels;
};

struct Settings
{
  std::string kind;
  std::size_t states;
  std::uint64_t seed;
  std::size_t repeats;
  bool levels;
};

double percent(std::size_t part, std::size_t whole)
{
  return 100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(whole, 1));
}

std::vector<std::size_t> allOf(std::size_t count)
{
  std::vector<std::size_t> all(count);
  for (std::size_t i = 0; i < count; ++i)
    all[i] = i;
  return all;
}

/// Compares the answers of a method with those of another method (`as`). Throws Error if they differ.
void compare(const std::string& scene, const Method& method, const std::vector<int>& found, const std::vector<int>& as)
{
  std::size_t differing = 0;
  for (std::size_t i = 0; i < as.size(); ++i)
    differing += (method.reportsPair() ? found[i] != as[i] : (found[i] >= 0) != (as[i] >= 0)) ? 1 : 0;
  if (differing != 0)
    throw Error(scene + ": " + method.volume() + ", " + method.scheme() + ": " + std::to_string(differing) +
                " answers differ from those of the AABBs; a test of volumes or a scheme is wrong");
}

/// Compares with the exact checker, which finds every collision of these inscribed surfaces. It also finds collisions
/// of the true curved surfaces and solids. Returns the number of states with only such collisions.
std::size_t compareWithExact(const TestScene& scene, const std::vector<double>& rows, const std::vector<int>& found)
{
  const BatchResult exact = CpuChecker(scene.scene).check(rows.data(), found.size());
  std::size_t others = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    if (found[i] >= 0 && exact.valid[i] != 0)
      throw Error(scene.name + ": state " + std::to_string(i) + " collides here, but not by the exact checker");
    others += found[i] < 0 && exact.valid[i] == 0 ? 1 : 0;
  }
  return others;
}

/// Sorts the pairs by how often each is the first colliding pair. Returns the answers in this order.
std::vector<int> orderPairs(Method& method, PlacedPairs& placed)
{
  WorkCount ignored;
  const std::vector<std::size_t> states = allOf(placed.states());
  const std::vector<int> found = method.check(states, ignored);
  std::vector<std::size_t> hits;
  for (const PlacedPair& pair : placed.pairs)
    hits.resize(std::max<std::size_t>(hits.size(), pair.number + 1));
  for (std::size_t i = 0; i < found.size(); ++i)
    if (found[i] >= 0)
      ++hits[placed.pairs[placed.first[i] + static_cast<std::size_t>(found[i])].number];
  placed.sortByHits(hits);
  return method.check(states, ignored);
}

void measureTimes(std::vector<Row>& rows, std::size_t repeats)
{
  for (std::size_t repeat = 0; repeat < repeats; ++repeat)
    for (Row& row : rows)
      for (Part& part : row.parts)
      {
        const benchmark::Stopwatch watch;
        const std::size_t colliding = row.method->run(part.states);
        const double seconds = watch.cpuSeconds();
        if (colliding != (part.name == "free" ? 0 : part.states.size()))
          throw Error(row.method->volume() + ", " + row.method->scheme() + ": answers change from run to run");
        part.microseconds.push_back(1e6 * part.perState(1) * seconds);
      }
}

/// Prints a line for each method for which `wanted` is true.
template <class Wanted>
void printTotals(const std::vector<Row>& rows, const Wanted& wanted)
{
  std::printf(
      "| volume; scheme | bytes | free: volume pairs | overlap | leaf pairs | triangle pairs | us | colliding: volume "
      "pairs | overlap | leaf pairs | triangle pairs | us |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Row& row : rows)
  {
    if (!wanted(*row.method))
      continue;
    std::printf("| %s; %s | %zu |", row.method->volume().c_str(), row.method->scheme().c_str(), row.method->bytes());
    for (const Part& part : row.parts)
    {
      const LevelWork work = part.work.total();
      std::printf(" %.1f | %.0f %% | %.2f | %.1f | %.2f |", part.perState(work.tests),
                  percent(work.overlaps, work.tests), part.perState(work.leaf_pairs),
                  part.perState(work.triangle_pairs), benchmark::median(part.microseconds));
    }
    std::printf("\n");
  }
}

/// Prints a table with a row per volume and a column per scheme. `rows` must be grouped by volume.
void printTimes(const std::vector<Row>& rows)
{
  std::printf("\nMicroseconds of a free state / of one that collides\n\n| volume |");
  std::string rule = "\n| --- |";
  for (const Row& row : rows)
    if (row.method->volume() == rows.front().method->volume())
    {
      std::printf(" %s |", row.method->scheme().c_str());
      rule += " --- |";
    }
  std::printf("%s", rule.c_str());
  for (const Row& row : rows)
  {
    if (row.method->scheme() == rows.front().method->scheme())
      std::printf("\n| %s |", row.method->volume().c_str());
    std::printf(" %.2f / %.2f |", benchmark::median(row.parts[0].microseconds),
                benchmark::median(row.parts[1].microseconds));
  }
  std::printf("\n");
}

/// Prints the work of free states level by level, with a column for each method for which `wanted` is true. In a free
/// state, all pairs are traversed to the end.
template <class Wanted>
void printLevels(const std::vector<Row>& rows, const Wanted& wanted)
{
  std::size_t levels = 0;
  std::printf(
      "\nFree states, level by level: volume pairs, share that overlap, leaf pairs, triangle pairs\n\n| level |");
  std::string rule = "\n| --- |";
  for (const Row& row : rows)
    if (wanted(*row.method))
    {
      levels = std::max(levels, row.parts[0].work.levels().size());
      std::printf(" %s; %s |", row.method->volume().c_str(), row.method->scheme().c_str());
      rule += " --- |";
    }
  std::printf("%s\n", rule.c_str());
  for (std::size_t level = 0; level < levels; ++level)
  {
    std::printf("| %zu |", level);
    for (const Row& row : rows)
    {
      const Part& part = row.parts[0];
      if (!wanted(*row.method))
        continue;
      if (level >= part.work.levels().size())
      {
        std::printf(" |");
        continue;
      }
      const LevelWork& work = part.work.levels()[level];
      std::printf(" %.2f, %.0f %%, %.2f, %.2f |", part.perState(work.tests), percent(work.overlaps, work.tests),
                  part.perState(work.leaf_pairs), part.perState(work.triangle_pairs));
    }
    std::printf("\n");
  }
}

void write(const std::string& scene, const std::string& kind, const std::vector<Row>& rows, Tables& tables)
{
  for (const Row& row : rows)
    for (const Part& part : row.parts)
    {
      const LevelWork work = part.work.total();
      tables.totals.add({scene, kind, row.method->volume(), row.method->scheme(), row.method->bytes(), part.name,
                         part.states.size(), work.tests, work.overlaps, work.leaf_pairs, work.triangle_pairs,
                         benchmark::median(part.microseconds), benchmark::percentile(part.microseconds, 0.0),
                         benchmark::percentile(part.microseconds, 1.0)});
      for (std::size_t level = 0; level < part.work.levels().size(); ++level)
      {
        const LevelWork& at = part.work.levels()[level];
        tables.levels.add({scene, kind, row.method->volume(), row.method->scheme(), part.name, level, at.tests,
                           at.overlaps, at.leaf_pairs, at.triangle_pairs});
      }
    }
}

void study(const TestScene& scene, const Settings& settings, Tables* tables)
{
  const std::vector<double> states = benchmark::makeStates(scene, settings.kind, settings.states, settings.seed);
  PlacedPairs placed = placePairs(scene, states);
  std::vector<Row> rows;
  for (std::unique_ptr<Method>& method : makeMethods(placed))
    rows.push_back({std::move(method), {}});

  const std::vector<int> expected = orderPairs(*rows.front().method, placed);
  const std::size_t others = compareWithExact(scene, states, expected);
  Part free{"free", {}, {}, {}};
  Part colliding{"colliding", {}, {}, {}};
  for (std::size_t i = 0; i < expected.size(); ++i)
    (expected[i] < 0 ? free : colliding).states.push_back(i);
  for (Row& row : rows)
  {
    row.parts = {free, colliding};
    WorkCount ignored;
    compare(scene.name, *row.method, row.method->check(allOf(placed.states()), ignored), expected);
    for (Part& part : row.parts)
      row.method->check(part.states, part.work);
  }
  measureTimes(rows, settings.repeats);

  std::printf(
      "\n## %s, %s states, seed %llu\n\n%zu states, %zu of them free, %zu of which collide for the exact checker, "
      "which knows "
      "true curved surfaces and containment; %.1f pairs a state; %zu trees with %zu nodes. All methods "
      "gave the same answers.\n\n",
      scene.name.c_str(), settings.kind.c_str(), static_cast<unsigned long long>(settings.seed), expected.size(),
      free.states.size(), others, static_cast<double>(placed.pairs.size()) / static_cast<double>(placed.states()),
      placed.trees, placed.nodes);
  const std::string first_volume = rows.front().method->volume();
  const std::string first_scheme = rows.front().method->scheme();
  const auto in_first_scheme = [&](const Method& method) { return method.scheme() == first_scheme; };
  const auto of_first_volume = [&](const Method& method) { return method.volume() == first_volume; };
  printTotals(rows, in_first_scheme);
  std::printf("\n");
  printTotals(rows, of_first_volume);
  printTimes(rows);
  if (settings.levels)
  {
    printLevels(rows, in_first_scheme);
    printLevels(rows, of_first_volume);
  }
  std::fflush(stdout);
  if (tables != nullptr)
    write(scene.name, settings.kind, rows, *tables);
}

void run(const CommandLine& arguments)
{
  Settings settings;
  settings.kind = arguments.value("--kind", "random");
  settings.states = arguments.count("--states", 2000, 1, 1000000);
  settings.seed = arguments.count("--seed", 1, 0, 1ULL << 62);
  settings.repeats = arguments.count("--repeats", 5, 1, 1000);
  settings.levels = arguments.has("--levels");
  const std::vector<std::string>& kinds = benchmark::stateKinds();
  if (std::find(kinds.begin(), kinds.end(), settings.kind) == kinds.end())
    throw UsageError("--kind: there are no '" + settings.kind + "' states; see --help");
  std::vector<std::string> scenes = arguments.values("--scene");
  if (scenes.empty())
    scenes = {"arm_shelf"};
  for (const std::string& name : scenes)
  {
    const std::vector<std::string>& known = benchmarkSceneNames();
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw UsageError("--scene: there is no '" + name + "'; see --help");
    if (const std::string missing = missingFor(name); !missing.empty())
      throw Error(name + " needs " + missing);
  }
  std::unique_ptr<Tables> tables;
  if (arguments.has("--out"))
  {
    benchmark::makeTableFolder(arguments.required("--out"));
    tables = std::make_unique<Tables>(arguments.required("--out"));
  }
  for (const std::string& name : scenes)
    study(testScene(name), settings, tables.get());
}

}  // namespace

int main(int argc, char** argv)
{
  const Tool tool{
      "volume_study",
      "[--scene NAME]... [--kind KIND] [--states N] [--repeats N] [--seed S] [--levels] [--out DIR]",
      "Bounding volumes (spheres, AABBs, OBBs, k-DOPs) in trees of one topology, under several schemes of traversal,\n"
      "on one core in double. The pairs of a state are those whose boxes around the placed roots overlap. A free "
      "state\n"
      "traverses all pairs, a colliding state stops at the first hit. All shapes are triangles here, and only surfaces "
      "are\n"
      "tested. Prints Markdown tables: work a state and microseconds of CPU time, triangle tests included (median of\n"
      "the repeats, in which the methods take turns), for free and for colliding states.\n"
      "Exit code: 0, 1 if the answers of methods or of the exact checker differ, or another error, 2 bad "
      "usage.",
      {{"--scene", "NAME", "of " + nameList(benchmarkSceneNames()) + " (default arm_shelf)", true},
       {"--kind", "KIND", "of states: " + nameList(benchmark::stateKinds()) + " (default random)"},
       {"--states", "N", "number of states (default 2000)"},
       {"--repeats", "N", "number of repeats (default 5)"},
       {"--seed", "S", "seed of the random states (default 1)"},
       {"--levels", "", "tables of the work level by level, too"},
       {"--out", "DIR", "folder for volume_totals.csv and volume_levels.csv: sums over the states"}},
      run};
  return runTool(tool, argc, argv);
}
