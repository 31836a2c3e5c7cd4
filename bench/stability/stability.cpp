// stability: compares the answers of all methods with the oracle in hard cases. See docs/stability.md.

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iostream>

#include "base/seconds_since.h"
#include "command_line/command_line.h"
#include "stability/judge.h"

using namespace gpu_planning_scene::core;
using namespace gpu_planning_scene::core::stability;

namespace
{
constexpr std::size_t kFullCases = 2048;
constexpr std::size_t kQuickCases = 64;
constexpr std::size_t kCasesPerProof = 32;
constexpr std::size_t kLeastSets = 4;  // at least this number of sets of copies
constexpr std::size_t kReported = 5;   // wrong answers per family that are printed one by one

std::ofstream openFile(const CommandLine& arguments, const std::string& option)
{
  std::ofstream file;
  if (!arguments.has(option))
    return file;
  file.open(arguments.required(option));
  if (!file)
    throw Error(arguments.required(option) + ": the file cannot be written; give " + option + " another path");
  return file;
}

/// The families whose name contains the text.
std::vector<Family> chosenFamilies(const std::string& text)
{
  std::vector<Family> chosen;
  std::string names;
  for (const Family& family : allFamilies())
  {
    if (family.name.find(text) != std::string::npos)
      chosen.push_back(family);
    names += (names.empty() ? "" : ", ") + family.name;
  }
  if (chosen.empty())
    throw UsageError("no family's name contains '" + text + "'; there are: " + names);
  return chosen;
}

void runStability(const CommandLine& arguments)
{
  const std::vector<Family> families = chosenFamilies(arguments.value("--family", ""));
  const auto seed = arguments.count("--seed", 1, 0, 1ULL << 62);
  const auto cases = arguments.count("--cases", arguments.has("--quick") ? kQuickCases : kFullCases, 1, 1 << 24);
  std::ofstream markdown = openFile(arguments, "--markdown");
  const auto with_proofs = static_cast<std::size_t>(
      arguments.integer("--proofs", static_cast<long long>(cases / kCasesPerProof), 0, 1 << 24));
  Ours ours(arguments.value("--device", "auto"), arguments.value("--shaders", ""), with_proofs);
  std::cerr << "device: " << ours.deviceName() << ", seed " << seed << ", " << cases << " cases of each of "
            << families.size() << " families\n";

  const LiteratureMethods literature;
  std::vector<Row> rows;
  std::size_t wrong = 0;
  for (const Family& family : families)
  {
    const auto start = std::chrono::steady_clock::now();
    std::cerr << family.name << std::flush;
    std::size_t failures = 0;
    const auto report = [&](const Failure& failure)
    {
      if (++failures <= kReported)
        std::cerr << "\n  " << methodNames()[failure.method].name << " is wrong in case " << failure.index << ": "
                  << failure.what;
    };
    // A set of copies tests more than a single case, but less than the same number of different cases.
    const std::size_t count =
        std::min(family.most, family.copies == 1 ? cases : std::max(cases / 8, kLeastSets) * family.copies);
    rows.push_back(judge(family, seed, count, ours, literature, report));
    wrong += failures;
    if (failures > kReported)
      std::cerr << "\n  and " << failures - kReported << " more wrong answers";
    std::cerr << (failures > 0 ? "\n  " : ": ") << secondsSince(start) << " s, " << rows.back().undecided
              << " decided by the CPU, " << rows.back().proven << " by balls" << std::endl;
  }
  writeMarkdown(markdown.is_open() ? markdown : std::cout, {seed, cases, ours.deviceName()}, rows);
  if (wrong > 0)
    throw Error(std::to_string(wrong) + " wrong answers of the project's own methods with seed " +
                std::to_string(seed));
}
}  // namespace

int main(int argc, char** argv)
{
  return runTool(
      {"stability",
       "[--quick] [--seed N] [--cases N] [--markdown FILE] [--device D]",
       "Compares the answers of this project's methods and of others with true distances in quadruple precision, in\n"
       "hard cases. Prints the table of wrong answers (Markdown). Exit status 1 if an answer of\n"
       "this project is wrong.",
       {{"--quick", "", "64 cases of each family instead of 2048"},
        {"--seed", "N", "seed of the random cases (default 1)"},
        {"--cases", "N", "number of cases of each family (default 2048)"},
        {"--proofs", "N", "number of cases of each family that are checked with proofs (balls) too (default: 1 in 32)"},
        {"--family", "TEXT", "only families whose name contains TEXT"},
        {"--markdown", "FILE", "writes the table to FILE instead of printing it"},
        {"--device", "D", "auto (default), software, an index, or part of a renderer's name"},
        {"--shaders", "DIR", "a folder of shaders instead of the installed one"}},
       runStability},
      argc, argv);
}
