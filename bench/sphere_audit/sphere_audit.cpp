// sphere_audit: counts the wrong answers of VAMP's published sphere model of the ur5, and measures their causes and
// their sizes in millimetres. The scenes are those of the planning problems of ../shared or $GPU_PLANNING_SCENE_DATA.
// docs/sphere_models.md explains the table. See --help.

#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <random>
#include <sstream>

#include "benchmark/csv_table.h"
#include "benchmark/statistics.h"
#include "command_line/command_line.h"
#include "sphere_audit/scene_audit.h"
#include "support/planning_problems.h"

using namespace gpu_planning_scene::core;
using namespace gpu_planning_scene::core::benchmark;

namespace
{
constexpr std::size_t kPairsPrinted = 8;
constexpr double kReach = 0.7;  // radians, of the states near the goal, as in the scenes of `benchmark`

struct Settings
{
  std::string out;
  std::size_t problems = 0;
  std::size_t states = 0;
  std::size_t measured = 0;
  std::uint64_t seed = 1;
};

enum class States
{
  Random,
  NearGoal,
  StartsAndGoals
};
constexpr States kStates[] = {States::Random, States::NearGoal, States::StartsAndGoals};

const char* nameOf(States states)
{
  switch (states)
  {
    case States::Random:
      return "random";
    case States::NearGoal:
      return "near the goal";
    case States::StartsAndGoals:
      return "starts and goals";
  }
  return "";
}

std::vector<double> statesOf(const PlanningProblem& problem, States kind, std::size_t count, std::mt19937_64& generator)
{
  std::vector<double> states;
  if (kind == States::StartsAndGoals)
  {
    states = problem.start;
    states.insert(states.end(), problem.goal.begin(), problem.goal.end());
    return states;
  }
  const std::vector<Variable>& variables = problem.scene->robot->variables();
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t v = 0; v < variables.size(); ++v)
    {
      const bool near = kind == States::NearGoal;
      const double lower = near ? std::max(variables[v].lower, problem.goal[v] - kReach) : variables[v].lower;
      const double upper = near ? std::min(variables[v].upper, problem.goal[v] + kReach) : variables[v].upper;
      states.push_back(lower + (upper - lower) * share(generator));
    }
  return states;
}

double share(std::size_t part, std::size_t whole)
{
  return whole == 0 ? std::nan("") : static_cast<double>(part) / static_cast<double>(whole);
}

std::string percent(std::size_t part, std::size_t whole)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << 100.0 * share(part, whole) << " %";
  return whole == 0 ? "" : text.str();
}

/// Median, 95 % and largest, in millimetres; empty without sizes.
std::string millimetres(const std::vector<double>& sizes)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << 1e3 * median(sizes) << ", " << 1e3 * percentile(sizes, 0.95) << ", "
       << 1e3 * percentile(sizes, 1.0);
  return sizes.empty() ? "" : text.str();
}

/// The pairs with the most wrong answers.
void printPairs(const char* title, const WrongAnswers& wrong)
{
  if (wrong.by_pair.empty())
    return;
  std::vector<std::pair<std::size_t, std::string>> pairs;
  for (const auto& [pair, count] : wrong.by_pair)
    pairs.emplace_back(count, pair);
  std::sort(pairs.rbegin(), pairs.rend());
  pairs.resize(std::min(pairs.size(), kPairsPrinted));
  std::cout << "\n| " << title << " | states | share |\n|---|---|---|\n";
  for (const auto& [count, pair] : pairs)
    std::cout << "| " << pair << " | " << count << " | " << percent(count, wrong.all()) << " |\n";
}

/// The sets, and all of them together at the end.
std::vector<std::pair<std::string, Audit>> withSum(const std::map<std::string, Audit>& sets)
{
  std::vector<std::pair<std::string, Audit>> rows(sets.begin(), sets.end());
  Audit sum;
  for (const auto& [set, audit] : sets)
    sum.add(audit);
  rows.emplace_back("all", sum);
  return rows;
}

