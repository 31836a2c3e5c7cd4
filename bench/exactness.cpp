// exactness: compares the answers of every checker on real robots with the oracle, in random states and in states near
// contact; see --help.

#include <algorithm>
#include <cstdio>
#include <functional>

#include "command_line/command_line.h"
#include "gpu/egl_context.h"
#include "support/carrying_scene.h"
#include "support/exactness.h"
#include "support/leaky_scene.h"
#include "support/near_contact.h"

using namespace gpu_planning_scene::core;

namespace
{
struct Robot
{
  std::string name;
  std::string scene;  // name of a scene in test/support/test_scenes.h
  std::size_t states;
  std::size_t near_states;
  std::function<TestScene()> make;
};

std::vector<Robot> robots()
{
  const auto shared = [](const std::string& name, const std::string& scene, std::size_t states) {
    return Robot{name, scene, states, 10000, [scene] { return testScene(scene); }};
  };
  return {shared("kr5", "kr5", 100000),
          shared("ur5_robotiq", "ur5_table_pick", 10000),
          shared("drchubo", "drchubo", 10000),
          shared("wam", "wam", 10000),
          {"kr5_leaky", "kr5", 10000, 10000, leakyScene},
          {"ur5_carrying", "ur5_table_pick", 1000, 1000, carryingScene}};
}

constexpr std::size_t kQuickStates = 1000;  // with --quick: a tenth of the states, at most this number

double share(double part, double whole)
{
  return whole > 0.0 ? 100.0 * part / whole : 0.0;
}

double share(std::size_t part, std::size_t whole)
{
  return share(static_cast<double>(part), static_cast<double>(whole));
}

void printHead()
{
  std::printf(
      "| robot | states | valid | false free | false collision | false pair | differs from CPU | open | by proofs | "
      "undecided: "
      "work_queue, breadth_first | oracle, states/s |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
}

void printRow(const std::string& label, const Exactness& e)
{
  std::printf("| %s | %zu | %.1f %% | %zu | %zu | %zu | %zu | %zu | %.1f %% | %.3f %%, %.3f %% | %.0f |\n",
              label.c_str(), e.states, share(e.valid, e.states), e.false_free, e.false_collision, e.false_pair,
              e.disagreeing, e.either, share(e.proven, e.states), share(e.undecided_work_queue, e.states),
              share(e.undecided_breadth_first, e.states),
              static_cast<double>(e.states) / std::max(e.oracle_seconds, 1e-9));
  std::fflush(stdout);
  for (const std::string& failure : e.failures)
    std::fprintf(stderr, "%s: %s\n", label.c_str(), failure.c_str());
}

void printClearances(const std::array<std::size_t, 8>& counts)
{
  std::printf(
      "\nClearance of the near-contact states that are free or open, by the oracle:\n\n"
      "| m | < 1e-9 | < 1e-8 | < 1e-7 | < 1e-6 | < 1e-5 | < 1e-4 | < 1e-3 | more |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n| states |");
  for (const std::size_t count : counts)
    std::printf(" %zu |", count);
  std::printf("\n");
}

void run(const CommandLine& arguments)
{
  const std::string only = arguments.value("--robot", "");
  const auto seed = arguments.count("--seed", 1, 0, 1ULL << 62);
  const auto states = arguments.count("--states", 0, 0, 100000000);
  const bool quick = arguments.has("--quick");
  const std::string device = arguments.value("--device", "auto");
  const auto count_of = [&](std::size_t full) {
    return states != 0 ? states : quick ? std::min(kQuickStates, full / 10) : full;
  };
  const std::vector<Robot> all = robots();
  if (!only.empty() && std::none_of(all.begin(), all.end(), [&](const Robot& robot) { return robot.name == only; }))
    throw UsageError("there is no robot '" + only + "'; see --help");

  std::printf("device: %s\n\n", EglContext(device).device().renderer.c_str());
  printHead();
  bool good = true;
  std::array<std::size_t, 8> clearances{};
  for (const Robot& robot : all)
  {
    if (!only.empty() && robot.name != only)
      continue;
    if (const std::string missing = missingFor(robot.scene); !missing.empty())
      throw Error("robot " + robot.name + " needs " + missing);
    const TestScene scene = robot.make();
    ExactnessCheck check(scene, true, device);
    const Exactness in_random_states =
        check.compare(scene.randomStates(count_of(robot.states), seed), false, robot.name + ", random");
    printRow(robot.name + ", random", in_random_states);
    const Exactness near_contact = check.compare(nearContactStates(scene, count_of(robot.near_states), seed + 1), true,
                                                 robot.name + ", near contact");
    printRow(robot.name + ", near contact", near_contact);
    for (std::size_t i = 0; i < clearances.size(); ++i)
      clearances[i] += near_contact.clearances[i];
    good = good && in_random_states.good() && near_contact.good();
  }
  printClearances(clearances);
  if (!good)
    throw Error("there are wrong answers");
}
}  // namespace

int main(int argc, char** argv)
{
  const Tool tool{
      "exactness",
      "[--quick] [--states N] [--robot NAME] [--seed S] [--device D]",
      "Compares the answers of both traversals, at several batch sizes, and of the CPU checker, with and without\n"
      "proofs (balls and tables of joint values), with an oracle in quadruple precision: 100,000 random states of "
      "kr5,\n"
      "10,000 of ur5_robotiq, drchubo, wam and kr5_leaky (objects that are damaged meshes), 1000 of ur5_carrying (a "
      "box in the gripper, padding, a floor); and\n"
      "10,000 states per robot (1000 of ur5_carrying) within about 1e-4 ... 1e-10 m of contact. Bisection finds\n"
      "these states; half of them are free.\n"
      "Prints a Markdown table: wrong answers by the contract, verdicts that differ from the CPU checker's, states\n"
      "for which the contract allows both answers, and the share of undecided states.\n"
      "Exit code: 0 no wrong answer, 1 a wrong answer or another error, 2 bad usage.",
      {{"--quick", "", "a tenth of the states, at most 1000 of each kind"},
       {"--states", "N", "N states of each kind"},
       {"--robot", "NAME", "only this robot"},
       {"--seed", "S", "seed of the random states (default 1)"},
       {"--device", "D", "auto (default), software, an index, or part of a renderer's name"}},
      run};
  return runTool(tool, argc, argv);
}
