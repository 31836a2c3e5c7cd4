// A small part of bench/exactness.cpp: no answer contradicts the contract on real robots, in random states and close to
// contact, and every checker, traversal and batch size gives the same verdict.

#include <iostream>
#include <map>
#include <numeric>

#include <gtest/gtest.h>

#include "support/carrying_scene.h"
#include "support/exactness.h"
#include "support/leaky_scene.h"
#include "support/near_contact.h"
#include "support/repetitions.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
struct Slice
{
  const char* name;
  const char* scene;
  std::size_t random_states;
  std::size_t near_states;
};

void PrintTo(const Slice& slice, std::ostream* out)
{
  *out << slice.name;
}

/// A scene and its checkers.
struct Compared
{
  explicit Compared(const TestScene& compared) : scene(compared), check(scene) {}
  TestScene scene;
  ExactnessCheck check;
};

/// The scene and the checkers of a slice, made once per process, because compiling shaders and building trees takes a
/// while.
Compared& comparedCalled(const Slice& slice)
{
  static std::map<std::string, Compared> made;
  const auto known = made.find(slice.name);
  if (known != made.end())
    return known->second;
  const std::string name = slice.name;
  return made
      .try_emplace(name, name == "carrying" ? carryingScene()
                         : name == "leaky"  ? leakyScene()
                                            : testScene(slice.scene))
      .first->second;
}

class Exact : public testing::TestWithParam<Slice>
{
 protected:
  void SetUp() override
  {
    if (const std::string missing = missingFor(GetParam().scene); !missing.empty())
      GTEST_SKIP() << "there is no " << missing;
    compared_ = &comparedCalled(GetParam());
  }

  void expectNothingWrong(const Exactness& exactness)
  {
    std::cout << GetParam().name << ", seed " << kSeed << ": " << exactness.states << " states, " << exactness.valid
              << " free, " << exactness.either << " left open by the contract, "
              << exactness.undecided_work_queue + exactness.undecided_breadth_first << " undecided by floats"
              << std::endl;
    EXPECT_EQ(0u, exactness.false_free);
    EXPECT_EQ(0u, exactness.false_collision);
    EXPECT_EQ(0u, exactness.false_pair);
    EXPECT_EQ(0u, exactness.disagreeing);
    for (const std::string& failure : exactness.failures)
      ADD_FAILURE() << failure;
    // Otherwise little was compared.
    EXPECT_GE(20 * exactness.valid, exactness.states);
    EXPECT_LE(20 * exactness.valid, 19 * exactness.states);
  }

  Compared* compared_ = nullptr;
};

TEST_P(Exact, InRandomStates)
{
  const std::vector<double> states = compared_->scene.randomStates(GetParam().random_states, kSeed);
  expectNothingWrong(compared_->check.compare(states, false, GetParam().name));
}

TEST_P(Exact, CloseToContact)
{
  const auto states = nearContactStates(compared_->scene, GetParam().near_states, kSeed);
  const Exactness exactness = compared_->check.compare(states, true, GetParam().name);
  expectNothingWrong(exactness);
  // Half of the states were moved back from contact, most of them by more than the tolerance of the contract, none by
  // much.
  const auto& clearances = exactness.clearances;
  EXPECT_GE(std::accumulate(clearances.begin() + 1, clearances.end(), std::size_t{0}), GetParam().near_states / 4);
  EXPECT_EQ(0u, clearances.back());
}

INSTANTIATE_TEST_SUITE_P(
    Robots, Exact,
    testing::Values(Slice{"kr5", "kr5", repetitions(100U, 400U), repetitions(30U, 100U)},
                    Slice{"ur5_robotiq", "ur5_table_pick", repetitions(60U, 200U), repetitions(30U, 100U)},
                    Slice{"wam", "wam", repetitions(60U, 200U), repetitions(30U, 100U)},
                    Slice{"drchubo", "drchubo", repetitions(15U, 50U), repetitions(6U, 10U)},
                    Slice{"leaky", "kr5", repetitions(60U, 400U), repetitions(20U, 100U)},
                    Slice{"carrying", "ur5_table_pick", repetitions(20U, 30U), repetitions(10U, 20U)}),
    [](const auto& parameter) { return std::string(parameter.param.name); });
}  // namespace
}  // namespace gpu_planning_scene::core