void print(States kind, const std::vector<std::pair<std::string, Audit>>& audits)
{
  std::cout << '\n'
            << nameOf(kind)
            << "\n\n| set | states | free | missed: of colliding states | by spheres, pairs | depth, mm | invented: of "
               "free states | by spheres, pairs, cylinders | clearance, mm |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [set, audit] : audits)
  {
    const WrongAnswers& missed = audit.missed;
    const WrongAnswers& invented = audit.invented;
    std::cout << "| " << set << " | " << audit.states << " | " << percent(audit.free, audit.states) << " | "
              << missed.all() << ": " << percent(missed.all(), audit.states - audit.free) << " | "
              << missed.of(Cause::Spheres) << ", " << missed.of(Cause::Pairs) << " | " << millimetres(missed.sizes)
              << " | " << invented.all() << ": " << percent(invented.all(), audit.free) << " | "
              << invented.of(Cause::Spheres) << ", " << invented.of(Cause::Pairs) << ", "
              << invented.of(Cause::Cylinders) << " | " << millimetres(invented.sizes) << " |\n";
  }
  printPairs("missed collisions of", audits.back().second.missed);
  printPairs("invented collisions of", audits.back().second.invented);
}

void write(CsvTable& table, States kind, const std::vector<std::pair<std::string, Audit>>& audits)
{
  for (const auto& [set, audit] : audits)
    for (const bool is_missed : {true, false})
    {
      const WrongAnswers& wrong = is_missed ? audit.missed : audit.invented;
      table.add({set, nameOf(kind), audit.states, audit.free, is_missed ? "missed" : "invented", wrong.all(),
                 wrong.of(Cause::Spheres), wrong.of(Cause::Pairs), wrong.of(Cause::Cylinders), wrong.sizes.size(),
                 1e3 * median(wrong.sizes), 1e3 * percentile(wrong.sizes, 0.95), 1e3 * percentile(wrong.sizes, 1.0)});
    }
}

void auditAll(const Settings& settings)
{
  const std::vector<std::string> names = chosenPlanningProblems(settings.problems);
  std::map<States, std::map<std::string, Audit>> audits;
  std::mt19937_64 generator(settings.seed);
  std::optional<SceneAudit> scenes;
  for (const std::string& name : names)
  {
    const PlanningProblem problem = loadPlanningProblem(name);
    if (!scenes)
      scenes.emplace(problem.scene);
    const std::string set = name.substr(0, name.find('/'));
    for (const States kind : kStates)
      audits[kind][set].add(scenes->audit(problem.scene, vampCylindersOf(set),
                                          statesOf(problem, kind, settings.states, generator), settings.measured));
    std::cerr << name << ": audited" << std::endl;
  }
  CsvTable table(settings.out, "sphere_audit.csv",
                 {"set", "kind", "states", "free", "answers", "wrong", "by_spheres", "by_pairs", "by_cylinders",
                  "measured", "median_mm", "p95_mm", "largest_mm"});
  for (const States kind : kStates)
  {
    const auto rows = withSum(audits[kind]);
    print(kind, rows);
    write(table, kind, rows);
  }
}

void run(const CommandLine& arguments)
{
  if (const std::string reason = whyNoVamp(); !reason.empty())
    throw Error(reason);
  Settings settings;
  settings.out = arguments.value("--out", "sphere_audit");
  settings.problems = arguments.count("--problems", 140, 1, 100000);
  settings.states = arguments.count("--states", 2000, 1, 1 << 24);
  settings.measured = arguments.count("--measured", 10, 0, 1 << 24);
  settings.seed = arguments.count("--seed", 1, 0, 1ULL << 62);
  makeTableFolder(settings.out);
  auditAll(settings);
}
}  // namespace

int main(int argc, char** argv)
{
  return runTool(
      {"sphere_audit",
       "[--out DIR] [--problems N] [--states N] ...",
       "Compares VAMP's sphere model of the ur5 with the exact checker in the scenes of the planning problems:\n"
       "collisions that it misses and collisions that it invents, with their causes and sizes. Prints Markdown\n"
       "tables and writes sphere_audit.csv. docs/sphere_models.md explains them.",
       {{"--out", "DIR", "folder for the table (default sphere_audit)"},
        {"--problems", "N", "number of problems, evenly spread (default 140)"},
        {"--states", "N", "number of states of each kind in each scene (default 2000)"},
        {"--measured", "N", "wrong answers of each kind whose size is measured in each scene (default 10)"},
        {"--seed", "N", "seed of the states (default 1)"}},
       run},
      argc, argv);
}
